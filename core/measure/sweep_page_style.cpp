#include "core/measure/sweep_page_style.h"

namespace lightvane {

// Colours of methods: Okabe & Ito 2008, which those who see fewer colours tell apart; on dark the lighter
// blue.
const char* const kSweepPageStyle = R"css(
:root{color-scheme:light dark;--page:#fff;--card:#f6f7f9;--ink:#1b1f24;--quiet:#5b6470;--line:#d9dde3;--grid:#e8ebef;
--link:#0a58a8;--hot:#fff1c2;--vectors:#0072b2;--path:#d55e00;--naive:#009e73;--direct:#b8568f;--other:#6b7280}
@media (prefers-color-scheme:dark){:root{--page:#15181c;--card:#1e2228;--ink:#e6e8eb;--quiet:#a0a8b3;--line:#363c45;
--grid:#282d34;--link:#7cc0f5;--hot:#4a3f17;--vectors:#56b4e9;--path:#f0863a;--naive:#2cc295;--direct:#e29bc5;
--other:#a0a8b3}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);font:15px/1.5 system-ui,"DejaVu Sans",sans-serif}
main{max-width:1180px;margin:0 auto;padding:28px 24px 64px}
h1{font-size:26px;line-height:1.25;margin:0 0 18px;overflow-wrap:anywhere}
h2{font-size:20px;margin:44px 0 8px}
p{margin:0 0 12px;max-width:84ch}
a{color:var(--link)}
code{font:13px/1.45 ui-monospace,"DejaVu Sans Mono",monospace;overflow-wrap:anywhere}
.quiet{color:var(--quiet)}
.facts{display:grid;grid-template-columns:repeat(auto-fit,minmax(230px,1fr));gap:12px 28px;margin:0;padding:16px 18px;
background:var(--card);border-radius:8px}
.facts dt{color:var(--quiet);font-size:13px}
.facts dd{margin:0;overflow-wrap:anywhere}
.facts .quiet{display:inline-block;max-width:100%}
.facts .wide{grid-column:1/-1}
.choose{display:none;margin:28px 0 0;padding:10px 0;border-bottom:1px solid var(--line)}
.js .choose{display:block}
select,button{font:inherit;color:inherit;background:var(--card);border:1px solid var(--line);border-radius:6px;
padding:4px 10px}
button{cursor:pointer}
.view{display:none}
.plot{overflow-x:auto}
svg.main{display:block;width:100%;min-width:720px;height:auto}
svg.shapes{position:absolute}
svg text{fill:var(--ink);font:12px system-ui,"DejaVu Sans",sans-serif}
svg .mid{text-anchor:middle}
svg .end{text-anchor:end}
svg .tick{fill:var(--quiet);font-variant-numeric:tabular-nums}
svg .title,svg .legend{font-size:13px}
svg .title{font-weight:600}
svg .note{fill:var(--quiet);font-style:italic}
svg .label{paint-order:stroke;stroke:var(--page);stroke-width:4px;stroke-linejoin:round;pointer-events:none}
svg path{fill:none}
.grid{stroke:var(--grid)}
.axis{stroke:var(--quiet)}
.k-vectors{--c:var(--vectors)}.k-path{--c:var(--path)}.k-naive{--c:var(--naive)}.k-direct{--c:var(--direct)}
.k-other{--c:var(--other)}
use{fill:var(--c);stroke:var(--page);stroke-width:1px}
defs path{fill:inherit}
.point use{fill-opacity:.55}
.point.front use,.legend use{fill-opacity:1}
.point .bar{stroke:var(--c);stroke-opacity:.7;stroke-width:1.3px}
.point.hot use,.point.picked use{fill-opacity:1;stroke:var(--ink);stroke-width:2.2px}
.front-line{stroke:var(--ink);stroke-width:1.6px;stroke-opacity:.75}
.rival-line{stroke:var(--c);stroke-width:1px;stroke-opacity:.8}
.noise-line{stroke:var(--quiet);stroke-dasharray:5 4}
.knob-one{stroke:var(--c);stroke-width:1px;stroke-opacity:.4}
.knob-mean{stroke:var(--c);stroke-width:2.2px}
.knob-mean.of-all{stroke-dasharray:6 4}
.knobs{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,400px),1fr));gap:24px}
.knob{margin:0;max-width:500px}
.knob svg{display:block;width:100%;height:auto}
figcaption .quiet{font-size:13px}
.scroll{overflow:auto;max-height:85vh;margin:0 0 16px}
table{border-collapse:collapse;font-size:14px;font-variant-numeric:tabular-nums}
th,td{padding:5px 12px;border-bottom:1px solid var(--line);white-space:nowrap;background:var(--page)}
th{font-weight:600;vertical-align:bottom}
thead{position:sticky;top:0;z-index:2}
.n{text-align:right}
.l,.settings{text-align:left}
td.settings{min-width:23em}
td.settings code{display:inline-block;max-width:calc(100% - 24px);white-space:normal;vertical-align:top}
td.settings .mark{vertical-align:top;margin:2px 3px 0 0}
.group{text-align:center;color:var(--quiet);font-weight:400}
.all-points td:first-child,.all-points .corner{position:sticky;left:0;z-index:1}
td code{overflow-wrap:normal}
th button{padding:0;border:0;background:none;font:inherit;font-weight:600}
th button:hover{text-decoration:underline}
th[aria-sort=ascending] button::after{content:" ▲"}
th[aria-sort=descending] button::after{content:" ▼"}
tr.hot td,tr.picked td,tr:target td{background:var(--hot)}
tr:target{scroll-margin-top:80px}
.mark{width:15px;height:15px;vertical-align:-2px}
.m{display:none}
#every:checked~.scroll .m{display:table-cell}
.every{margin-left:6px}
.cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,460px),1fr));gap:20px;margin-top:16px}
.card{background:var(--card);border:2px solid transparent;border-radius:8px;padding:14px 16px;scroll-margin-top:16px;
min-width:0}
.card:target,.card.picked{border-color:var(--link)}
.card h3{font-size:15px;margin:0 0 4px;overflow-wrap:anywhere}
.card p{margin:0 0 8px}
.pair{display:grid;grid-template-columns:1fr 1fr;gap:10px;margin-bottom:10px}
.pair a{display:block;color:var(--quiet);font-size:13px;text-decoration:none}
.pair img{display:block;width:100%;height:auto;background:var(--grid);border-radius:4px}
.command{display:flex;gap:10px;align-items:flex-start}
.command code{flex:1;min-width:0;white-space:pre-wrap}
.copy{display:none;font-size:13px;padding:2px 8px}
.js .copy{display:block}
@media print{
:root{color-scheme:light;--page:#fff;--card:#fff;--ink:#000;--quiet:#444;--line:#bbb;--grid:#ddd;--link:#000;--hot:#fff;
--vectors:#0072b2;--path:#d55e00;--naive:#009e73;--direct:#b8568f;--other:#555}
body{font-size:10pt}
main{max-width:none;padding:0}
.js .choose,.choose,.js .copy,.every,#every{display:none}
.scroll,.plot{overflow:visible;max-height:none}
svg.main{min-width:0}
table{font-size:7.5pt}
table code{font-size:6.5pt}
td.settings{min-width:0}
th,td{padding:2px 4px}
thead,.all-points td:first-child,.all-points .corner{position:static}
.card,.knob,.plot,tr{break-inside:avoid}
.card{border:1px solid var(--line)}
h2,h2+p{break-after:avoid}
.cards{grid-template-columns:1fr 1fr;gap:8pt}
.card code{font-size:7pt}
}
)css";

