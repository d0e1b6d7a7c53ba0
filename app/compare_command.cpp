#include "app/compare_command.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/command_load.h"
#include "app/error_map.h"
#include "app/json_number.h"
#include "app/output_files.h"
#include "app/stop.h"
#include "app/text_table.h"
#include "core/base/file.h"
#include "core/image/image_file.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/units.h"
#include "core/measure/comparison.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

std::vector<const MetricInfo*> askedMetrics(const CompareArguments& arguments) {
  if (arguments.metrics.empty()) return allMetrics();
  std::vector<const MetricInfo*> asked;
  for (const std::string& name : arguments.metrics) asked.push_back(findMetric(name));
  return asked;
}

std::string valueText(const MetricInfo& metric, double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "infinite" : "-infinite";
  switch (metric.unit) {
    case MetricUnit::Fraction:
      return fmt::format("{} %", numberText(100.0 * value, 3));
    case MetricUnit::Decibel:
      return fmt::format("{:.2f} dB", value);
    case MetricUnit::Radiance:
    case MetricUnit::None:
      break;
  }
  return numberText(value, 4);
}

std::string resultText(const MetricInfo& metric, const MetricResult& result) {
  std::string text = valueText(metric, result.value);
  if (result.standardError) text += " ± " + valueText(metric, *result.standardError);
  if (result.area) text += fmt::format(" at {},{}", result.area->x, result.area->y);
  return text;
}

/// What the reference's own noise has to do with a value.
std::string noiseText(const MetricInfo& metric, const MetricResult& result) {
  if (!result.ofReference) return "–";
  return fmt::format("{}, {}", valueText(metric, *result.ofReference),
                     metric.subtractsNoise ? "taken off" : "in it");
}

std::string asText(const CompareArguments& arguments, const PictureComparison& comparison,
                   const std::vector<const MetricInfo*>& asked) {
  std::string text = fmt::format("{} against {}: {} x {} pixels, of which {} count\n\n",
                                 arguments.picture.string(), arguments.reference.string(), comparison.width,
                                 comparison.height, comparison.first().counted);
  std::vector<std::vector<std::string>> errors = {{"metric"}}, noises = {{"metric"}};
  for (const LayerComparison& layer : comparison.layers) {
    errors[0].push_back(layer.layer);
    if (layer.knowsNoise) noises[0].push_back(layer.layer);
  }
  for (std::size_t m = 0; m < asked.size(); ++m) {
    for (auto* rows : {&errors, &noises}) rows->push_back({std::string(asked[m]->name)});
    for (const LayerComparison& layer : comparison.layers) {
      errors.back().push_back(resultText(*asked[m], layer.results[m]));
      if (layer.knowsNoise) noises.back().push_back(noiseText(*asked[m], layer.results[m]));
    }
  }
  text += alignedTable(errors);
  if (noises[0].size() > 1) text += "\nThe reference's noise:\n\n" + alignedTable(noises);
  return text;
}

