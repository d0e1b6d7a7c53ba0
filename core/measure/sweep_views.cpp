#include "core/measure/sweep_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/base/number_text.h"
#include "core/measure/sweep_html.h"

namespace lightvane {
namespace {

constexpr const char* kCpuTitle = "CPU time, s";

struct MethodLook {
  const char* method;
  const char* shape;  ///< about (0, 0), of about equal areas
};
// Shapes differ as well as colours do: nobody needs to tell these apart.
constexpr std::array<MethodLook, 5> kLooks{{{"vectors", "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0Z"},
                                            {"path", "M-4.6 -4.6H4.6V4.6H-4.6Z"},
                                            {"naive", "M0 -5.8L5.8 4.4H-5.8Z"},
                                            {"direct", "M0 -6.4L6.4 0L0 6.4L-6.4 0Z"},
                                            {"other", "M0 6L-6 -4H6Z"}}};

const char* knownMethod(const std::string& method) {
  const auto* const found =
      std::ranges::find_if(kLooks, [&](const MethodLook& look) { return method == look.method; });
  return found == kLooks.end() ? "other" : found->method;
}

/// A pixel's tenth is what is seen; -0.0 would be the same place by another name.
std::string px(double value) { return fmt::format("{:.1f}", std::round(value * 10.0) / 10.0 + 0.0); }

std::string lineTo(double x1, double y1, double x2, double y2) {
  return fmt::format("M{} {}L{} {}", px(x1), px(y1), px(x2), px(y2));
}

std::string textAt(double x, double y, const char* classes, std::string_view text) {
  return fmt::format(R"(<text x="{}" y="{}" class="{}">{}</text>)", px(x), px(y), classes, escapedHtml(text));
}

std::string marker(const std::string& method, double x, double y, bool isSmall) {
  return fmt::format(R"(<use href="#{}-{}" x="{}" y="{}"/>)", isSmall ? "s" : "m", knownMethod(method), px(x),
                     px(y));
}

/// Where plots are within their picture.
struct PlotFrame {
  PlotBox box;

