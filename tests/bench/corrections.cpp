#include "tests/bench/corrections.h"

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/measure/corrections.h"
#include "tests/bench/measure.h"
#include "tests/bench/picture_error.h"
#include "tests/bench/workbench.h"

namespace lightvane {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

struct Variant {
  std::string what;
  Settings settings;
};

/// The balanced preset, with what the settings take back.
Parameters with(const Settings& settings) {
  Parameters parameters = balanced(Method::Vectors);
  for (const auto& [key, value] : settings) {
    if (key == "method.rules") {
      applyRules(parameters.vectors, choiceNamed(kRulesNames, value).value());
      continue;
    }
    const Expected<void> set = setParameter(parameters, key, value, key);
    LV_CHECK(set.has_value(), "{}", set.error().message());
  }
  return parameters;
}

// What is no correction by itself: guards of what was corrected, other values than those printed, and several
// corrections at once.
const Variant kMoreIndirect[] = {
    {"`ilv.gradient_test=absolute`", {{"ilv.gradient_test", "absolute"}}},
    {"`ilv.gradient_limit=0`", {{"ilv.gradient_limit", "0"}}},
    {"`ilv.extrapolate_min=0`, `_max=1000`", {{"ilv.extrapolate_min", "0"}, {"ilv.extrapolate_max", "1000"}}},
    {"`ilv.weight=absolute`", {{"ilv.weight", "absolute"}}},
    {"`ilv.in_front=false`, `ilv.visibility=false`",
     {{"ilv.in_front", "false"}, {"ilv.visibility", "false"}}},
    {"`ilv.n_min_last=4`", {{"ilv.n_min_last", "4"}}},
    {"`passes.last_stride=1`", {{"passes.last_stride", "1"}}},
    {"`path.max_bounces=1`", {{"path.max_bounces", "1"}}},
    {"`path.max_bounces=2`", {{"path.max_bounces", "2"}}},
};
const Variant kMoreDirect[] = {
    {"`dlv.mode=never`", {{"dlv.mode", "never"}}},
    {"`dlv.store=vector`, `dlv.normalise=false`", {{"dlv.store", "vector"}, {"dlv.normalise", "false"}}},
};

/// Whole rules first, then one correction of the layer at a time, then what else there is.
std::vector<Variant> variantsOf(std::string_view layer, std::span<const Variant> more) {
  std::vector<Variant> variants = {{"refined", {}},
                                   {"`method.rules=paper`", {{"method.rules", "paper"}}},
                                   {"`method.rules=printed`", {{"method.rules", "printed"}}}};
  for (const Correction& correction : corrections()) {
    if (correction.layer() != layer) continue;
    variants.push_back(
        {fmt::format("`{}={}`", correction.key, correction.printed), {{correction.key, correction.printed}}});
  }
  variants.insert(variants.end(), more.begin(), more.end());
  return variants;
}

struct Row {
  Samples seconds, error, bias, records;
};

/// Renders every variant in turn, round by round, and compares the layer.
std::string table(const BenchScene& scene, const Reference& reference, std::span<const Variant> variants,
                  const Settings& common, ImageRgb Film::*layer, const CorrectionOptions& options) {
  const auto pool = std::make_shared<TaskPool>(1);
  std::vector<Row> rows(variants.size());
  for (int round = 0; round < options.rounds; ++round) {
    fmt::print(stderr, "{}: round {} of {}\n", scene.name, round + 1, options.rounds);
    for (std::size_t v = 0; v < variants.size(); ++v) {
      Settings settings = common;
      settings.insert(settings.end(), variants[v].settings.begin(), variants[v].settings.end());
      Parameters parameters = with(settings);
      parameters.picture.seed = static_cast<std::uint64_t>(round + 1);
      const Rendering rendering = render(scene, parameters, wholePicture(options.size), pool);
      rows[v].seconds.values.push_back(rendering.cpuSeconds);
      rows[v].error.values.push_back(reference.relMse(rendering.film.*layer).relMse);
      rows[v].bias.values.push_back(reference.bias(rendering.film.*layer));
      rows[v].records.values.push_back(static_cast<double>(
          layer == &Film::direct ? rendering.statistics.dlvRecords : rendering.statistics.ilvRecords));
    }
  }
  std::string text = fmt::format(
      "\n| `{}` | CPU over refined | vectors | relMSE, 10⁻³ | over refined | bias, % "
      "|\n|---|--:|--:|--:|--:|--:|\n",
      scene.name);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const Row& row = rows[v];
    text += fmt::format("| {} | {:.2f} | {:.0f} |", variants[v].what,
                        ratio(row.seconds, rows[0].seconds).median(), row.records.median());
    // The printed rules divide by what may be 0.
    text += std::isfinite(row.error.median())
                ? fmt::format(" {:.2f} | {:.2f} | {:+.2f} |\n", 1e3 * row.error.median(),
                              row.error.median() / rows[0].error.median(), 100.0 * row.bias.median())
                : " not finite | | |\n";
  }
  return text;
}

