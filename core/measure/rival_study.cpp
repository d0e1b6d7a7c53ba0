#include "core/measure/rival_study.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/math.h"
#include "core/render/parameters.h"

namespace lightvane {
namespace {

/// A rival whose error falls with samples.
struct SampledRival {
  const char* method;
  const char* key;
  const char* unit;
  std::array<int, 4> samples;
};
// Steps of 4 halve a Monte Carlo's error. The most is what a picture of the size that studies have can
// afford; 128 samples of `naive` are the paper's (section 6).
constexpr SampledRival kSampled[] = {{"naive", "naive.samples", "samples", {8, 32, 128, 512}},
                                     {"path", "path.samples", "paths", {4, 16, 64, 256}}};
constexpr const char* kDirectLabel = "direct, ambient term";
constexpr const char* kBalancedLabel = "vectors, balanced";
constexpr const char* kIndirectMetric = "indirect.relmse";
constexpr const char* kPictureMetric = "beauty.relative";
constexpr double kInPerCent = 100.0;

std::string rivalLabel(const SampledRival& rival, int samples) {
  return fmt::format("{}, {} {}", rival.method, samples, rival.unit);
}

std::string vectorsLabel(const char* preset) { return fmt::format("vectors, {}", preset); }

const SampledRival* sampledRival(const std::string& method) {
  const auto* const found =
      std::ranges::find_if(kSampled, [&](const SampledRival& rival) { return method == rival.method; });
  return found == std::end(kSampled) ? nullptr : found;
}

/// A metric's value as a mean square; "relative" is the root of one.
std::optional<double> meanSquareOf(const SweepRun& run, const std::string& metric) {
  const auto found = run.metrics.find(metric);
  if (found == run.metrics.end()) return std::nullopt;
  return metric.ends_with(".relative") ? square(found->second) : found->second;
}

/// A method's pictures of one seed; nothing where one is not done.
std::optional<std::vector<SampledError>> picturesOf(const StudiedScene& scene, const SampledRival& rival,
                                                    std::size_t seed, const std::string& metric) {
  std::vector<SampledError> pictures;
  for (const int samples : rival.samples) {
    const SweepPoint* point = scene.pointNamed(rivalLabel(rival, samples));
    if (point == nullptr || point->runs.size() <= seed) return std::nullopt;
    const SweepRun& run = point->runs[seed];
    const auto error = meanSquareOf(run, metric);
    if (!error) return std::nullopt;
    pictures.push_back({static_cast<double>(samples), run.cpuSeconds, *error});
  }
  return pictures;
}

bool isAboveZero(double value) { return std::isfinite(value) && value > 0.0; }

/// The CPU time of so many samples by the straight line through two pictures; in proportion where noise of
/// the clock makes that fall.
double timeOfSamples(const SampledError& few, const SampledError& many, double samples) {
  const double perSample = (many.cpuSeconds - few.cpuSeconds) / (many.samples - few.samples);
  if (!(perSample > 0.0)) return many.cpuSeconds * samples / many.samples;
  return few.cpuSeconds + perSample * (samples - few.samples);
}

const char* reachSign(Reach reach) {
  return reach == Reach::Beyond ? "~" : reach == Reach::AtLeast ? "> " : "";
}

std::string timesCell(const std::optional<SpeedUp>& speedUp) {
  if (!speedUp) return kNoStudyValue;
  return reachSign(speedUp->reach) + studyRatioCell({speedUp->times, speedUp->low, speedUp->high});
}

std::string samplesCell(const std::optional<SpeedUp>& speedUp) {
  return speedUp ? fmt::format("{}{:.0f}", reachSign(speedUp->reach), speedUp->samples) : kNoStudyValue;
}

/// What a rival needed to come to the same error, by seeds or by scenes.
struct Needs {
  std::vector<double> times, samples;
  Reach reach = Reach::Measured;

