#include "core/measure/sweep_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/measure/sweep_html.h"
#include "core/measure/sweep_plot.h"
#include "core/measure/sweep_values.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr const char* kRelative = "beauty.relative";

SweepPoint sweepPoint(const std::string& method, const SweepSettings& settings, double cpuSeconds,
                      const std::map<std::string, double>& values, int seeds = 1) {
  SweepPoint point;
  point.method = method;
  point.settings = settings;
  point.command = "lightvane render scene.toml --method " + method;
  point.picture = "picture.png";
  point.errorMap = "error.png";
  for (int seed = 0; seed < seeds; ++seed) {
    SweepRun run;
    run.seed = static_cast<std::uint64_t>(seed);
    run.cpuSeconds = cpuSeconds;
    run.wallSeconds = cpuSeconds / 2.0;
    run.rays.gather = 1'260'000;
    run.metrics = values;
    point.runs.push_back(run);
  }
  return point;
}

Sweep sweepOf(std::vector<SweepPoint> points) {
  Sweep sweep;
  sweep.scene = "scene.toml";
  sweep.width = 64;
  sweep.height = 48;
  sweep.machine = "a machine";
  sweep.version = "1.0";
  sweep.reference = "ref.exr";
  sweep.referenceNoise = 0.005;
  sweep.points = std::move(points);
  return sweep;
}

/// Two parameters in a grid, and rivals beside it.
Sweep sweepOfGrid(std::size_t perKnob = 3) {
  Sweep sweep = sweepOf({});
  sweep.varied = {{"ilv.n_min", {}}, {"ilv.radius_scale", {}}};
  for (std::size_t i = 0; i < perKnob; ++i) {
    sweep.varied[0].values.push_back(std::to_string(i + 1));
    sweep.varied[1].values.push_back(fmt::format("{:.1f}", 0.2 * static_cast<double>(i + 1)));
  }
  double index = 0.0;
  for (const std::string& a : sweep.varied[0].values) {
    for (const std::string& b : sweep.varied[1].values) {
      index += 1.0;
      const double seconds = 0.2 * std::pow(1.1, index),
                   error = 0.2 / index * (1.0 + 0.3 * std::sin(9.0 * index));
      sweep.points.push_back(sweepPoint("vectors", {{"ilv.n_min", a}, {"ilv.radius_scale", b}}, seconds,
                                        {{kRelative, error}, {"direct.psnr", -20.0 * std::log10(error)}}, 3));
      sweep.points.back().runs[1].metrics[kRelative] *= 1.2;
    }
  }
  for (const double samples : {4.0, 16.0, 64.0}) {
    const double error = 0.6 / std::sqrt(samples);
    for (const char* method : {"path", "naive"}) {
      sweep.points.push_back(sweepPoint(method, {{"samples", fmt::format("{}", samples)}}, samples,
                                        {{kRelative, error}, {"direct.psnr", -20.0 * std::log10(error)}}));
    }
  }
  sweep.points.push_back(sweepPoint("direct", {}, 0.3, {{kRelative, 0.5}, {"direct.psnr", 60.0}}));
  return sweep;
}

