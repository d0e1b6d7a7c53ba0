// The page of `lightvane sweep`, as a browser shows it.

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "tests/app/program.h"
#include "tests/browser/browser.h"

namespace lightvane {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

using Row = std::vector<std::string>;

/// The cells of comma-separated values, line by line.
std::vector<Row> csvRows(const std::string& text) {
  std::vector<Row> rows;
  Row row;
  std::string cell;
  bool isQuoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (isQuoted && c == '"' && text.substr(i + 1, 1) == "\"") {
      cell += text[++i];
    } else if (c == '"') {
      isQuoted = !isQuoted;
    } else if (!isQuoted && (c == ',' || c == '\n')) {
      row.push_back(std::exchange(cell, {}));
      if (c == '\n') rows.push_back(std::exchange(row, {}));
    } else {
      cell += c;
    }
  }
  return rows;
}

/// A point as runs.csv has it.
struct TablePoint {
  std::string method;
  std::string title;  ///< "path path.samples=4", of vectors the settings alone
  std::size_t runs = 0;
  std::map<std::string, double> means;  ///< over its runs, of each column of numbers that was asked for
};

/// Runs of a point are one after the other.
std::vector<TablePoint> tablePoints(const std::string& csv, const std::vector<std::string>& columns) {
  const std::vector<Row> rows = csvRows(csv);
  const Row& head = rows.at(0);
  const auto column = [&](const std::string& name) {
    const auto found = std::ranges::find(head, name);
    if (found == head.end()) throw std::runtime_error("no column " + name);
    return static_cast<std::size_t>(found - head.begin());
  };
  std::vector<TablePoint> points;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const Row& row = rows[r];
    std::string title = row[0] == "vectors" ? "" : row[0];
    for (std::size_t c = 1; c < column("seed"); ++c) {
      if (!row[c].empty()) title += (title.empty() ? "" : " ") + head[c] + "=" + row[c];
    }
    if (points.empty() || points.back().title != title) points.push_back({row[0], title, 0, {}});
    TablePoint& point = points.back();
    ++point.runs;
    for (const std::string& name : columns) point.means[name] += std::stod(row[column(name)]);
  }
  for (TablePoint& point : points) {
    for (auto& [name, mean] : point.means) mean /= static_cast<double>(point.runs);
  }
  return points;
}

/// A column of runs.csv on a plot's axis.
struct PlottedColumn {
  std::string name;
  double factor = 1.0;  ///< from the table's unit to the axis's
  bool isLogarithmic = true;

  /// What is even along the axis.
  double coordinate(double onAxis) const { return isLogarithmic ? std::log(onAxis) : onAxis; }
};
const PlottedColumn kCpuSeconds{"cpu_seconds", 1.0, true};
const PlottedColumn kRelativeError{"beauty.relative", 100.0, true};
const PlottedColumn kDecibels{"beauty.psnr", 1.0, false};

/// Where a column's value is by the labels of its axis, and how far off a marker may be: both have their
/// places in tenths of a pixel, and what is beyond two labels is less certain than they are.
struct ExpectedPlace {
  double at = 0.0, tolerance = 0.0;
};
ExpectedPlace placeByLabels(const json& ticks, const PlottedColumn& column, double mean) {
  const json &first = ticks.at(0), &last = ticks.at(ticks.size() - 1);
  const double from = column.coordinate(first.at("value")), to = column.coordinate(last.at("value"));
  const double part = (column.coordinate(column.factor * mean) - from) / (to - from);
  constexpr double kRounding = 0.05, kSinglePrecision = 0.01;
  return {std::lerp(first.at("at").get<double>(), last.at("at").get<double>(), part),
          kRounding * (std::abs(1.0 - part) + std::abs(part) + 1.0) + kSinglePrecision};
}

