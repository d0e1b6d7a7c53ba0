#include "app/sweep_command.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "app/command_load.h"
#include "app/error_map.h"
#include "app/picture_metadata.h"
#include "app/progress.h"
#include "app/settings.h"
#include "app/statistics_file.h"
#include "app/stop.h"
#include "app/sweep_files.h"
#include "app/text_table.h"
#include "app/version.h"
#include "app/view.h"
#include "core/base/file.h"
#include "core/base/number_text.h"
#include "core/image/image_file.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/units.h"
#include "core/io/sections.h"
#include "core/measure/picture_error.h"
#include "core/measure/sweep_report.h"
#include "core/measure/sweep_run.h"
#include "core/scene/load_scene.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// The metric that a report shows first, and maps show.
constexpr std::string_view kFirstMetric = "beauty.relative";

/// One choice of method and parameters: the points of the report, before they are rendered.
struct PlannedPoint {
  std::string method;
  SweepSettings settings;
  Parameters parameters;
};

/// A choice of a method without vectors that is put on the same axes.
struct Rival {
  const char* method;
  const char* key;  ///< of what its cost grows with; null: it has one picture
  std::vector<const char*> values;
};
const std::vector<Rival>& rivals() {
  static const std::vector<Rival> all = {{"direct", nullptr, {}},
                                         {"path", "path.samples", {"4", "16", "64", "256"}},
                                         {"naive", "naive.samples", {"8", "32", "128"}}};
  return all;
}

std::string machineName() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  std::string model = "unknown processor";
  while (std::getline(file, line)) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) model = line.substr(colon + 2);
    break;
  }
  return fmt::format("{} with {} hardware threads", model, std::thread::hardware_concurrency());
}

/// A name for files: what a shell and a web page take as it is.
std::string fileName(const std::string& text) {
  constexpr std::size_t kLongest = 100;
  std::string name;
  for (const char c : text) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         c == '.' || c == '=' || c == '-' || c == '_';
    name += isPlain ? c : '_';
  }
  if (name.size() <= kLongest) return name;
  // What is cut off is told apart by a number.
  return fmt::format("{}-{:08x}", name.substr(0, kLongest), static_cast<std::uint32_t>(checksum(text)));
}

/// The front, for a terminal.
std::string frontText(const Sweep& sweep) {
  std::vector<std::vector<std::string>> rows = {{"CPU time", "error", "ILVs", "DLVs", "point"}};
  for (const std::size_t i : paretoFront(sweep, kFirstMetric)) {
    const SweepPoint& point = sweep.points[i];
    const Spread error = metricSpread(point, kFirstMetric).value_or(Spread{});
    rows.push_back({fmt::format("{} s", numberText(cpuSpread(point).mean)),
                    fmt::format("{} % ± {}", numberText(100.0 * error.mean),
                                numberText(100.0 * error.standardDeviation, 2)),
                    std::to_string(point.runs.front().ilvRecords),
                    std::to_string(point.runs.front().dlvRecords), point.name()});
  }
  return "No point is both faster and nearer to the reference than one of these (CPU time, relative error of "
         "the "
         "picture, over all seeds):\n\n" +
         alignedTable(rows);
}

/// All that a sweep is done with.
class SweepWork {
 public:
  SweepWork(const SweepArguments& arguments, const StopFlag& stop) : arguments_(arguments), stop_(stop) {}