/// What is wrong with a page as XML; empty where tags are balanced, attributes quoted and entities known.
std::string xmlFault(std::string_view page) {
  std::vector<std::string> open;
  for (std::size_t at = 0; at < page.size();) {
    const auto here = [&] { return " at: " + std::string(page.substr(at, 60)); };
    const char c = page[at];
    if (c == '&') {
      static const std::set<std::string_view> kEntities{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
      if (!kEntities.contains(page.substr(at, page.find(';', at) + 1 - at))) return "unknown entity" + here();
    }
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') return "control character" + here();
    if (c != '<') {
      ++at;
      continue;
    }
    if (page.substr(at).starts_with("<!DOCTYPE html>")) {
      at += 15;
      continue;
    }
    const bool isEnd = page.substr(at).starts_with("</");
    std::size_t end = at + (isEnd ? 2 : 1);
    const std::size_t nameEnd = page.find_first_of(" />", end);
    if (nameEnd == std::string_view::npos || nameEnd == end) return "no name" + here();
    const std::string name(page.substr(end, nameEnd - end));
    end = nameEnd;
    std::set<std::string_view> attributes;
    while (end < page.size() && page[end] == ' ') {
      const std::size_t equals = page.find('=', end);
      if (equals == std::string_view::npos || page[equals + 1] != '"') return "no quoted value" + here();
      if (!attributes.insert(page.substr(end + 1, equals - end - 1)).second)
        return "twice an attribute" + here();
      const std::size_t quote = page.find('"', equals + 2);
      if (page.substr(equals, quote - equals).find('<') != std::string_view::npos)
        return "< in a value" + here();
      end = quote + 1;
    }
    const bool isWhole = page.substr(end).starts_with("/>");
    if (!isWhole && !page.substr(end).starts_with(">")) return "no end of the tag" + here();
    if (isEnd) {
      if (open.empty() || open.back() != name) return "not open" + here();
      open.pop_back();
    } else if (!isWhole) {
      open.push_back(name);
    }
    at = end + (isWhole ? 2 : 1);
  }
  return open.empty() ? "" : "still open: " + open.back();
}

std::size_t countOf(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size()))
    ++count;
  return count;
}

std::string between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t from = text.find(before);
  if (from == std::string_view::npos) return {};
  const std::size_t start = from + before.size();
  return std::string(text.substr(start, text.find(after, start) - start));
}

/// The plot of a view, which "0" is the first of.
std::string plotOf(const std::string& page, std::size_t view) {
  return between(page.substr(page.find(fmt::format("<div class=\"view v{}\">", view))), "<svg class=\"main\"",
                 "</svg>");
}

struct Place {
  double x = 0.0, y = 0.0;
};
Place placeIn(const std::string& element) {
  return {std::stod(between(element, " x=\"", "\"")), std::stod(between(element, " y=\"", "\""))};
}
/// Of a point's marker; points are numbered from 1.
Place markerPlace(const std::string& plot, int point) {
  const std::string link = between(plot, fmt::format("data-p=\"{}\"", point), "</a>");
  return placeIn(between(link, "<use", "/>"));
}
Place tickPlace(const std::string& plot, const std::string& classes, const std::string& label) {
  const std::size_t end = plot.find(fmt::format("class=\"{}\">{}</text>", classes, label));
  if (end == std::string::npos) throw std::runtime_error("no tick " + label);
  return placeIn(plot.substr(plot.rfind("<text", end)));
}

// A tenth of a pixel is what places are rounded to.
constexpr double kPixel = 0.11;

TEST(SweepReport, IsWholeAndMarksEachPointOnce) {
  const Sweep sweep = sweepOfGrid();
  const std::string page = sweepReportHtml(sweep, kRelative);
  EXPECT_EQ(xmlFault(page), "");
  for (const std::size_t view : {0u, 1u}) {
    const std::string plot = plotOf(page, view);
    EXPECT_EQ(countOf(plot, "class=\"point "), sweep.points.size());
    EXPECT_EQ(countOf(plot, "class=\"point k-vectors"), 9u);
    EXPECT_EQ(countOf(plot, "class=\"point k-path"), 3u);
    EXPECT_EQ(countOf(plot, "class=\"bar\""), 9u) << "of points with several seeds";
    EXPECT_EQ(countOf(plot, "class=\"rival-line "), 2u) << "path and naive: direct has but one point";
    EXPECT_EQ(countOf(plot, "class=\"front-line\""), 2u) << "one of them in the legend";
  }
  EXPECT_EQ(countOf(page, "<div class=\"view "), 2u);
  EXPECT_EQ(countOf(page, "<tr id=\"row-"), sweep.points.size());
  EXPECT_EQ(countOf(page, "<article class=\"card\""), sweep.points.size());
  EXPECT_EQ(countOf(page, "<figure class=\"knob\">"), 4u) << "two parameters by two metrics";
}

