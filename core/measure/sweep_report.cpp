#include "core/measure/sweep_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/number_text.h"
#include "core/measure/sweep_html.h"
#include "core/measure/sweep_page_style.h"
#include "core/measure/sweep_views.h"

namespace lightvane {
namespace {

std::string fact(const char* name, const std::string& html, bool isWide = false) {
  return fmt::format("<div{}><dt>{}</dt><dd>{}</dd></div>\n", isWide ? " class=\"wide\"" : "", name, html);
}

std::string quietly(const std::string& text) {
  return text.empty() ? "" : fmt::format(" <span class=\"quiet\">· {}</span>", escapedHtml(text));
}

std::string counted(std::size_t count, const char* one, const char* several) {
  return countText(count) + " " + (count == 1 ? one : several);
}

/// "36 points × 3 seeds = 108 pictures"
std::string pointsText(const Sweep& sweep) {
  std::size_t runs = 0, least = sweep.points.empty() ? 0 : sweep.points.front().runs.size(), most = least;
  for (const SweepPoint& point : sweep.points) {
    runs += point.runs.size();
    least = std::min(least, point.runs.size());
    most = std::max(most, point.runs.size());
  }
  std::string text = counted(sweep.points.size(), "point", "points");
  if (sweep.points.empty()) return text;
  text += least == most ? " × " + counted(most, "seed", "seeds")
                        : fmt::format(", each of {} to {} seeds", least, most);
  return runs > 1 ? text + fmt::format(" = {} pictures", countText(runs)) : text;
}

std::string head(const Sweep& sweep) {
  std::string facts = "<dl class=\"facts\">\n";
  facts += fact("Scene", escapedHtml(sweep.scene) + quietly(sweep.sceneHash));
  facts += fact("Pictures", fmt::format("{} × {} pixels", sweep.width, sweep.height));
  const std::string noise =
      sweep.referenceNoise ? fmt::format("noise {} %", reportNumber(100.0 * *sweep.referenceNoise)) : "";
  facts += fact("Reference", sweep.reference.empty() ? "–" : escapedHtml(sweep.reference) + quietly(noise));
  facts += fact("Measured", pointsText(sweep));
  facts +=
      fact("Machine",
           escapedHtml(sweep.machine) +
               quietly(counted(static_cast<std::size_t>(std::max(sweep.threads, 0)), "thread", "threads")));
  facts += fact("Lightvane", escapedHtml(sweep.version));
  std::string varied;
  for (const VariedParameter& knob : sweep.varied) {
    std::string values;
    for (const std::string& value : knob.values) values += (values.empty() ? "" : ", ") + value;
    varied += fmt::format("<code>{}</code> = {}<br/>", escapedHtml(knob.key), escapedHtml(values));
  }
  if (!varied.empty()) facts += fact("Varied", varied, true);
  return facts + "</dl>\n";
}

std::string metricChoice(const std::vector<MetricView>& views) {
  std::string options, layer;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ReportMetric& metric = views[v].metric;
    if (v == 0 || metric.layer != layer) {
      if (v > 0) options += "</optgroup>";
      options += fmt::format("<optgroup label=\"{}\">", escapedHtml(metric.layer));
      layer = metric.layer;
    }
    options += fmt::format("<option value=\"{}\">{}</option>", v, escapedHtml(metric.label()));
  }
  return fmt::format(
      "<div class=\"choose\"><label>Error by <select id=\"metric\">{}</optgroup></select></label></div>\n",
      options);
}

std::string viewSection(const Sweep& sweep, const MetricView& view, std::size_t number) {
  const ReportMetric& metric = view.metric;
  const std::string name = metric.layer.empty() ? metric.label() : metric.label() + ", " + metric.layer;
  std::string html = fmt::format("<div class=\"view v{}\">\n<h2>Error against CPU time: {}</h2>\n", number,
                                 escapedHtml(name));
  if (metric.info != nullptr) html += fmt::format("<p>{}</p>\n", escapedHtml(metric.info->description));
  const std::size_t missing = sweep.points.size() - view.points.size();
  if (missing > 0)
    html += fmt::format("<p>{} without a value {} left out.</p>\n", counted(missing, "point", "points"),
                        missing == 1 ? "is" : "are");
  html += "<div class=\"plot\">" + frontPlot(sweep, view) + "</div>\n";
  const bool hasBars =
      std::ranges::any_of(sweep.points, [](const SweepPoint& point) { return point.runs.size() > 1; });
  html += fmt::format("<p class=\"quiet\">Markers are means{}. CPU time is that of all threads.</p>\n",
                      hasBars ? " over the seeds; bars reach from the least to the most of them" : "");
  html += "<h2>The front</h2>\n<p>No other point is both faster and nearer to the reference.";
  html += hasBars ? " After ±: the standard deviation among seeds.</p>\n" : "</p>\n";
  html += frontTable(sweep, view);
  if (!sweep.varied.empty()) html += "<h2>Each parameter alone</h2>\n" + knobPlots(sweep, view);
  return html + "</div>\n";
}

/// A cell that sorts by the number.
std::string numberCell(double value, const std::string& text, const std::string& classes = "n") {
  return fmt::format(R"(<td class="{}" data-v="{}">{}</td>)", classes,
                     std::isnan(value)   ? ""
                     : std::isinf(value) ? (value > 0.0 ? "Infinity" : "-Infinity")
                                         : fmt::format("{:.6g}", value),
                     text);
}

template <class Number>
double meanOfRuns(const SweepPoint& point, Number number) {
  double sum = 0.0;
  for (const SweepRun& run : point.runs) sum += static_cast<double>(number(run));
  return sum / static_cast<double>(point.runs.size());
}

using CountOfRun = double (*)(const SweepRun&);
struct CountColumn {
  const char* group;
  const char* name;
  CountOfRun count;
};
#define LV_COUNT(member) [](const SweepRun& run) { return static_cast<double>(run.member); }
constexpr CountColumn kCounts[] = {{"rays", "camera", LV_COUNT(rays.camera)},
                                   {"rays", "gather", LV_COUNT(rays.gather)},
                                   {"rays", "bounce", LV_COUNT(rays.bounce)},
                                   {"rays", "shadow", LV_COUNT(rays.shadow)},
                                   {"rays", "visibility", LV_COUNT(rays.visibility)},
                                   {"vectors", "ILVs", LV_COUNT(ilvRecords)},
                                   {"vectors", "DLVs", LV_COUNT(dlvRecords)},
                                   {"computed in full", "indirect", LV_COUNT(fullIndirect)},
                                   {"computed in full", "direct", LV_COUNT(fullDirect)}};
#undef LV_COUNT

std::string sortHeader(const std::string& name, const std::string& classes) {
  return fmt::format(R"(<th class="{}"><button type="button">{}</button></th>)", classes, name);
}

/// Two lines: groups of columns and their names. The metrics' come right after the times: they are what is
/// looked for.
std::string numbersHeader(const std::vector<MetricView>& views) {
  std::string groups = R"(<tr><th class="corner"></th><th></th><th colspan="2" class="group">time, s</th>)";
  std::string names = "<tr>" + sortHeader("#", "l corner") + sortHeader("settings", "settings") +
                      sortHeader("CPU", "n") + sortHeader("wall", "n");
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ReportMetric& metric = views[v].metric;
    groups += fmt::format("<th class=\"group m m{}\">{}</th>", v, escapedHtml(metric.layer));
    names += sortHeader(escapedHtml(metric.labelWithUnit()), fmt::format("n m m{}", v));
  }
  std::string_view group;
  for (const CountColumn& column : kCounts) {
    if (column.group != group) {
      const auto span = std::ranges::count(kCounts, std::string_view(column.group),
                                           [](const CountColumn& c) { return std::string_view(c.group); });
      groups += fmt::format(R"(<th colspan="{}" class="group">{}</th>)", span, column.group);
    }
    group = column.group;
    names += sortHeader(column.name, "n");
  }
  return groups + "<th></th></tr>\n" + names + sortHeader("memory", "n") + "</tr>\n";
}