  std::string path() const {
    return fmt::format("M{} {}V{}H{}", px(box.left), px(box.top), px(box.bottom), px(box.right));
  }
};

/// Lines across, labels outside, and the places of what has no number on the axis.
std::string horizontalAxis(const PlotAxis& axis, const PlotFrame& frame) {
  const PlotBox& box = frame.box;
  std::string grid, small, labels;
  const auto mark = [&](double at, const std::string& label) {
    (label.empty() ? small : grid) += lineTo(at, label.empty() ? box.bottom - 4.0 : box.top, at, box.bottom);
    if (!label.empty()) labels += textAt(at, box.bottom + 18.0, "tick mid", label);
  };
  for (const AxisTick& tick : axisTicks(axis, 40.0)) mark(tick.at, tick.label);
  if (axis.nothing) mark(*axis.nothing, axis.isSignedNothing ? "≤ 0" : "0");
  if (axis.infinity) mark(*axis.infinity, "∞");
  return fmt::format(R"(<path class="grid" d="{}"/><path class="axis" d="{}"/>)", grid, small) + labels;
}

std::string verticalAxis(const PlotAxis& axis, const PlotFrame& frame) {
  const PlotBox& box = frame.box;
  std::string grid, small, labels;
  const auto mark = [&](double at, const std::string& label) {
    (label.empty() ? small : grid) += lineTo(box.left, at, label.empty() ? box.left + 4.0 : box.right, at);
    if (!label.empty()) labels += textAt(box.left - 8.0, at + 4.0, "tick end", label);
  };
  for (const AxisTick& tick : axisTicks(axis, 18.0)) mark(tick.at, tick.label);
  if (axis.nothing) mark(*axis.nothing, axis.isSignedNothing ? "≤ 0" : "0");
  if (axis.infinity) mark(*axis.infinity, "∞");
  return fmt::format(R"(<path class="grid" d="{}"/><path class="axis" d="{}"/>)", grid, small) + labels;
}

PlotAxis errorAxis(const ReportMetric& metric, const std::vector<double>& values,
                   const std::vector<double>& bars, const PlotBox& box) {
  if (metric.isUpwards()) return plotAxis(values, bars, metric.scale(), box.bottom, box.top);
  return plotAxis(values, bars, metric.scale(), box.top, box.bottom);
}

bool hasSeveralRuns(const SweepPoint& point) { return point.runs.size() > 1; }

std::string errorText(const Sweep& sweep, const ReportMetric& metric, const PlottedPoint& point) {
  return spreadText(metric.shown(point.metric), hasSeveralRuns(sweep.points[point.point]));
}

std::string withUnit(std::string text, const std::string& unit) {
  return unit.empty() ? text : std::move(text) + " " + unit;
}

/// With the last parts of keys, where no other key ends so: a plot has little place.
std::string labelText(const Sweep& sweep, const SweepPoint& point) {
  const auto lastPart = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  std::set<std::string> keys;
  for (const VariedParameter& knob : sweep.varied) keys.insert(knob.key);
  for (const auto& [key, value] : point.settings) keys.insert(key);
  std::string text = isRival(point) || point.settings.empty() ? point.method : "";
  for (const auto& [key, value] : point.settings) {
    const std::string part = lastPart(key);
    const bool isUnique = std::ranges::count(keys, part, lastPart) == 1;
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", isUnique ? part : key, value);
  }
  return text;
}

/// So that no label is on the front's line.
void occupyFront(const MetricView& view, const PlotAxis& x, const PlotAxis& y, LabelPlaces& places) {
  std::optional<std::pair<double, double>> last;
  for (const std::size_t p : view.front) {
    const auto point = std::ranges::find(view.points, p, &PlottedPoint::point);
    const std::pair<double, double> at(x.at(point->cpu.mean), y.at(point->error));
    // Boxes of two pixels, half as far apart as a label is high.
    const double length = last ? std::hypot(at.first - last->first, at.second - last->second) : 0.0;
    const int steps = static_cast<int>(length / 6.0);
    for (int i = 1; i < steps; ++i) {
      const double px0 = std::lerp(last->first, at.first, i / static_cast<double>(steps));
      const double py0 = std::lerp(last->second, at.second, i / static_cast<double>(steps));
      places.occupy({px0 - 1.0, py0 - 1.0, px0 + 1.0, py0 + 1.0});
    }
    last = at;
  }
}

/// Beside each point of the front what it is, or its number where that is too long; nothing where others are.
std::string frontLabels(const Sweep& sweep, const MetricView& view, const PlotAxis& x, const PlotAxis& y,
                        LabelPlaces places) {
  constexpr std::size_t kLongest = 36;  // a quarter of the plot
  std::string labels;
  for (const std::size_t p : view.front) {
    const auto point = std::ranges::find(view.points, p, &PlottedPoint::point);
    const double px0 = x.at(point->cpu.mean), py0 = y.at(point->error);
    std::string text = labelText(sweep, sweep.points[p]);
    std::optional<PlacedLabel> place;
    if (characterCount(text) <= kLongest) place = places.place(px0, py0, text);
    if (!place) {
      text = fmt::format("#{}", p + 1);
      place = places.place(px0, py0, text);
    }
    if (!place) continue;
    const char* anchor = place->anchor == TextAnchor::End      ? "label end"
                         : place->anchor == TextAnchor::Middle ? "label mid"
                                                               : "label";
    labels += textAt(place->x, place->y, anchor, text);
  }
  return labels;
}

std::string legend(const Sweep& sweep, const MetricView& view, double left, double y) {
  std::string text;
  double x = left + 6.0;
  for (const std::string& method : sweepMethods(sweep)) {
    text += fmt::format(R"(<g class="{}">{}</g>)", methodClass(method), marker(method, x, y - 4.0, false));
    text += textAt(x + 11.0, y, "legend", method);
    x += 11.0 + labelWidth(method) + 24.0;
  }
  if (view.front.size() > 1) {
    text += fmt::format(R"(<path class="front-line" d="{}"/>)", lineTo(x - 4.0, y - 4.0, x + 20.0, y - 4.0));
    text += textAt(x + 27.0, y, "legend", "Pareto front");
  }
  return text;
}

/// Each rival's points joined in the order of time.
std::string rivalLines(const Sweep& sweep, const MetricView& view, const PlotAxis& x, const PlotAxis& y) {
  std::string lines;
  for (const std::string& method : sweepMethods(sweep)) {
    std::vector<PlottedPoint> points;
    for (const PlottedPoint& point : view.points) {
      if (sweep.points[point.point].method == method && isRival(sweep.points[point.point]))
        points.push_back(point);
    }
    if (points.size() < 2) continue;
    std::ranges::sort(points, {}, [](const PlottedPoint& p) { return std::pair(p.cpu.mean, p.point); });
    std::string path;
    for (const PlottedPoint& point : points)
      path +=
          fmt::format("{}{} {}", path.empty() ? "M" : "L", px(x.at(point.cpu.mean)), px(y.at(point.error)));
    lines += fmt::format(R"(<path class="rival-line {}" d="{}"/>)", methodClass(method), path);
  }
  return lines;
}

/// How exactly the reference is known, where the plotted metric is the one that tells.
std::string noiseLine(const Sweep& sweep, const ReportMetric& metric, const PlotAxis& y, const PlotBox& box) {
  if (metric.key != "beauty.relative" || !sweep.referenceNoise || *sweep.referenceNoise <= 0.0) return {};
  const double noise = std::log10(metric.plotted(*sweep.referenceNoise));
  if (!(noise > y.low && noise < y.high)) return {};
  const double at = y.at(metric.plotted(*sweep.referenceNoise));
  return fmt::format(R"(<path class="noise-line" d="{}"/>)", lineTo(box.left, at, box.right, at)) +
         textAt(box.right - 4.0, at - 5.0, "note end", "noise of the reference");
}

std::string knobTicks(const KnobEffect& effect, const std::vector<double>& places, double y, double gap) {
  // From the left on, each label that has room; the last value is worth more than the one before it.
  std::string ticks;
  const auto half = [&](std::size_t c) { return labelWidth(effect.categories[c]) / 2.0; };
  double end = -1e9;
  for (std::size_t c = 0; c < places.size(); ++c) {
    const bool isLast = c + 1 == places.size();
    if (places[c] - half(c) < end + gap) continue;
    if (!isLast && places[c] + half(c) + gap > places.back() - half(places.size() - 1)) continue;
    ticks += textAt(places[c], y, "tick mid", effect.categories[c]);
    end = places[c] + half(c);
  }
  return ticks;
}

/// Lines through values by category; single values between gaps are seen by their markers.
template <class Value>
std::string categoryPath(const std::vector<double>& places, const PlotAxis& y, std::size_t count,
                         Value valueOf) {
  std::string path;
  for (std::size_t c = 0; c < count; ++c) {
    const std::optional<double> value = valueOf(c);
    if (value) path += fmt::format("{}{} {}", path.empty() ? "M" : "L", px(places[c]), px(y.at(*value)));
  }
  return path;
}

struct KnobPanel {
  const Sweep& sweep;
  const MetricView& view;
  const KnobEffect& effect;
  const std::vector<double>& places;