TEST(SweepReport, IsTheSameWhenAskedAgain) {
  EXPECT_EQ(sweepReportHtml(sweepOfGrid(), kRelative), sweepReportHtml(sweepOfGrid(), kRelative));
}

TEST(SweepReport, NeedsNoNetwork) {
  std::string page = sweepReportHtml(sweepOfGrid(), kRelative);
  const std::string name = "http://www.w3.org/1999/xhtml";  // a name, which nobody fetches
  page.erase(page.find(name), name.size());
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
}

TEST(SweepReport, PutsPointsWhereTheirLogarithmsAre) {
  const Sweep sweep = sweepOf({sweepPoint("vectors", {{"a", "1"}}, 0.1, {{kRelative, 0.5}}),
                               sweepPoint("vectors", {{"a", "2"}}, 10.0, {{kRelative, 0.005}}),
                               sweepPoint("vectors", {{"a", "3"}}, 1.0, {{kRelative, 0.1}}),
                               sweepPoint("path", {{"a", "4"}}, 3.7, {{kRelative, 0.31}})});
  const std::string plot = plotOf(sweepReportHtml(sweep, kRelative), 0);
  const Place first = markerPlace(plot, 1), last = markerPlace(plot, 2);
  EXPECT_LT(first.x, last.x);
  EXPECT_LT(first.y, last.y) << "less error is below";
  const auto expectAt = [&](const Place& place, double seconds, double percent) {
    const double right = std::log(seconds / 0.1) / std::log(100.0),
                 down = std::log(50.0 / percent) / std::log(100.0);
    EXPECT_NEAR(place.x, first.x + right * (last.x - first.x), kPixel);
    EXPECT_NEAR(place.y, first.y + down * (last.y - first.y), kPixel);
  };
  expectAt(markerPlace(plot, 3), 1.0, 10.0);
  expectAt(markerPlace(plot, 4), 3.7, 31.0);
  // Labels of the vertical axis are a third of their height below their lines.
  EXPECT_NEAR(tickPlace(plot, "tick mid", "1").x, markerPlace(plot, 3).x, kPixel);
  EXPECT_NEAR(tickPlace(plot, "tick end", "10").y - 4.0, markerPlace(plot, 3).y, kPixel);
}

TEST(SweepReport, HasMoreDecibelsAndSimilarityBelow) {
  const Sweep sweep =
      sweepOf({sweepPoint("vectors", {{"a", "1"}}, 1.0, {{"beauty.psnr", 20.0}, {"beauty.ssim", 0.9}}),
               sweepPoint("vectors", {{"a", "2"}}, 2.0, {{"beauty.psnr", 30.0}, {"beauty.ssim", 0.99}}),
               sweepPoint("vectors", {{"a", "3"}}, 3.0, {{"beauty.psnr", 25.0}, {"beauty.ssim", 0.95}})});
  const std::string page = sweepReportHtml(sweep, "beauty.psnr");
  const std::string decibels = plotOf(page, 0), similarity = plotOf(page, 1);
  EXPECT_NEAR(markerPlace(decibels, 3).y, (markerPlace(decibels, 1).y + markerPlace(decibels, 2).y) / 2.0,
              kPixel);
  for (const std::string& plot : {decibels, similarity}) {
    EXPECT_LT(markerPlace(plot, 1).y, markerPlace(plot, 2).y);
    EXPECT_EQ(countOf(plot, "class=\"point k-vectors front\""), 2u) << "the third is slower and worse";
  }
  EXPECT_THAT(similarity, HasSubstr("1 − SSIM"));
}