std::string asJson(const CompareArguments& arguments, const PictureComparison& comparison,
                   const std::vector<const MetricInfo*>& asked) {
  nlohmann::ordered_json json;
  json["picture"] = arguments.picture.string();
  json["reference"] = arguments.reference.string();
  json["width"] = comparison.width;
  json["height"] = comparison.height;
  json["without"] = nlohmann::json::array();
  if (arguments.withoutEdges) json["without"].push_back("edges");
  if (arguments.withoutLights) json["without"].push_back("lights");
  for (const LayerComparison& layer : comparison.layers) {
    nlohmann::ordered_json& of = json["layers"][layer.layer];
    of["counted"] = layer.results.front().counted;
    of["not_finite"] = layer.results.front().notFinite;
    for (std::size_t m = 0; m < asked.size(); ++m) {
      const MetricResult& result = layer.results[m];
      nlohmann::ordered_json& metric = of["metrics"][std::string(asked[m]->name)];
      metric["value"] = jsonNumber(result.value);
      if (result.standardError) metric["standard_error"] = jsonNumber(*result.standardError);
      if (result.ofReference) {
        metric["of_reference_noise"] = jsonNumber(*result.ofReference);
        metric["noise_subtracted"] = asked[m]->subtractsNoise;
      }
      if (result.area)
        metric["area"] = {result.area->x, result.area->y, result.area->width, result.area->height};
    }
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Expected<void> writeMap(const CompareArguments& arguments, const fs::path& path, const MetricInfo& metric,
                        const ImageFloat& map) {
  if (!isForScreens(fileEnding(path))) {
    LayeredImage image;
    image.width = map.width();
    image.height = map.height();
    ImageRgb grey(map.width(), map.height());
    for (std::size_t i = 0; i < map.size(); ++i) grey[i] = Rgb(map[i]);
    image.setRgb("", grey);
    return writeImage(path, image);
  }
  const ViewImage view = viewOfErrorMap(metric, map);
  PictureLook look;
  look.scale = arguments.scale;
  const PictureStyle style = styleFor(look, view, 0.0);
  if (!arguments.quiet) {
    printNote(fmt::format("the map shows {} from {} (dark) to {} {} (bright)", metric.map,
                          numberText(static_cast<double>(style.scale.low), 3),
                          numberText(static_cast<double>(style.scale.high), 3), view.unit));
  }
  return writeImage(path, filePicture(displayColors(view, style)));
}

/// What may make numbers mean something else than their reader thinks.
void warn(const CompareArguments& arguments, const PictureComparison& comparison) {
  const auto isScreen = [](const fs::path& path) { return isForScreens(fileEnding(path)); };
  if (isScreen(arguments.picture) != isScreen(arguments.reference)) {
    printWarning(
        fmt::format("{} has what a screen shows, exposed and clipped, and {} has radiance",
                    (isScreen(arguments.picture) ? arguments.picture : arguments.reference).string(),
                    (isScreen(arguments.picture) ? arguments.reference : arguments.picture).string()));
  }
  for (const LayerComparison& layer : comparison.layers) {
    const std::size_t count = layer.results.front().notFinite;
    if (count == 0) continue;
    printWarning(fmt::format("{}: {} pixel{} not finite in one of the pictures and left out", layer.layer,
                             count, count == 1 ? " is" : "s are"));
  }
}

}  // namespace

Expected<ExitCode> comparePictures(const CompareArguments& arguments) {
  if (arguments.map) {
    if (auto checked = checkWritableImage(*arguments.map); !checked) return tl::unexpected(checked.error());
    const std::vector<NamedFile> written = {{*arguments.map, "--map"}};
    const std::vector<NamedFile> kept = {{arguments.picture, "the picture"},
                                         {arguments.reference, "the reference"}};
    if (auto distinct = checkDistinct(written, kept); !distinct) return tl::unexpected(distinct.error());
  }
  const auto images = untilStopped([&]() -> Expected<std::array<LayeredImage, 2>> {
    CommandLoad loading(stopOnSignals(), arguments.quiet);
    auto picture = readImage(arguments.picture, loading.watch());
    if (!picture) return tl::unexpected(picture.error());
    auto reference = readImage(arguments.reference, loading.watch());
    if (!reference) return tl::unexpected(reference.error());
    return std::array{*std::move(picture), *std::move(reference)};
  });
  if (!images && images.error().isStop) {
    if (!arguments.quiet) printNote("stopped: nothing is compared");
    return ExitCode::Stopped;
  }
  if (!images) return tl::unexpected(images.error());
  const std::vector<const MetricInfo*> asked = askedMetrics(arguments);
  const auto comparison = compareImages(
      (*images)[0], arguments.picture.string(), (*images)[1], arguments.reference.string(),
      {asked, arguments.layers, arguments.withoutEdges, arguments.withoutLights, arguments.exposureStops});
  if (!comparison) return tl::unexpected(comparison.error());
  warn(arguments, *comparison);
  if (arguments.map) {
    if (auto written = writeMap(arguments, *arguments.map, *asked.front(), comparison->first().map); !written)
      return tl::unexpected(written.error());
  }
  return printAnswer(arguments.json ? asJson(arguments, *comparison, asked)
                                    : asText(arguments, *comparison, asked))
      .map([] { return ExitCode::Success; });
}

}  // namespace lightvane