/// Markers and labels of the plots that can be seen. Markers are measured where they are drawn; places are in
/// the plot's own pixels, and `page` in those of the page.
constexpr const char* kShownPlots = R"js((() => {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  const numberOf = text => Number(text.replace(/(^|·)10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)$/, (all, dot, power) =>
    (dot ? "" : "1") + "e" + Array.from(power, c => c === "⁻" ? "-" : digits.indexOf(c)).join("")));
  const ticksOf = (plot, side, placeOf) => Array.from(plot.querySelectorAll(".tick." + side))
    .map(tick => ({ value: numberOf(tick.textContent), at: placeOf(tick) }))
    .filter(tick => !isNaN(tick.value) && tick.value !== 0);
  return Array.from(document.querySelectorAll("svg.main")).filter(plot => plot.getClientRects().length > 0)
    .map(plot => {
      const toPlot = plot.getScreenCTM().inverse();
      return {
        points: Array.from(plot.querySelectorAll(".point"), point => {
          const box = point.querySelector("use").getBoundingClientRect();
          const page = new DOMPoint(box.x + box.width / 2, box.y + box.height / 2);
          const at = page.matrixTransform(toPlot);
          return { number: Number(point.dataset.p), title: point.querySelector("title").textContent,
                   pixels: box.width, x: at.x, y: at.y, page: { x: page.x, y: page.y },
                   isOnTop: document.elementFromPoint(page.x, page.y).closest(".point") === point };
        }).sort((a, b) => a.number - b.number),
        across: ticksOf(plot, "mid", tick => Number(tick.getAttribute("x"))),
        // A label's base line is a third of its height below what it names.
        up: ticksOf(plot, "end", tick => Number(tick.getAttribute("y")) - 4)
      };
    });
})())js";

/// What is wrong with a plot of these points, line by line.
std::vector<std::string> faultsOf(const json& plot, const std::vector<TablePoint>& points,
                                  const PlottedColumn& error) {
  const json& markers = plot.at("points");
  std::vector<std::string> faults;
  if (markers.size() != points.size())
    faults.push_back(fmt::format("{} markers of {} points", markers.size(), points.size()));
  for (const json& marker : markers) {
    const auto number = marker.at("number").get<std::size_t>();
    if (number < 1 || number > points.size()) {
      faults.push_back(fmt::format("a marker of point {}", number));
      continue;
    }
    const TablePoint& point = points[number - 1];
    const std::string title = marker.at("title");
    if (!title.starts_with(fmt::format("#{} {}: ", number, point.title)))
      faults.push_back(fmt::format("point {} is named {}", number, title));
    if (marker.at("pixels") < 4.0) faults.push_back(fmt::format("point {} is not drawn", number));
    const auto expect = [&](const char* axis, const json& ticks, const PlottedColumn& column) {
      const double value = point.means.at(column.name), at = marker.at(axis);
      const ExpectedPlace expected = placeByLabels(ticks, column, value);
      if (!(std::abs(at - expected.at) <= expected.tolerance)) {
        faults.push_back(fmt::format("point {} of {} {} is at {} {:.2f}, its value at {:.2f} ± {:.2f}",
                                     number, column.name, value, axis, at, expected.at, expected.tolerance));
      }
    };
    expect("x", plot.at("across"), kCpuSeconds);
    expect("y", plot.at("up"), error);
  }
  return faults;
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) throw std::runtime_error("the page has no " + part);
  return text.replace(at, part.size(), by);
}

/// A sweep of two parameters with rivals, each point by two seeds.
class SweepPage : public testing::Test {
 protected:
  void SetUp() override {
    run({"reference", shippedScene("cornell"), "-o", "truth.exr", "--size", "16x16", "--spp", "256", "-q"});
    run({"sweep", shippedScene("cornell"), "--reference", "truth.exr", "-o", "trade", "--size", "16x16",
         "--preset", "draft", "--vary", "ilv.n_min=2,8", "--vary", "ilv.radius_scale=0.3:0.9:2", "--seeds",
         "2", "--rivals", "direct,path", "-q"});
    points_ =
        tablePoints(program_.read("trade/runs.csv"), {kCpuSeconds.name, kRelativeError.name, kDecibels.name});
    ASSERT_THAT(points_, SizeIs(4U + 1U + 4U));
    for (const TablePoint& point : points_) ASSERT_EQ(point.runs, 2U) << point.title;
  }
  void run(const std::vector<std::string>& words) {
    const Outcome outcome = program_.run(words);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  }
  std::string page() const { return program_.read("trade/index.html"); }
  void openPage() { browser_.open(program_.path("trade/index.html")); }
  void openChanged(const std::string& html) {
    program_.write("trade/changed.html", html);
    browser_.open(program_.path("trade/changed.html"));
  }
  json shownPlot() {
    const json plots = browser_.evaluate(kShownPlots);
    EXPECT_EQ(plots.size(), 1U) << "one metric at a time";
    return plots.at(0);
  }
  PagePlace middleOf(const std::string& element) {
    const json middle =
        browser_.evaluate(fmt::format("(() => {{ const box = {}.getBoundingClientRect();"
                                      "return [box.x + box.width / 2, box.y + box.height / 2]; }})()",
                                      element));
    return {middle.at(0), middle.at(1)};
  }
  /// The numbers of points whose every element, and no other, is of a class.
  std::vector<std::string> pointsOfClass(const std::string& name) {
    return browser_.evaluate(fmt::format(
        R"js((() => {{
          const all = Array.from(document.querySelectorAll("[data-p]"));
          const isIn = element => element.classList.contains("{}");
          const numbers = new Set(all.filter(isIn).map(element => element.dataset.p));
          return Array.from(numbers, number =>
            all.filter(element => element.dataset.p === number).every(isIn) ? number : number + " in part");
        }})())js",
        name));
  }

  Program program_;
  std::vector<TablePoint> points_;
  Browser browser_;
};