TEST(SweepReport, HasPlacesForZeroAndInfinity) {
  const Sweep sweep = sweepOf(
      {sweepPoint("vectors", {{"a", "1"}}, 1.0,
                  {{kRelative, 0.0}, {"beauty.bias", -0.1}, {"beauty.psnr", kNoLimit}}, 2),
       sweepPoint("vectors", {{"a", "2"}}, 2.0,
                  {{kRelative, 0.1}, {"beauty.bias", kNoLimit}, {"beauty.psnr", 30.0}}, 2),
       sweepPoint("path", {}, 0.0, {{kRelative, 0.2}, {"beauty.bias", 0.1}, {"beauty.psnr", 20.0}}, 2)});
  for (const char* metric : {kRelative, "beauty.bias", "beauty.psnr"}) {
    const std::string page = sweepReportHtml(sweep, metric);
    EXPECT_EQ(xmlFault(page), "") << metric;
    const std::string plot = plotOf(page, 0);
    EXPECT_EQ(countOf(plot, "class=\"point "), 3u) << metric;
    EXPECT_EQ(plot.find("nan"), std::string::npos) << metric;
    EXPECT_EQ(plot.find("inf"), std::string::npos) << metric;
    EXPECT_NEAR(markerPlace(plot, 3).x, tickPlace(plot, "tick mid", "0").x, kPixel) << metric;
  }
  const std::string errors = plotOf(sweepReportHtml(sweep, kRelative), 0);
  EXPECT_NEAR(markerPlace(errors, 1).y, tickPlace(errors, "tick end", "0").y - 4.0, kPixel);
  const std::string decibels = plotOf(sweepReportHtml(sweep, "beauty.psnr"), 0);
  EXPECT_NEAR(markerPlace(decibels, 1).y, tickPlace(decibels, "tick end", "∞").y - 4.0, kPixel);
  EXPECT_GT(markerPlace(decibels, 1).y, markerPlace(decibels, 2).y) << "infinitely good is below";
  const std::string bias = plotOf(sweepReportHtml(sweep, "beauty.bias"), 0);
  EXPECT_LT(markerPlace(bias, 2).y, markerPlace(bias, 1).y) << "infinitely bad is above";
  EXPECT_NEAR(markerPlace(bias, 1).y, markerPlace(bias, 3).y, kPixel) << "-10 % is as far from 0 as 10 %";
}

TEST(SweepReport, OfOnePointIsAPage) {
  const std::string page =
      sweepReportHtml(sweepOf({sweepPoint("vectors", {}, 2.0, {{kRelative, 0.02}})}), kRelative);
  EXPECT_EQ(xmlFault(page), "");
  EXPECT_EQ(countOf(plotOf(page, 0), "class=\"point "), 1u);
  EXPECT_THAT(page, HasSubstr("1 point × 1 seed<"));
  EXPECT_THAT(page, Not(HasSubstr("faster than"))) << "there is no rival";
  EXPECT_THAT(page, Not(HasSubstr("class=\"bar\"")));
}

TEST(SweepReport, OfEqualPointsIsAPage) {
  const SweepPoint point = sweepPoint("vectors", {}, 2.0, {{kRelative, 0.02}}, 3);
  const std::string page = sweepReportHtml(sweepOf({point, point, point}), kRelative);
  EXPECT_EQ(xmlFault(page), "");
  EXPECT_EQ(countOf(plotOf(page, 0), "class=\"point "), 3u);
}

TEST(SweepReport, OfNothingIsAPage) {
  for (const char* metric : {"", kRelative}) {
    const std::string page = sweepReportHtml(sweepOf({}), metric);
    EXPECT_EQ(xmlFault(page), "");
    EXPECT_THAT(page, HasSubstr("There are none."));
    EXPECT_THAT(page, Not(HasSubstr("<div class=\"view")));
  }
}