  std::string draw(const PlotFrame& frame, bool isError) const {
    const auto valueOf = [&](std::size_t p) {
      return isError ? view.points[p].error : view.points[p].cpu.mean;
    };
    std::vector<double> values;
    for (const KnobLine& line : effect.lines) {
      for (const std::optional<std::size_t>& p : line.points) {
        if (p) values.push_back(valueOf(*p));
      }
    }
    for (const KnobMean& mean : effect.means) {
      for (const std::optional<double>& value : isError ? mean.error : mean.seconds) {
        if (value) values.push_back(*value);
      }
    }
    const PlotAxis y = isError ? errorAxis(view.metric, values, {}, frame.box)
                               : plotAxis(values, {}, PlotScale::Log, frame.box.bottom, frame.box.top);
    std::string svg = verticalAxis(y, frame);
    svg += textAt(8.0, frame.box.top - 10.0, "title",
                  isError ? view.metric.axisTitle() : std::string(kCpuTitle));
    svg += fmt::format(R"(<path class="axis" d="{}"/>)", frame.path());
    for (const KnobLine& line : effect.lines) {
      svg += fmt::format(R"(<path class="knob-one {}" d="{}"/>)", methodClass(line.method),
                         categoryPath(places, y, places.size(), [&](std::size_t c) {
                           return line.points[c] ? std::optional(valueOf(*line.points[c])) : std::nullopt;
                         }));
    }
    for (const KnobMean& mean : effect.means) {
      const auto& means = isError ? mean.error : mean.seconds;
      svg += fmt::format(R"(<path class="knob-mean {}{}" d="{}"/><g class="front {}">)",
                         mean.isOfAll ? "of-all " : "", methodClass(mean.method),
                         categoryPath(places, y, places.size(), [&](std::size_t c) { return means[c]; }),
                         methodClass(mean.method));
      for (std::size_t c = 0; c < places.size(); ++c) {
        const std::optional<double>& value = means[c];
        if (value) svg += marker(mean.method, places[c], y.at(*value), true);
      }
      svg += "</g>";
    }
    return svg;
  }
};

std::string knobCaption(const KnobEffect& effect) {
  std::string caption;
  for (const KnobMean& mean : effect.means) {
    if (!caption.empty()) caption += " ";
    if (effect.means.size() > 1) caption += mean.method + ": ";
    if (mean.isOfAll) {
      caption += "Dashed: means of all points with the value, which differ in other parameters too.";
    } else if (mean.combinations == 1 &&
               std::ranges::count(effect.lines, mean.method, &KnobLine::method) == 1) {
      caption += "All other parameters are the same.";
    } else {
      caption += fmt::format(
          "Thick: mean over {} of the others that {} every value; thin: each of them.",
          mean.combinations == 1 ? "the one combination" : fmt::format("{} combinations", mean.combinations),
          mean.combinations == 1 ? "has" : "have");
    }
  }
  return caption;
}

std::string knobPlot(const Sweep& sweep, const MetricView& view, const VariedParameter& knob) {
  const KnobEffect effect = knobEffect(sweep, knob, view.metric, view.points);
  const std::string heading = fmt::format("<figcaption><code>{}</code>", escapedHtml(knob.key));
  if (effect.means.empty())
    return "<figure class=\"knob\">" + heading + "<br/>No point has it.</figcaption></figure>";

  constexpr double kWidth = 440.0, kHeight = 330.0, kLeft = 66.0;
  const PlotFrame error{{kLeft, 30.0, kWidth - 14.0, 150.0}}, cpu{{kLeft, 190.0, kWidth - 14.0, 300.0}};
  std::vector<double> places;
  const double step = (error.box.right - kLeft) / static_cast<double>(effect.categories.size());
  for (std::size_t c = 0; c < effect.categories.size(); ++c)
    places.push_back(kLeft + (static_cast<double>(c) + 0.5) * step);

  const KnobPanel panel{sweep, view, effect, places};
  return fmt::format(
      "<figure class=\"knob\">{}<br/><span class=\"quiet\">{}</span></figcaption>"
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Error and CPU time against "
      "{}\">{}{}{}</svg></figure>\n",
      heading, escapedHtml(knobCaption(effect)), kWidth, kHeight, escapedHtml(knob.key),
      panel.draw(error, true), panel.draw(cpu, false), knobTicks(effect, places, cpu.box.bottom + 18.0, 8.0));
}

}  // namespace

MetricView::MetricView(const Sweep& sweep, ReportMetric shownMetric)
    : metric(std::move(shownMetric)),
      points(plottedPoints(sweep, metric)),
      front(reportFront(sweep, points)) {}

std::string pointTitle(const SweepPoint& point) {
  if (!point.label.empty()) return point.label;
  std::string title = isRival(point) || point.settings.empty() ? point.method : "";
  for (const auto& [key, value] : point.settings)
    title += fmt::format("{}{}={}", title.empty() ? "" : " ", key, value);
  return title;
}

std::string methodClass(const std::string& method) { return std::string("k-") + knownMethod(method); }

std::vector<std::string> sweepMethods(const Sweep& sweep) {
  std::set<std::string> present;
  for (const SweepPoint& point : sweep.points) present.insert(point.method);
  std::vector<std::string> methods;
  for (const MethodLook& look : kLooks) {
    if (present.erase(look.method) > 0) methods.emplace_back(look.method);
  }
  methods.insert(methods.end(), present.begin(), present.end());
  return methods;
}

std::string markerShapes() {
  std::string shapes = R"(<svg width="0" height="0" class="shapes" aria-hidden="true"><defs>)";
  for (const MethodLook& look : kLooks) {
    shapes += fmt::format(R"x(<path id="m-{0}" d="{1}"/><path id="s-{0}" d="{1}" transform="scale(.72)"/>)x",
                          look.method, look.shape);
  }
  return shapes + "</defs></svg>\n";
}

std::string inlineMarker(const std::string& method) {
  return fmt::format(R"(<svg class="mark {}" viewBox="-8 -8 16 16" aria-hidden="true">{}</svg>)",
                     methodClass(method), marker(method, 0.0, 0.0, false));
}

std::string frontPlot(const Sweep& sweep, const MetricView& view) {
  constexpr double kWidth = 960.0, kHeight = 560.0;
  const PlotFrame frame{{78.0, 66.0, kWidth - 26.0, kHeight - 52.0}};
  const PlotBox& box = frame.box;
  std::vector<double> seconds, secondBars, errors, errorBars;
  for (const PlottedPoint& point : view.points) {
    seconds.push_back(point.cpu.mean);
    errors.push_back(point.error);
    secondBars.insert(secondBars.end(), {point.cpu.least, point.cpu.most});
    errorBars.insert(errorBars.end(), {point.leastError, point.mostError});
  }
  const PlotAxis x = plotAxis(seconds, secondBars, PlotScale::Log, box.left, box.right);
  const PlotAxis y = errorAxis(view.metric, errors, errorBars, box);

  std::string svg = fmt::format(
      "<svg class=\"main\" viewBox=\"0 0 {} {}\" role=\"group\" aria-label=\"{} against CPU time of {} "
      "points\">",
      kWidth, kHeight, escapedHtml(view.metric.axisTitle()), view.points.size());
  svg += legend(sweep, view, box.left, 20.0);
  svg += horizontalAxis(x, frame) + verticalAxis(y, frame);
  svg += fmt::format(R"(<path class="axis" d="{}"/>)", frame.path());
  svg += textAt(8.0, box.top - 16.0, "title", view.metric.axisTitle());
  svg += textAt(box.right, kHeight - 10.0, "title end", kCpuTitle);
  svg += textAt(box.left + 8.0, box.bottom - 10.0, "note", "↙ better");
  svg += noiseLine(sweep, view.metric, y, box);
  svg += rivalLines(sweep, view, x, y);

  std::vector<bool> isOnFront(sweep.points.size(), false);
  std::string frontPath;
  for (const std::size_t p : view.front) {
    isOnFront[p] = true;
    const auto point = std::ranges::find(view.points, p, &PlottedPoint::point);
    frontPath += fmt::format("{}{} {}", frontPath.empty() ? "M" : "L", px(x.at(point->cpu.mean)),
                             px(y.at(point->error)));
  }
  if (view.front.size() > 1) svg += fmt::format(R"(<path class="front-line" d="{}"/>)", frontPath);

  LabelPlaces places(box);
  occupyFront(view, x, y, places);
  places.occupy({box.left, box.bottom - 24.0, box.left + 70.0, box.bottom});  // "better"
  const bool isCrowded = view.points.size() > 100;
  std::string points, frontPoints;
  for (const PlottedPoint& point : view.points) {
    const SweepPoint& of = sweep.points[point.point];
    const double px0 = x.at(point.cpu.mean), py0 = y.at(point.error);
    places.occupy({px0 - 5.0, py0 - 5.0, px0 + 5.0, py0 + 5.0});
    std::string bars;
    if (hasSeveralRuns(of)) {
      bars = fmt::format(R"(<path class="bar" d="{}{}"/>)",
                         lineTo(x.at(point.cpu.least), py0, x.at(point.cpu.most), py0),
                         lineTo(px0, y.at(point.leastError), px0, y.at(point.mostError)));
    }
    const std::string title = fmt::format("#{} {}: {}, {} s", point.point + 1, pointTitle(of),
                                          withUnit(errorText(sweep, view.metric, point), view.metric.unit()),
                                          spreadText(point.cpu, hasSeveralRuns(of)));
    std::string& layer = isOnFront[point.point] ? frontPoints : points;
    layer += fmt::format(
        "<a class=\"point {}{}\" href=\"#row-{}\" data-p=\"{}\" tabindex=\"-1\"><title>{}</title>{}{}</a>\n",
        methodClass(of.method), isOnFront[point.point] ? " front" : "", point.point + 1, point.point + 1,
        escapedHtml(title), bars,
        marker(of.method, px0, py0, isCrowded && !isOnFront[point.point] && !isRival(of)));
  }
  svg += points + frontPoints + frontLabels(sweep, view, x, y, places) + "</svg>";
  return svg;
}

std::string frontTable(const Sweep& sweep, const MetricView& view) {
  const RivalTimes rival(sweep, view.points);
  const bool hasRival = !rival.method().empty();
  std::string table = fmt::format(
      "<div class=\"scroll\"><table><thead><tr><th class=\"l\">point</th><th class=\"n\">{}</th>"
      "<th class=\"n\">{}</th>{}<th class=\"settings\">settings</th></tr></thead><tbody>\n",
      escapedHtml(view.metric.labelWithUnit()), kCpuTitle,
      hasRival
          ? fmt::format("<th class=\"n\">faster than {}<br/>at equal error</th>", escapedHtml(rival.method()))
          : "");
  for (const std::size_t p : view.front) {
    const SweepPoint& point = sweep.points[p];
    const auto plotted = std::ranges::find(view.points, p, &PlottedPoint::point);
    std::string factor = hasRival ? "–" : "";
    const std::optional<double> seconds = rival.secondsFor(plotted->loss);
    if (seconds && point.method != rival.method() && plotted->cpu.mean > 0.0)
      factor = reportNumber(*seconds / plotted->cpu.mean) + " ×";
    if (hasRival) factor = fmt::format(R"(<td class="n">{}</td>)", factor);
    table += fmt::format(
        "<tr data-p=\"{0}\"><td class=\"l\"><a href=\"#point-{0}\">#{0}</a></td><td class=\"n\">{1}</td>"
        "<td class=\"n\">{2}</td>{3}<td class=\"settings\">{4} "
        "<code>{5}</code></td></tr>\n",
        p + 1, errorText(sweep, view.metric, *plotted), spreadText(plotted->cpu, hasSeveralRuns(point)),
        factor, inlineMarker(point.method), escapedHtml(pointTitle(point)));
  }
  return table + "</tbody></table></div>\n";
}

std::string knobPlots(const Sweep& sweep, const MetricView& view) {
  std::string plots = "<div class=\"knobs\">\n";
  for (const VariedParameter& knob : sweep.varied) plots += knobPlot(sweep, view, knob);
  return plots + "</div>\n";
}

}  // namespace lightvane