std::string numbersTable(const Sweep& sweep, const std::vector<MetricView>& views) {
  std::string html;
  if (views.size() > 1) {
    html =
        "<input type=\"checkbox\" id=\"every\"/><label class=\"every\" for=\"every\">with every "
        "metric</label>\n";
  }
  html += "<div class=\"scroll all-points\"><table><thead>" + numbersHeader(views) + "</thead><tbody>\n";
  for (std::size_t p = 0; p < sweep.points.size(); ++p) {
    const SweepPoint& point = sweep.points[p];
    const bool hasSpread = point.runs.size() > 1;
    const Spread cpu = cpuSpread(point);
    const double wall = meanOfRuns(point, [](const SweepRun& run) { return run.wallSeconds; });
    html += fmt::format(
        "<tr id=\"row-{0}\" data-p=\"{0}\"><td class=\"l\"><a href=\"#point-{0}\">#{0}</a></td>"
        "<td class=\"settings\">{1} <code>{2}</code></td>",
        p + 1, inlineMarker(point.method), escapedHtml(pointTitle(point)));
    html += numberCell(cpu.mean, spreadText(cpu, hasSpread)) + numberCell(wall, reportNumber(wall));
    for (std::size_t v = 0; v < views.size(); ++v) {
      const std::optional<Spread> spread = metricSpread(point, views[v].metric.key);
      const std::string classes = fmt::format("n m m{}", v);
      html += spread
                  ? numberCell(spread->mean, spreadText(views[v].metric.shown(*spread), hasSpread), classes)
                  : fmt::format("<td class=\"{}\" data-v=\"\">–</td>", classes);
    }
    for (const CountColumn& column : kCounts) {
      const double count = meanOfRuns(point, column.count);
      html += numberCell(count, shortCount(count));
    }
    const double memory = meanOfRuns(point, [](const SweepRun& run) { return run.memoryBytes; });
    html += numberCell(memory, byteText(static_cast<std::uint64_t>(memory))) + "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

using AddressesByName = std::map<std::string, std::string>;

std::string thumbnail(const Sweep& sweep, const AddressesByName& thumbnails, const std::string& file,
                      const std::string& alt, const char* caption) {
  const auto shown = thumbnails.find(file);
  if (shown == thumbnails.end()) return fmt::format("<span class=\"quiet\">{}: none</span>", caption);
  const int width = kThumbnailWidth;
  const int height = sweep.width > 0 ? std::max(1, sweep.height * width / sweep.width) : width;
  return fmt::format(R"(<a href="{0}"><img src="{1}" width="{2}" height="{3}" alt="{4}"/>{5}</a>)",
                     escapedUrlPath(file), shown->second, width, height, escapedHtml(alt), caption);
}

std::string card(const Sweep& sweep, std::size_t p, const std::vector<MetricView>& views,
                 const AddressesByName& thumbnails) {
  const SweepPoint& point = sweep.points[p];
  const bool hasSpread = point.runs.size() > 1;
  const std::string title = pointTitle(point);
  std::string html = fmt::format(
      "<article class=\"card\" id=\"point-{0}\" data-p=\"{0}\"><h3><a href=\"#row-{0}\">#{0}</a> {1} "
      "<code>{2}</code></h3>\n",
      p + 1, inlineMarker(point.method), escapedHtml(title));
  std::string numbers = spreadText(cpuSpread(point), hasSpread) + " s CPU";
  if (!views.empty()) {
    const ReportMetric& metric = views.front().metric;
    const std::optional<Spread> spread = metricSpread(point, metric.key);
    if (spread)
      numbers += fmt::format(", {} {} {}", metric.label(), spreadText(metric.shown(*spread), hasSpread),
                             metric.unit());
  }
  html += fmt::format("<p class=\"quiet\">{}</p>\n<div class=\"pair\">", escapedHtml(numbers));
  html += thumbnail(sweep, thumbnails, point.picture, "Picture of " + title, "picture");
  html += thumbnail(sweep, thumbnails, point.errorMap, "Error map of " + title, "error map");
  return html + fmt::format(
                    "</div>\n<div class=\"command\"><code>{}</code>"
                    "<button type=\"button\" class=\"copy\">Copy</button></div></article>\n",
                    escapedHtml(point.command));
}

}  // namespace

std::string sweepReportHtml(const Sweep& sweep, const std::string& metric,
                            const AddressesByName& thumbnails) {
  std::vector<MetricView> views;
  for (ReportMetric& shown : reportMetrics(sweep, metric)) views.emplace_back(sweep, std::move(shown));

  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
      "<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>Lightvane sweep: {}</title>\n<style>{}</style>\n"
      "<style id=\"shown\">.v0{{display:block}}.m0{{display:table-cell}}</style>\n</head>\n<body>\n<main>\n",
      escapedHtml(sweep.scene), kSweepPageStyle);
  html += markerShapes();
  html += fmt::format("<h1>What speed costs: {}</h1>\n", escapedHtml(sweep.scene)) + head(sweep);
  if (views.size() > 1) html += metricChoice(views);
  const bool isKnown =
      std::ranges::any_of(views, [&](const MetricView& view) { return view.metric.key == metric; });
  if (!metric.empty() && !isKnown && !sweep.points.empty())
    html += fmt::format("<p>No point has a value of {}.</p>\n", escapedHtml(metric));
  for (std::size_t v = 0; v < views.size(); ++v) html += viewSection(sweep, views[v], v);
  html += "<h2>All points</h2>\n";
  if (sweep.points.empty()) {
    html += "<p>There are none.</p>\n";
  } else {
    html += "<p>Numbers are means over the seeds; pictures, error maps and commands are of the first.</p>\n";
    html += numbersTable(sweep, views) + "<div class=\"cards\">\n";
    for (std::size_t p = 0; p < sweep.points.size(); ++p) html += card(sweep, p, views, thumbnails);
    html += "</div>\n";
  }
  html += fmt::format("</main>\n<script>{}</script>\n</body>\n</html>\n", kSweepPageScript);
  return html;
}

}  // namespace lightvane