TEST(SweepReport, ShowsTheAskedMetricFirstAndSaysWhatIsMissing) {
  Sweep sweep =
      sweepOf({sweepPoint("vectors", {{"a", "1"}}, 1.0, {{"beauty.psnr", 20.0}, {"direct.rmse", 0.1}}),
               sweepPoint("vectors", {{"a", "2"}}, 2.0, {{"beauty.psnr", 21.0}})});
  const std::string whole = sweepReportHtml(sweep, "");
  EXPECT_EQ(countOf(whole, "<div class=\"view "), 1u);
  EXPECT_THAT(whole, Not(HasSubstr("No point has")));

  const std::string partial = sweepReportHtml(sweep, "direct.rmse");
  EXPECT_EQ(countOf(partial, "<div class=\"view "), 2u);
  EXPECT_EQ(countOf(plotOf(partial, 0), "class=\"point "), 1u);
  EXPECT_THAT(partial, HasSubstr("1 point without a value is left out."));

  EXPECT_THAT(sweepReportHtml(sweep, "beauty.none"), HasSubstr("No point has a value of beauty.none."));
}

TEST(SweepReport, EscapesWhatUsersWrote) {
  Sweep sweep = sweepOfGrid();
  const std::string bad = "<b>&\"'\x01\xff</b>";
  const std::string good = "&lt;b&gt;&amp;&quot;&#39;\xef\xbf\xbd\xef\xbf\xbd&lt;/b&gt;";
  sweep.scene = sweep.sceneHash = sweep.machine = sweep.version = sweep.reference = bad;
  sweep.varied[0].key = bad;
  sweep.varied[0].values[0] = bad;
  sweep.varied.push_back({"nobody.has_it", {bad}});
  for (SweepPoint& point : sweep.points) {
    point.command = "lightvane " + bad;
    for (auto& [key, value] : point.settings) key = value = bad;
    for (SweepRun& run : point.runs) run.metrics["beauty." + bad] = 1.0;
  }
  sweep.points[3].method = bad;
  const std::string odd = "a b#1?:%\xff.png";
  sweep.points[4].picture = odd;
  sweep.points[5].picture = "gone.png";
  const std::string page = sweepReportHtml(sweep, "beauty." + bad, {{odd, "data:image/png;base64,AAAA"}});
  EXPECT_EQ(xmlFault(page), "");
  EXPECT_THAT(page, HasSubstr("<code>lightvane " + good + "</code>"));
  EXPECT_THAT(page,
              HasSubstr("<a href=\"a%20b%231%3F%3A%25%FF.png\"><img src=\"data:image/png;base64,AAAA\""));
  EXPECT_THAT(page, HasSubstr("picture: none"));
  EXPECT_EQ(page.find("<b>"), std::string::npos);
}

TEST(SweepReport, LabelsNoPointOverAnother) {
  const Sweep sweep = sweepOfGrid(22);
  ASSERT_EQ(sweep.points.size(), 491u);
  const std::string page = sweepReportHtml(sweep, kRelative);
  EXPECT_EQ(xmlFault(page), "");
  std::string plot = plotOf(page, 0);
  EXPECT_EQ(countOf(plot, "class=\"point "), 491u);
  std::vector<PlotBox> boxes;
  for (std::size_t at = plot.find("class=\"label"); at != std::string::npos;
       at = plot.find("class=\"label", at + 1)) {
    const Place place = placeIn(plot.substr(plot.rfind("<text", at)));
    const std::string classes = between(plot.substr(at), "\"", "\"");
    const double width = labelWidth(between(plot.substr(at), ">", "</text>"));
    const double before = classes == "label end" ? width : classes == "label mid" ? width / 2.0 : 0.0;
    // Capitals' height; places are rounded.
    boxes.push_back({place.x - before + 0.1, place.y - 8.0, place.x - before + width - 0.1, place.y});
  }
  EXPECT_GT(boxes.size(), 2u);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(boxes[i].overlaps(boxes[j])) << i << " and " << j;
  }
}