TEST_F(SweepPage, LoadsWithoutAnErrorAndAsksForNothing) {
  openPage();
  EXPECT_THAT(browser_.errors(), IsEmpty());
  std::vector<std::string> files = browser_.requests();
  std::erase_if(files, [](const std::string& address) { return address.starts_with("data:image/png;"); });
  EXPECT_THAT(files, ElementsAre(StartsWith("file://" + program_.path("trade").string() + "/")));
  EXPECT_EQ(
      browser_.evaluate("Array.from(document.images).filter(image => image.naturalWidth === 16).length"),
      2U * points_.size());
}

TEST_F(SweepPage, PlotsThePointsOfTheTable) {
  openPage();
  EXPECT_THAT(faultsOf(shownPlot(), points_, kRelativeError), IsEmpty());
  // By another metric, on an axis of another scale.
  browser_.evaluate(R"js((() => {
    const choice = document.getElementById("metric");
    choice.value = Array.from(choice.querySelectorAll("optgroup[label=beauty] option"))
      .find(option => option.textContent === "PSNR").value;
    choice.dispatchEvent(new Event("change", { bubbles: true }));
  })())js");
  EXPECT_THAT(faultsOf(shownPlot(), points_, kDecibels), IsEmpty());
  EXPECT_THAT(browser_.errors(), IsEmpty());
}

TEST_F(SweepPage, MarksAPointWhereverItIs) {
  openPage();
  // Some are under others.
  const json points = shownPlot().at("points");
  const auto point =
      std::ranges::find_if(points, [](const json& each) { return each.at("isOnTop") == true; });
  ASSERT_NE(point, points.end());
  const auto number = point->at("number").get<std::size_t>();
  const json page = point->at("page");
  const PagePlace place{page.at("x"), page.at("y")};
  browser_.moveTo(place);
  EXPECT_THAT(pointsOfClass("hot"), ElementsAre(std::to_string(number)));
  browser_.click(place);
  EXPECT_THAT(pointsOfClass("picked"), ElementsAre(std::to_string(number)));
  EXPECT_EQ(browser_.evaluate("location.hash"), fmt::format("#row-{}", number));
  browser_.moveTo({1.0, 1.0});
  EXPECT_THAT(pointsOfClass("hot"), IsEmpty());
  EXPECT_THAT(browser_.errors(), IsEmpty());
}

TEST_F(SweepPage, HasButtonsThatSortAndCopy) {
  openPage();
  const std::string button =
      R"js(Array.from(document.querySelectorAll(".all-points th button")).find(b => b.textContent === "CPU"))js";
  for (const bool isUp : {true, false}) {
    browser_.click(middleOf(button));
    const std::vector<std::size_t> order = browser_.evaluate(
        R"js(Array.from(document.querySelectorAll(".all-points tbody tr"), row => Number(row.dataset.p)))js");
    ASSERT_THAT(order, SizeIs(points_.size()));
    for (std::size_t i = 1; i < order.size(); ++i) {
      const double before = points_.at(order[i - 1] - 1).means[kCpuSeconds.name],
                   after = points_.at(order[i] - 1).means[kCpuSeconds.name];
      // Rows have six digits.
      EXPECT_LE(isUp ? before : after, (isUp ? after : before) * (1.0 + 1e-5)) << i << " " << isUp;
    }
  }
  browser_.click(middleOf("document.querySelector('#point-2 .copy')"));
  EXPECT_EQ(browser_.evaluate(R"js(new Promise(done => {
    const look = () => {
      const text = document.querySelector("#point-2 .copy").textContent;
      text === "Copied" ? done(text) : setTimeout(look, 10);
    };
    look();
  }))js"),
            "Copied");
  EXPECT_THAT(browser_.errors(), IsEmpty());
}