  /// Finds all that can be wrong before the work begins.
  Expected<void> prepare() {
    CommandLoad loading(stop_, arguments_.view.quiet);
    LoadWatch& watch = loading.watch();
    auto description = loadScene(arguments_.view.scene, watch);
    if (!description) return tl::unexpected(description.error());
    description_ = *std::move(description);
    if (auto planned = plan(); !planned) return planned;
    pool_ = std::make_shared<TaskPool>(arguments_.view.threads);
    auto tracer = tracerFor(points_.front().parameters, watch);
    if (!tracer) return tl::unexpected(tracer.error());
    const Scene& scene = *(*tracer)->sharedScene();
    auto view = chooseView(description_, scene, arguments_.view);
    if (!view) return tl::unexpected(view.error());
    view_ = *std::move(view);
    auto lights = lightFactors(scene, arguments_.view.lights, "--light");
    if (!lights) return tl::unexpected(lights.error());
    lights_ = {*lights, *lights};

    auto reference = readImage(arguments_.reference, watch);
    if (!reference) return tl::unexpected(reference.error());
    reference_ = *std::move(reference);
    const auto bytes = readFile(arguments_.reference, watch);
    if (!bytes) return tl::unexpected(bytes.error());
    if (const ImageRgb variance = varianceOf(reference_); !variance.empty())
      referenceNoise_ = pictureNoise(reference_.rgb(), variance);
    if (reference_.width != view_.region.width || reference_.height != view_.region.height) {
      return makeError(
          "--reference",
          fmt::format("{} has {}x{} pixels, the picture {}x{}", arguments_.reference.string(),
                      reference_.width, reference_.height, view_.region.width, view_.region.height));
    }
    if (const auto hash = reference_.metadata.find("scene_hash");
        hash != reference_.metadata.end() && hash->second != scene.hash)
      printWarning(fmt::format("{} is of another scene, or of this one before it changed",
                               arguments_.reference.string()));
    std::error_code error;
    fs::create_directories(arguments_.folder / "pictures", error);
    if (!fs::is_directory(arguments_.folder / "pictures", error))
      return makeError(arguments_.folder.string(), "is no folder, and cannot be made one");
    auto log = RunLog::open(arguments_.folder / "runs.jsonl");
    if (!log) return tl::unexpected(log.error());
    log_ = *std::move(log);
    sceneHash_ = scene.hash;
    keyOfAll_ = fmt::format("{} {} | {} {} | {}{} | {} threads | {}", litHash(sceneHash_, lights_.direct),
                            viewText(view_), arguments_.reference.string(), checksum(*bytes),
                            arguments_.withoutEdges ? "edges " : "",
                            arguments_.withoutLights ? "lights " : "", pool_->threadCount(), versionText());
    return {};
  }

  /// True where all runs are done.
  Expected<bool> run() {
    const Clock::time_point start = Clock::now();
    const std::size_t all = points_.size() * static_cast<std::size_t>(arguments_.seeds);
    std::size_t done = 0;
    std::size_t doneHere = 0;
    // Seed by seed over all points: what else the machine does meets them all alike.
    for (int seed = 0; seed < arguments_.seeds; ++seed) {
      for (const PlannedPoint& point : points_) {
        Parameters parameters = point.parameters;
        parameters.picture.seed += static_cast<std::uint64_t>(seed);
        ++done;
        if (log_.find(keyOf(parameters)) != nullptr) continue;
        if (stop_) return false;
        tell(fmt::format("{} of {}: {}, seed {}{}", done, all, labelOf(point), parameters.picture.seed,
                         leftText(start, doneHere, all - done + 1)));
        auto rendered = render(point, parameters, seed == 0);
        if (!rendered) return tl::unexpected(rendered.error());
        const std::optional<KeptRun> kept = *std::move(rendered);
        if (!kept) return false;
        if (auto added = log_.add(*kept); !added) return tl::unexpected(added.error());
        ++doneHere;
        if (auto written = writeNowAndThen(); !written) return tl::unexpected(written.error());
      }
    }
    return true;
  }

  /// The finished runs of this sweep's points; others that the folder has are of other sweeps.
  Sweep collected() const {
    Sweep sweep;
    sweep.scene = arguments_.view.scene.string();
    sweep.sceneHash = sceneHash_;
    sweep.width = view_.region.width;
    sweep.height = view_.region.height;
    sweep.machine = machineName();
    sweep.threads = pool_->threadCount();
    sweep.version = versionText();
    sweep.reference = arguments_.reference.string();
    sweep.referenceNoise = referenceNoise_;
    sweep.varied = arguments_.varied;
    for (const PlannedPoint& planned : points_) {
      SweepPoint point{planned.method, planned.settings, {}, {}, {}, {}};
      for (int seed = 0; seed < arguments_.seeds; ++seed) {
        Parameters parameters = planned.parameters;
        parameters.picture.seed += static_cast<std::uint64_t>(seed);
        const KeptRun* kept = log_.find(keyOf(parameters));
        if (kept == nullptr) continue;
        if (point.runs.empty()) {
          point.command = kept->command;
          point.picture = kept->picture;
          point.errorMap = kept->errorMap;
        }
        point.runs.push_back(kept->run);
      }
      if (!point.runs.empty()) sweep.points.push_back(std::move(point));
    }
    return sweep;
  }