TEST(SweepReport, TellsHowMuchFasterThanTheMostExactRival) {
  // Errors of path fall with the root of the time: 5 % is between 10 % and 1 %, at a time of 4 s.
  const Sweep sweep = sweepOf({sweepPoint("path", {{"n", "1"}}, 1.0, {{kRelative, 0.1}}),
                               sweepPoint("path", {{"n", "2"}}, 100.0, {{kRelative, 0.01}}),
                               sweepPoint("direct", {}, 1000.0, {{kRelative, 0.4}}),
                               sweepPoint("vectors", {{"a", "1"}}, 0.5, {{kRelative, 0.05}}),
                               sweepPoint("vectors", {{"a", "2"}}, 50.0, {{kRelative, 0.005}})});
  const std::string page = sweepReportHtml(sweep, kRelative);
  EXPECT_THAT(page, HasSubstr("faster than path"));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">8.00 ×</td>"));
  EXPECT_EQ(countOf(page, "<td class=\"n\">–</td>"), 1u) << "0.5 % was not measured of any rival";

  const ReportMetric metric = reportMetrics(sweep, kRelative).front();
  const RivalTimes rival(sweep, plottedPoints(sweep, metric));
  EXPECT_EQ(rival.method(), "path");
  EXPECT_NEAR(rival.secondsFor(5.0).value_or(0.0), 4.0, 1e-12);
  EXPECT_EQ(rival.secondsFor(10.0), 1.0);
  EXPECT_EQ(rival.secondsFor(10.1), std::nullopt);
  EXPECT_EQ(rival.secondsFor(0.9), std::nullopt);
}

TEST(KnobEffect, OfAGridIsTheMeanOverTheOthers) {
  const Sweep sweep = sweepOfGrid();
  const ReportMetric metric = reportMetrics(sweep, kRelative).front();
  const auto points = plottedPoints(sweep, metric);
  const KnobEffect effect = knobEffect(sweep, sweep.varied[0], metric, points);
  EXPECT_THAT(effect.categories, ElementsAre("1", "2", "3"));
  EXPECT_EQ(effect.lines.size(), 3u);
  ASSERT_EQ(effect.means.size(), 1u) << "rivals do not have it";
  EXPECT_EQ(effect.means[0].combinations, 3u);
  // The second value's points are the fourth to sixth, a factor of 1.1 apart.
  EXPECT_NEAR(effect.means[0].seconds[1].value_or(0.0), 0.2 * std::pow(1.1, 5.0), 1e-12);
}

TEST(KnobEffect, AroundAPointBeginsWithIt) {
  Sweep sweep = sweepOf({sweepPoint("vectors", {}, 1.0, {{kRelative, 0.1}}),
                         sweepPoint("vectors", {{"a", "1"}}, 2.0, {{kRelative, 0.2}}),
                         sweepPoint("vectors", {{"a", "2"}}, 3.0, {{kRelative, 0.3}}),
                         sweepPoint("vectors", {{"b", "x"}}, 4.0, {{kRelative, 0.4}}),
                         sweepPoint("path", {}, 5.0, {{kRelative, 0.5}})});
  sweep.varied = {{"a", {"1", "2"}}, {"b", {"x"}}};
  const ReportMetric metric = reportMetrics(sweep, kRelative).front();
  const KnobEffect effect = knobEffect(sweep, sweep.varied[0], metric, plottedPoints(sweep, metric));
  EXPECT_THAT(effect.categories, ElementsAre("default", "1", "2"));
  ASSERT_EQ(effect.means.size(), 1u);
  EXPECT_EQ(effect.means[0].combinations, 1u);
  EXPECT_FALSE(effect.means[0].isOfAll);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(effect.means[0].seconds[c].value_or(0.0), 1.0 + static_cast<double>(c), 1e-12);
}