  void add(double time, double itsSamples, Reach itsReach) {
    times.push_back(time);
    samples.push_back(itsSamples);
    reach = std::max(reach, itsReach);
  }
  std::optional<SpeedUp> speedUp() const {
    if (times.empty()) return std::nullopt;
    const MeanRatio mean = meanRatio(times);
    SpeedUp speedUp{mean.mean, mean.low, mean.high, meanRatio(samples).mean, reach};
    if (reach == Reach::AtLeast) speedUp.low = speedUp.high = std::nullopt;
    return speedUp;
  }
};

/// Over scenes: each counts as one value, however many seeds it had.
std::optional<SpeedUp> speedUpOverAll(std::span<const StudiedScene> scenes, const std::string& rival,
                                      const std::string& vectors, const std::string& metric) {
  Needs needs;
  for (const StudiedScene& scene : scenes) {
    if (const auto one = speedUpOver(scene, rival, vectors, metric))
      needs.add(one->times, one->samples, one->reach);
  }
  return needs.speedUp();
}

StudyTable speedUpTable(std::span<const StudiedScene> scenes) {
  StudyTable table{
      "Speed-up at equal error",
      "How many times the CPU time of vectors the rivals take to come to the same error: relMSE of the "
      "indirect layer, and the relative error of the whole picture. The geometric mean over seeds, and its "
      "95 % interval by Student's t of the logarithms; of all scenes, over scenes. The reference's own "
      "uncertainty, which all pictures share, is not in it. ~: beyond the most or the fewest samples that "
      "were rendered, by the law that a squared error falls as 1 / samples. >: at least that, as more "
      "samples take the rival's error no further down, or as vectors' error is 0 once the reference's "
      "noise is taken off. Errors and CPU times are means over the seeds ± their standard deviation among "
      "these.",
      {{"scene", "vectors", "CPU, s", "indirect: relMSE", "samples that naive needs", "over naive",
        "paths that path needs", "over path", "picture, %", "over naive", "over path"}}};
  for (const auto& preset : kPresetNames) {
    const std::string label = vectorsLabel(preset.name);
    const auto row = [&](const std::string& name, const SweepPoint* point, auto speedUp) {
      const auto naive = speedUp("naive", kIndirectMetric), path = speedUp("path", kIndirectMetric);
      table.rows.push_back(
          {name, preset.name, studyTimeCell(point), studySpreadCell(point, kIndirectMetric, 1.0),
           samplesCell(naive), timesCell(naive), samplesCell(path), timesCell(path),
           studySpreadCell(point, kPictureMetric, kInPerCent), timesCell(speedUp("naive", kPictureMetric)),
           timesCell(speedUp("path", kPictureMetric))});
    };
    for (const StudiedScene& scene : scenes) {
      row(scene.name, scene.pointNamed(label),
          [&](const char* rival, const char* metric) { return speedUpOver(scene, rival, label, metric); });
    }
    if (scenes.size() < 2) continue;
    row("*all scenes*", nullptr,
        [&](const char* rival, const char* metric) { return speedUpOverAll(scenes, rival, label, metric); });
  }
  return table;
}

/// The CPU time of one point over that of another, seed by seed.
std::string timeRatioCell(const StudiedScene& scene, const std::string& above, const std::string& below) {
  const SweepPoint* its = scene.pointNamed(above);
  const SweepPoint* other = scene.pointNamed(below);
  if (its == nullptr || other == nullptr) return kNoStudyValue;
  std::vector<double> ratios;
  for (std::size_t seed = 0; seed < std::min(its->runs.size(), other->runs.size()); ++seed) {
    const double ratio = its->runs[seed].cpuSeconds / other->runs[seed].cpuSeconds;
    if (!isAboveZero(ratio)) return kNoStudyValue;
    ratios.push_back(ratio);
  }
  return ratios.empty() ? kNoStudyValue : studyRatioCell(meanRatio(ratios));
}

StudyTable paperRatiosTable(std::span<const StudiedScene> scenes) {
  const std::string naive = rivalLabel(kSampled[0], 128);
  StudyTable table{
      "The paper's ratios",
      "Section 6 of the paper has one scene (fig4-spheres here), at 400 x 400 pixels: CPU times of 180, "
      "10 and 2 minutes, and says of errors that vectors are much less noisy. The same ratios at our size, "
      "vectors "
      "by the preset balanced, with 95 % intervals as above; and the errors at which they are had.",
      {{"scene", "naive, 128 samples : vectors", "vectors : direct with ambient",
        "naive : vectors at equal error", "indirect: relMSE of vectors", "of naive", "of direct"}}};
  table.rows.push_back(
      {"*the paper*", "18", "5", kNoStudyValue, kNoStudyValue, kNoStudyValue, kNoStudyValue});
  for (const StudiedScene& scene : scenes) {
    const auto error = [&](const std::string& label) {
      return studySpreadCell(scene.pointNamed(label), kIndirectMetric, 1.0);
    };
    table.rows.push_back({scene.name, timeRatioCell(scene, naive, kBalancedLabel),
                          timeRatioCell(scene, kBalancedLabel, kDirectLabel),
                          timesCell(speedUpOver(scene, "naive", kBalancedLabel, kIndirectMetric)),
                          error(kBalancedLabel), error(naive), error(kDirectLabel)});
  }
  return table;
}

/// One number of every picture: a row a point, a column a scene.
template <class Cell>
StudyTable allPicturesTable(std::span<const StudiedScene> scenes, const char* title, const char* text,
                            Cell&& cell) {
  StudyTable table{title, text, {{"picture"}}};
  for (const StudiedScene& scene : scenes) table.rows.front().push_back(scene.name);
  for (const RivalPoint& point : rivalPoints()) {
    std::vector<std::string> row = {point.label};
    for (const StudiedScene& scene : scenes) row.push_back(cell(scene, scene.pointNamed(point.label)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

StudyTable noiseRow(std::span<const StudiedScene> scenes, StudyTable table) {
  std::vector<std::string> row = {"*noise of the reference*"};
  for (const StudiedScene& scene : scenes)
    row.push_back(scene.sweep.referenceNoise ? fmt::format("{:.2g}", kInPerCent * *scene.sweep.referenceNoise)
                                             : kNoStudyValue);
  table.rows.push_back(std::move(row));
  return table;
}

}  // namespace

std::vector<RivalPoint> rivalPoints() {
  std::vector<RivalPoint> points;
  for (const auto& preset : kPresetNames)
    points.push_back({"vectors", {{"preset", preset.name}}, vectorsLabel(preset.name)});
  for (const SampledRival& rival : kSampled) {
    for (const int samples : rival.samples)
      points.push_back({rival.method, {{rival.key, std::to_string(samples)}}, rivalLabel(rival, samples)});
  }
  points.push_back({"direct", {}, kDirectLabel});
  return points;
}

std::optional<SamplesNeeded> samplesNeeded(std::span<const SampledError> measured, double meanSquare) {
  const auto isSound = [](const SampledError& one) {
    return isAboveZero(one.cpuSeconds) && isAboveZero(one.meanSquare);
  };
  if (measured.size() < 2 || !std::ranges::all_of(measured, isSound) || std::isnan(meanSquare))
    return std::nullopt;
  const auto taking = [&](std::size_t many, double samples, Reach reach) {
    return SamplesNeeded{samples, timeOfSamples(measured[many - 1], measured[many], samples), reach};
  };
  if (measured.front().meanSquare <= meanSquare) {
    const double samples = measured.front().samples * measured.front().meanSquare / meanSquare;
    return taking(1, std::max(samples, 1.0), Reach::Beyond);
  }
  for (std::size_t i = 1; i < measured.size(); ++i) {
    const SampledError& few = measured[i - 1];
    const SampledError& many = measured[i];
    if (few.meanSquare < meanSquare || many.meanSquare > meanSquare) continue;
    const double part = few.meanSquare == many.meanSquare ? 0.0
                                                          : std::log(few.meanSquare / meanSquare) /
                                                                std::log(few.meanSquare / many.meanSquare);
    return taking(i, few.samples * std::pow(many.samples / few.samples, part), Reach::Measured);
  }
  const std::size_t last = measured.size() - 1;
  const SampledError& few = measured[last - 1];
  const SampledError& many = measured[last];
  // Half of the law's fall, in logarithms: the root.
  const bool fallsByLaw = many.meanSquare <= few.meanSquare * std::sqrt(few.samples / many.samples);
  if (!fallsByLaw || !(meanSquare > 0.0)) return SamplesNeeded{many.samples, many.cpuSeconds, Reach::AtLeast};
  return taking(last, many.samples * many.meanSquare / meanSquare, Reach::Beyond);
}

std::optional<SpeedUp> speedUpOver(const StudiedScene& scene, const std::string& rival,
                                   const std::string& vectors, const std::string& metric) {
  const SampledRival* sampled = sampledRival(rival);
  const SweepPoint* point = scene.pointNamed(vectors);
  if (sampled == nullptr || point == nullptr) return std::nullopt;
  Needs needs;
  for (std::size_t seed = 0; seed < point->runs.size(); ++seed) {
    const SweepRun& run = point->runs[seed];
    const auto pictures = picturesOf(scene, *sampled, seed, metric);
    if (!pictures) continue;  // the rival's are not done
    const auto error = meanSquareOf(run, metric);
    if (!error || !isAboveZero(run.cpuSeconds)) return std::nullopt;
    const auto needed = samplesNeeded(*pictures, *error);
    if (!needed) return std::nullopt;
    needs.add(needed->cpuSeconds / run.cpuSeconds, needed->samples, needed->reach);
  }
  return needs.speedUp();
}

std::vector<StudyTable> rivalTables(std::span<const StudiedScene> scenes) {
  std::vector<StudyTable> tables = {speedUpTable(scenes), paperRatiosTable(scenes)};
  tables.push_back(
      allPicturesTable(scenes, "What each picture takes", "CPU time in seconds.",
                       [](const StudiedScene&, const SweepPoint* point) { return studyTimeCell(point); }));
  tables.push_back(allPicturesTable(scenes, "How far off its indirect light is", "relMSE.",
                                    [](const StudiedScene&, const SweepPoint* point) {
                                      return studySpreadCell(point, kIndirectMetric, 1.0);
                                    }));
  tables.push_back(
      noiseRow(scenes, allPicturesTable(scenes, "How far off the picture is",
                                        "The root of the mean squared relative difference, in per cent. The "
                                        "reference's own noise is taken off, and stated.",
                                        [](const StudiedScene&, const SweepPoint* point) {
                                          return studySpreadCell(point, kPictureMetric, kInPerCent);
                                        })));
  return tables;
}

}  // namespace lightvane