  /// Everything but the list of runs, of a sweep as far as it is done.
  Expected<void> writeReport(const Sweep& sweep) const {
    if (sweep.points.empty()) return {};
    const auto write = [&](const char* name, const std::string& text) {
      return writeFileAtomically(arguments_.folder / name, text);
    };
    if (auto done = write("runs.csv", sweepCsv(sweep)); !done) return done;
    if (auto done = write("sweep.json", sweepJson(sweep)); !done) return done;
    return write("index.html", sweepReportHtml(sweep, std::string(kFirstMetric)));
  }

 private:
  void tell(const std::string& text) const {
    if (!arguments_.view.quiet) printNote(text);
  }
  static std::string leftText(Clock::time_point start, std::size_t done, std::size_t left) {
    if (done == 0) return {};
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return fmt::format(", about {} left",
                       durationText(seconds / static_cast<double>(done) * static_cast<double>(left)));
  }
  static std::string labelOf(const PlannedPoint& point) {
    return SweepPoint{point.method, point.settings, {}, {}, {}, {}}.name();
  }

  Expected<void> addPoint(const std::string& method, const SweepSettings& settings) {
    CommandLineSettings all = arguments_.view.settings;
    all.settings.push_back({"method.name", method, "sweep"});
    for (const auto& [key, value] : settings)
      all.settings.push_back({key, value, fmt::format("--vary {}={}", key, value)});
    const auto parameters = resolveParameters(description_.render, all);
    if (!parameters) return tl::unexpected(parameters.error());
    points_.push_back({method, settings, *parameters});
    return {};
  }

  Expected<void> plan() {
    const auto shared = resolveParameters(description_.render, arguments_.view.settings);
    if (!shared) return tl::unexpected(shared.error());
    const std::vector<SweepSettings> chosen =
        arguments_.random   ? sweepRandom(arguments_.varied, *arguments_.random, shared->picture.seed)
        : arguments_.around ? sweepAround(arguments_.varied)
                            : sweepGrid(arguments_.varied);
    for (const SweepSettings& settings : chosen) {
      if (auto added = addPoint("vectors", settings); !added) return added;
    }
    for (const Rival& rival : rivals()) {
      if (std::find(arguments_.rivals.begin(), arguments_.rivals.end(), rival.method) ==
          arguments_.rivals.end())
        continue;
      std::vector<SweepSettings> settings;
      for (const char* value : rival.values) settings.push_back({{rival.key, value}});
      if (rival.key == nullptr) settings.emplace_back();
      for (const SweepSettings& one : settings) {
        if (auto added = addPoint(rival.method, one); !added) return added;
      }
    }
    return {};
  }

  /// Scenes are compiled by a rule that parameters may vary.
  Expected<std::shared_ptr<const Tracer>> tracerFor(const Parameters& parameters,
                                                    LoadWatch& watch = LoadWatch::none()) {
    std::shared_ptr<const Tracer>& tracer = tracers_[energyRuleFor(parameters)];
    if (!tracer) {
      const auto compiled = Scene::compile(description_, energyRuleFor(parameters), watch);
      if (!compiled) return tl::unexpected(compiled.error());
      if (tracers_.size() == 1) {
        for (const std::string& warning : (*compiled)->warnings) printWarning(warning);
      }
      tracer = std::make_shared<const Tracer>(*compiled, watch);
    }
    return tracer;
  }

  std::string keyOf(const Parameters& parameters) const {
    return keyOfAll_ + " | " + nonDefaultParameters(parameters);
  }

  /// Nothing where it was stopped.
  Expected<std::optional<KeptRun>> render(const PlannedPoint& point, const Parameters& parameters,
                                          bool isFirst) {
    const auto tracer = tracerFor(parameters);
    if (!tracer) return tl::unexpected(tracer.error());
    const RenderContext context{
        (*tracer)->sharedScene(), *tracer, view_.camera, view_.region, parameters, pool_, lights_};
    if (!isWarm_) {
      // Memory is taken and pages are touched before anything is measured.
      isWarm_ = true;
      const std::unique_ptr<Renderer> unmeasured = makeRenderer(context);
      if (!renderToEnd(*unmeasured, stop_)) return std::nullopt;
    }
    const RunConditions conditions{.reference = reference_,
                                   .referenceName = arguments_.reference.string(),
                                   .comparison = {allMetrics(),
                                                  {},
                                                  arguments_.withoutEdges,
                                                  arguments_.withoutLights,
                                                  view_.camera.exposureStops},
                                   .cpuSeconds = processCpuSeconds};
    const auto done = measureRun(context, conditions, stop_);
    if (!done) return tl::unexpected(done.error());
    const std::optional<MeasuredRun>& measured = *done;
    if (!measured) return std::nullopt;
    KeptRun kept;
    kept.key = keyOf(parameters);
    kept.method = point.method;
    kept.settings = point.settings;
    kept.run = measured->run;
    kept.command = renderCommand(
        identityOfView(arguments_.view, description_, *context.scene, view_, parameters), ".exr");
    if (isFirst) {
      if (auto written = writePictures(point, measured->frame, measured->comparison, kept); !written)
        return tl::unexpected(written.error());
    }
    return kept;
  }