const char* const kSweepPageScript = R"js(
(function () {
  "use strict";
  var page = document.documentElement;
  page.className = "js";
  var all = function (query, within) { return Array.from((within || document).querySelectorAll(query)); };

  var select = document.getElementById("metric");
  var show = function () {
    document.getElementById("shown").textContent =
      ".v" + select.value + "{display:block}.m" + select.value + "{display:table-cell}";
  };
  if (select) {
    select.addEventListener("change", show);
    show();  // a page that is loaded again keeps its choice
  }

  var mark = function (name, number) {
    all("." + name + "[data-p]").forEach(function (e) { e.classList.remove(name); });
    if (number) all('[data-p="' + number + '"]').forEach(function (e) { e.classList.add(name); });
  };
  var numberAt = function (event) {
    var e = event.target.closest ? event.target.closest("[data-p]") : null;
    return e ? e.getAttribute("data-p") : "";
  };
  var last = "";
  document.addEventListener("mouseover", function (event) {
    var number = numberAt(event);
    if (number !== last) mark("hot", number);
    last = number;
  });
  document.addEventListener("click", function (event) {
    var number = numberAt(event);
    if (number) mark("picked", number);
  });

  all(".all-points thead th button").forEach(function (button) {
    button.addEventListener("click", function () {
      var head = button.parentNode;
      var body = head.closest("table").tBodies[0];
      var column = all("th", head.parentNode).indexOf(head);
      var turn = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      all("th[aria-sort]", head.parentNode).forEach(function (e) { e.removeAttribute("aria-sort"); });
      head.setAttribute("aria-sort", turn === 1 ? "ascending" : "descending");
      var keyed = all("tr", body).map(function (row) {
        var cell = row.cells[column];
        var value = cell.getAttribute("data-v");
        return { row: row, key: value === null ? cell.textContent.trim() : value === "" ? NaN : Number(value) };
      });
      keyed.sort(function (a, b) {
        if (typeof a.key === "string") return turn * a.key.localeCompare(b.key, "en", { numeric: true });
        if (isNaN(a.key) || isNaN(b.key)) return isNaN(a.key) - isNaN(b.key);  // what is missing is last
        return a.key === b.key ? 0 : a.key > b.key ? turn : -turn;
      });
      keyed.forEach(function (entry) { body.appendChild(entry.row); });
    });
  });

  all(".copy").forEach(function (button) {
    button.addEventListener("click", function () {
      var code = button.parentNode.querySelector("code");
      var done = function () {
        button.textContent = "Copied";
        setTimeout(function () { button.textContent = "Copy"; }, 1500);
      };
      var byHand = function () {  // pages from files may have no clipboard
        var range = document.createRange();
        range.selectNodeContents(code);
        getSelection().removeAllRanges();
        getSelection().addRange(range);
        if (document.execCommand("copy")) done();
      };
      if (navigator.clipboard) navigator.clipboard.writeText(code.textContent).then(done, byHand);
      else byHand();
    });
  });
})();
)js";

}  // namespace lightvane