/// What keeping direct light costs and saves, by how many shadow rays its exact value takes.
std::string breakEven(const BenchScene& scene, const CorrectionOptions& options) {
  std::string text = fmt::format(
      "\n| `light.samples` on `{}` | CPU of the picture, `dlv.mode=never` over `always` | points computed in "
      "full, % "
      "|\n|--:|--:|--:|\n",
      scene.name);
  const auto pool = std::make_shared<TaskPool>(1);
  for (const char* samples : {"16", "32", "64", "128", "256"}) {
    RenderStatistics statistics;
    const auto run = [&](const char* mode) {
      return [&, mode] {
        const Rendering rendering = render(scene, with({{"light.samples", samples}, {"dlv.mode", mode}}),
                                           wholePicture(options.size), pool);
        if (rendering.statistics.interpolatedDirect > 0) statistics = rendering.statistics;
        return rendering.cpuSeconds;
      };
    };
    const std::function<double()> things[] = {run("never"), run("always")};
    const std::vector<Samples> seconds = inTurn(options.rounds, things);
    const auto full = static_cast<double>(statistics.fullDirect);
    const double points = full + static_cast<double>(statistics.interpolatedDirect);
    text += fmt::format("| {} | {} | {:.0f} |\n", samples, withSpread(ratio(seconds[0], seconds[1]), 2),
                        points > 0.0 ? 100.0 * full / points : 100.0);
  }
  return text;
}

}  // namespace

CorrectionOptions CorrectionOptions::quick() {
  CorrectionOptions options;
  options.size = 32;
  options.rounds = 1;
  options.referenceSamples = 4;
  options.indirectScenes = {"cornell-glossy"};
  options.directScenes = {"cornell-glossy"};
  return options;
}

std::string correctionsTable(const CorrectionOptions& options) {
  std::string text = fmt::format(
      "\n### Indirect light\n\nPictures of {} x {} pixels, medians of {} seeds; {} paths a pixel in each "
      "half of a reference.\n",
      options.size, options.size, options.rounds, options.referenceSamples);
  for (const std::string& name : options.indirectScenes) {
    const BenchScene scene(name);
    text += table(
        scene, Reference::ofIndirect(scene, options.size, options.referenceSamples, options.referenceFolder),
        variantsOf("indirect", kMoreIndirect), {}, &Film::indirect, options);
  }
  text += fmt::format(
      "\n### Direct light\n\nWith `dlv.mode=always` and 256 shadow rays a light, where it pays; {} shadow "
      "rays a pixel in each half of a reference.\n",
      options.referenceSamples);
  for (const std::string& name : options.directScenes) {
    const BenchScene scene(name);
    text += table(scene, Reference::ofDirect(scene, options.size, options.referenceSamples),
                  variantsOf("direct", kMoreDirect), {{"dlv.mode", "always"}, {"light.samples", "256"}},
                  &Film::direct, options);
  }
  for (const std::string& name : options.directScenes) text += breakEven(BenchScene(name), options);
  return text;
}

}  // namespace lightvane