TEST(KnobEffect, WhereAllDifferInMoreIsOfAll) {
  Sweep sweep = sweepOf({sweepPoint("vectors", {{"a", "1"}, {"b", "x"}}, 1.0, {{kRelative, 0.1}}),
                         sweepPoint("vectors", {{"a", "2"}, {"b", "y"}}, 2.0, {{kRelative, 0.2}})});
  sweep.varied = {{"a", {"1", "2"}}, {"b", {"x", "y"}}};
  const ReportMetric metric = reportMetrics(sweep, kRelative).front();
  const KnobEffect effect = knobEffect(sweep, sweep.varied[0], metric, plottedPoints(sweep, metric));
  EXPECT_THAT(effect.lines, IsEmpty());
  ASSERT_EQ(effect.means.size(), 1u);
  EXPECT_TRUE(effect.means[0].isOfAll);
}

std::vector<std::string> labelsOf(std::vector<double> values, PlotScale scale) {
  std::vector<std::string> labels;
  for (const AxisTick& tick : axisTicks(plotAxis(values, {}, scale, 0.0, 600.0), 40.0)) {
    EXPECT_TRUE(tick.at >= 0.0 && tick.at <= 600.0);
    if (!tick.label.empty()) labels.push_back(tick.label);
  }
  return labels;
}

TEST(PlotAxis, HasRoundNumbers) {
  EXPECT_THAT(labelsOf({0.1, 100.0}, PlotScale::Log), ElementsAre("0.1", "1", "10", "100"));
  EXPECT_THAT(labelsOf({1.0, 10.0}, PlotScale::Log), ElementsAre("1", "2", "5", "10"));
  EXPECT_THAT(labelsOf({2.0}, PlotScale::Log), ElementsAre("1.5", "2", "2.5"));
  EXPECT_THAT(labelsOf({1e-9, 1.0}, PlotScale::Log), ElementsAre("10⁻⁸", "10⁻⁶", "10⁻⁴", "0.01", "1"));
  EXPECT_THAT(labelsOf({20.0, 45.0}, PlotScale::Linear), ElementsAre("20", "25", "30", "35", "40", "45"));
  for (const double value : {0.0, kNoLimit, -kNoLimit, 1e-300, 1e300}) {
    EXPECT_GE(labelsOf({value}, PlotScale::Log).size(), 2u) << value;
    EXPECT_GE(labelsOf({value}, PlotScale::Linear).size(), 2u) << value;
  }
}

TEST(ReportText, HasDigitsThatMatter) {
  const auto text = [](double mean, double deviation) {
    return spreadText(Spread{mean, deviation, mean, mean}, true);
  };
  EXPECT_EQ(text(1.2345, 0.0421), "1.23 ± 0.04");
  EXPECT_EQ(text(0.99999, 0.08), "1.00 ± 0.08");
  EXPECT_EQ(text(123.4, 3.0), "123 ± 3");
  EXPECT_EQ(text(kNoLimit, std::nan("")), "∞");
  EXPECT_EQ(spreadText(Spread{0.0, 0.0, 0.0, 0.0}, false), "0");
  EXPECT_EQ(reportNumber(std::nan("")), "–");
  EXPECT_EQ(reportNumber(1.5e-6), "1.50e-06");
}

TEST(ReportText, ReplacesWhatIsNoUtf8) {
  EXPECT_EQ(escapedHtml("é∞𝄞"), "é∞𝄞");
  const std::string replaced = "\xef\xbf\xbd";
  EXPECT_EQ(escapedHtml("a\xc3"), "a" + replaced) << "cut off";
  EXPECT_EQ(escapedHtml("\xc0\xaf"), replaced + replaced) << "overlong";
  EXPECT_EQ(escapedHtml("\xed\xa0\x80"), replaced + replaced + replaced) << "half of a pair";
  EXPECT_EQ(escapedHtml("\xf4\x90\x80\x80").substr(0, 3), replaced) << "beyond the last character";
}

}  // namespace
}  // namespace lightvane