  /// Of all points alike, so that they can be compared by eye.
  Expected<void> writePictures(const PlannedPoint& point, const RenderFrame& frame,
                               const PictureComparison& comparison, KeptRun& kept) const {
    const std::string base =
        "pictures/" + fileName(point.settings.empty() ? point.method : point.method + "_" + labelOf(point));
    kept.picture = base + ".png";
    kept.errorMap = base + "-error.png";
    if (auto written = writeImage(arguments_.folder / kept.picture, screenPicture(frame)); !written)
      return written;
    // The first metric of the first layer, by which the page begins.
    const MetricInfo& metric = *findMetric(kFirstMetric.substr(kFirstMetric.find('.') + 1));
    const auto place = static_cast<std::size_t>(&metric - metrics().data());
    ViewImage view = viewOfErrorMap(metric, comparison.layers.front().results[place].map);
    view.scale.high = kMapEnd;
    return writeImage(arguments_.folder / kept.errorMap,
                      filePicture(displayColors(view, styleFor({}, view, 0.0))));
  }

  Expected<void> writeNowAndThen() {
    constexpr auto kInterval = std::chrono::seconds(20);
    if (Clock::now() - written_ < kInterval) return {};
    auto done = writeReport(collected());
    written_ = Clock::now();
    return done;
  }

  static constexpr float kMapEnd = 20.0f;  ///< per cent, of error maps

  const SweepArguments& arguments_;
  const StopFlag& stop_;
  SceneDescription description_;
  std::vector<PlannedPoint> points_;
  std::map<EnergyRule, std::shared_ptr<const Tracer>> tracers_;
  View view_;
  LightMix lights_;
  std::string sceneHash_;
  std::string keyOfAll_;  ///< what the keys of all runs begin with
  LayeredImage reference_;
  std::optional<double> referenceNoise_;
  RunLog log_;
  std::shared_ptr<TaskPool> pool_;
  bool isWarm_ = false;
  Clock::time_point written_ = Clock::now();
};

}  // namespace

Expected<ExitCode> runSweep(const SweepArguments& arguments) {
  const StopFlag& stop = stopOnSignals();
  SweepWork work(arguments, stop);
  const auto prepared = untilStopped([&] { return work.prepare(); });
  if (!prepared) return endWithoutScene(prepared.error(), arguments.view.quiet);
  std::optional<TimeLimit> limit;
  if (arguments.view.timeLimitSeconds) {
    const std::chrono::duration<double> allowed(*arguments.view.timeLimitSeconds);
    limit.emplace(Clock::now() + std::chrono::duration_cast<Clock::duration>(allowed));
  }
  const auto done = work.run();
  // What is finished is shown, whatever ended the work.
  const Sweep sweep = work.collected();
  if (auto written = work.writeReport(sweep); !written) return tl::unexpected(written.error());
  if (!done) return tl::unexpected(done.error());
  std::size_t runs = 0;
  for (const SweepPoint& point : sweep.points) runs += point.runs.size();
  if (runs > 0) {
    if (auto printed = printAnswer(frontText(sweep)); !printed) return tl::unexpected(printed.error());
  }
  if (!arguments.view.quiet) {
    printNote(fmt::format("{}{} rendering{} in {}: open index.html there", *done ? "" : "stopped: ", runs,
                          runs == 1 ? "" : "s", arguments.folder.string()));
    if (!*done) printNote("the same command goes on from here");
  }
  return stopSignalled() && !*done ? ExitCode::Stopped : ExitCode::Success;
}

}  // namespace lightvane