// That the tests above can fail: each finds what is wrong with a page that was changed for it.

TEST_F(SweepPage, IsFoundOutWhereItHasErrorsOrAsksTheNetwork) {
  struct Change {
    std::string part, by, error;
  };
  const std::vector<Change> changes = {
      {"\"use strict\";", "throw new Error('a script ended');", "a script ended"},
      {"\"use strict\";", "setTimeout(() => { throw new Error('a late one'); }, 0);", "a late one"},
      {"\"use strict\";", "Promise.reject(new Error('a promise'));", "a promise"},
      {"\"use strict\";", "console.error('a word');", "a word"},
      {"\"use strict\";", "var = 1;", "SyntaxError"},
      {"src=\"data:image/png;base64,", "src=\"gone.png\" title=\"", "gone.png"},
      {"</main>", "<script src=\"gone.js\"></script></main>", "gone.js"},
      {"</main>", "<link rel=\"stylesheet\" href=\"gone.css\"/></main>", "gone.css"}};
  for (const Change& change : changes) {
    openChanged(replaced(page(), change.part, change.by));
    EXPECT_THAT(browser_.errors(), ElementsAre(HasSubstr(change.error))) << change.by;
  }
  for (const char* by : {"<img src=\"http://lightvane.invalid/a.png\"/>",
                         "<script src=\"https://lightvane.invalid/a.js\"></script>",
                         "<script>fetch('https://lightvane.invalid/').catch(() => 0);</script>",
                         "<script>new WebSocket('wss://lightvane.invalid/');</script>"}) {
    openChanged(replaced(page(), "</main>", std::string(by) + "</main>"));
    EXPECT_THAT(browser_.requests(), Contains(HasSubstr("://lightvane.invalid/"))) << by;
  }
}

TEST_F(SweepPage, IsFoundOutWhereItsMarkersAreWrong) {
  const std::string whole = page();
  const std::size_t plot = whole.find("<svg class=\"main\"");
  const std::size_t begin = whole.find("<a class=\"point ", plot), end = whole.find("</a>", begin) + 4;
  const std::string marker = whole.substr(begin, end - begin);
  const std::size_t before = marker.find(" x=\""), after = marker.find('"', before + 4);
  const double x = std::stod(marker.substr(before + 4));
  const std::string moved =
      marker.substr(0, before) + fmt::format(" x=\"{:.1f}", x + 1.0) + marker.substr(after);
  const auto faultsWith = [&](const std::string& other) {
    openChanged(replaced(whole, marker, other));
    return faultsOf(shownPlot(), points_, kRelativeError);
  };
  EXPECT_THAT(faultsWith(marker), IsEmpty());
  EXPECT_THAT(faultsWith(""), ElementsAre("8 markers of 9 points"));
  EXPECT_THAT(faultsWith(marker + marker), ElementsAre("10 markers of 9 points"));
  EXPECT_THAT(faultsWith(moved), ElementsAre(HasSubstr("cpu_seconds"))) << "by a pixel";
  EXPECT_THAT(faultsWith(replaced(marker, "href=\"#m-", "href=\"#gone-")),
              Contains(HasSubstr("is not drawn")));
  EXPECT_THAT(faultsWith(replaced(marker, "<title>#", "<title>")), ElementsAre(HasSubstr("is named")));
}

TEST(Browser, LeavesNoProcessBehind) {
  {
    Browser browser;
    EXPECT_THAT(childProcesses(), testing::Not(IsEmpty()));
  }
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(Browser, WaitsForNothingForEver) {
  const TemporaryFolder folder;
  const auto page = folder.write("endless.html", "<script>for (;;);</script>");
  std::string said;
  {
    Browser browser;
    try {
      browser.open(page, std::chrono::milliseconds(500));
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
  }
  EXPECT_THAT(said, HasSubstr("no answer in time"));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace lightvane
