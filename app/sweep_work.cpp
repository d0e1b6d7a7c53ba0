#include "app/sweep_work.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "app/error_map.h"
#include "app/messages.h"
#include "app/output_files.h"
#include "app/settings.h"
#include "app/statistics_file.h"
#include "app/version.h"
#include "core/base/file.h"
#include "core/base/number_text.h"
#include "core/image/image_file.h"
#include "core/inspect/picture_style.h"
#include "core/io/sections.h"
#include "core/measure/picture_error.h"
#include "core/measure/sweep_report.h"
#include "core/measure/sweep_run.h"
#include "core/scene/lit_only_by.h"
#include "core/scene/load_scene.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

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

/// The largest size within `most` that has the camera's shape.
PictureSize fittedSize(const CameraDescription& camera, const PictureSize& most) {
  const double scale = std::min(static_cast<double>(most.width) / camera.width,
                                static_cast<double>(most.height) / camera.height);
  const auto scaled = [&](int side) { return std::max(1, static_cast<int>(std::lround(scale * side))); };
  return {scaled(camera.width), scaled(camera.height)};
}

}  // namespace

SweepWork::SweepWork(SweepArguments arguments, const StopFlag& stop, std::shared_ptr<TaskPool> pool)
    : arguments_(std::move(arguments)), stop_(stop), pool_(std::move(pool)), thumbnails_(arguments_.folder) {}

Expected<void> SweepWork::load(LoadWatch& watch, bool isMost) {
  auto description = loadScene(arguments_.view.scene, watch);
  if (!description) return tl::unexpected(description.error());
  description_ = *std::move(description);
  if (isMost && arguments_.view.size)
    arguments_.view.size = fittedSize(description_.cameras.front(), *arguments_.view.size);
  return prepare(watch);
}

Expected<void> SweepWork::prepare(LoadWatch& watch) {
  const auto shared = sharedParameters();
  if (!shared) return tl::unexpected(shared.error());
  auto tracer = tracerFor(*shared, watch);
  if (!tracer) return tl::unexpected(tracer.error());
  const Scene& scene = *(*tracer)->sharedScene();
  auto view = chooseView(description_, scene, arguments_.view);
  if (!view) return tl::unexpected(view.error());
  view_ = *std::move(view);
  auto lights = lightFactors(scene, arguments_.view.lights, "--light");
  if (!lights) return tl::unexpected(lights.error());
  lights_ = {*lights, *lights};
  sceneHash_ = scene.hash;
  return {};
}

Expected<std::unique_ptr<SweepWork>> SweepWork::litOnlyBy(std::optional<std::uint32_t> light,
                                                          SweepArguments arguments, LoadWatch& watch) const {
  auto work = std::make_unique<SweepWork>(std::move(arguments), stop_, pool_);
  work->description_ = lightvane::litOnlyBy(description_, scene(), light);
  work->tellsWarnings_ = false;
  for (std::uint32_t other = 0; other < scene().lights.size(); ++other) {
    if (other != light) work->putOut_.push_back({scene().lightNames[other], Rgb(0.0f)});
  }
  if (auto prepared = work->prepare(watch); !prepared) return tl::unexpected(prepared.error());
  return work;
}

bool SweepWork::keepsDirectVectors(const Parameters& parameters) const {
  const std::vector<bool> keeps = lightsWithVectors(scene(), parameters);
  return std::ranges::find(keeps, true) != keeps.end();
}

Expected<Parameters> SweepWork::sharedParameters() const {
  return resolveParameters(description_.render, arguments_.view.settings);
}

Expected<Parameters> SweepWork::parametersOf(const std::string& method, const SweepSettings& settings,
                                             const std::string& where) const {
  CommandLineSettings all = arguments_.view.settings;
  all.settings.push_back({"method.name", method, "sweep"});
  for (const auto& [key, value] : settings)
    all.settings.push_back({key, value, fmt::format(fmt::runtime(where), key, value)});
  return resolveParameters(description_.render, all);
}

Expected<void> SweepWork::readReference(LoadWatch& watch) {
  std::string checksums;
  std::vector<fs::path> files = {arguments_.reference};
  if (arguments_.secondReference) files.push_back(*arguments_.secondReference);
  std::vector<LayeredImage> halves;
  for (const fs::path& file : files) {
    auto image = readImage(file, watch);
    if (!image) return tl::unexpected(image.error());
    const auto bytes = readFile(file, watch);
    if (!bytes) return tl::unexpected(bytes.error());
    checksums += fmt::format("{}{}", checksums.empty() ? "" : " ", checksum(*bytes));
    if (image->width != view_.region.width || image->height != view_.region.height) {
      return makeError("--reference",
                       fmt::format("{} has {}x{} pixels, the picture {}x{}", file.string(), image->width,
                                   image->height, view_.region.width, view_.region.height));
    }
    if (auto known = warnOfReference(file, *image); !known) return known;
    halves.push_back(*std::move(image));
  }
  reference_ = halves.size() == 2 ? meanOfHalves(halves[0], halves[1]) : std::move(halves.front());
  if (const ImageRgb variance = varianceOf(reference_); !variance.empty())
    referenceNoise_ = pictureNoise(reference_.rgb(), variance);
  for (const char* layer : {"direct", "indirect"}) {
    if (const ImageRgb variance = varianceOf(reference_, layer); !variance.empty())
      layerNoise_[layer] = pictureNoise(reference_.rgb(layer), variance);
  }
  keyOfAll_ = fmt::format("{} {} | {} {} | {}{} | {} threads | {}", litHash(sceneHash_, lights_.direct),
                          viewText(view_), arguments_.reference.string(), checksums,
                          arguments_.withoutEdges ? "edges " : "", arguments_.withoutLights ? "lights " : "",
                          pool_->threadCount(), versionText());
  return {};
}

Expected<void> SweepWork::warnOfReference(const fs::path& file, const LayeredImage& image) {
  // Pictures from elsewhere say nothing.
  if (!image.metadata.contains("scene_hash")) return {};
  const auto parameters = sharedParameters();
  if (!parameters) return tl::unexpected(parameters.error());
  const auto context = contextOf(*parameters);
  if (!context) return tl::unexpected(context.error());
  const auto ours = pictureMetadata(identityOf(*context), ".exr");
  const auto valueOf = [](const auto& metadata, const char* key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : found->second;
  };
  const auto differs = [&](const char* key) { return valueOf(ours, key) != valueOf(image.metadata, key); };
  const auto warn = [&](const std::string& what) { printWarning(file.string() + " " + what); };
  if (differs("scene_hash")) {
    warn("is of another scene, or of this one before it changed");
  } else {
    if (differs("lights")) warn("has lights of other brightness than the sweep's pictures (--light)");
    if (differs("camera") || differs("camera_changes") || differs("crop"))
      warn("is seen by another camera than the sweep's pictures");
  }
  const std::string method = valueOf(image.metadata, "method");
  if (method != "path" && method != "naive")
    warn("was not path traced: what it has in common with the sweep's pictures is taken for right");
  const std::string samples = fmt::format("film.samples={}", parameters->picture.filmSamples);
  const std::string settings = " " + valueOf(image.metadata, "parameters") + " ";
  const bool isSampledAlike = parameters->picture.filmSamples == Parameters{}.picture.filmSamples
                                  ? settings.find(" film.samples=") == std::string::npos
                                  : settings.find(" " + samples + " ") != std::string::npos;
  if (!isSampledAlike) warn(fmt::format("was not rendered with the sweep's {}: edges differ", samples));
  return {};
}

Expected<void> SweepWork::begin(LoadWatch& watch) {
  if (auto read = readReference(watch); !read) return read;
  for (const fs::path& folder : {arguments_.folder, arguments_.folder / "pictures"}) {
    if (auto made = makeFolder(folder); !made) return made;
  }
  auto log = RunLog::open(arguments_.folder / "runs.jsonl");
  if (!log) return tl::unexpected(log.error());
  log_ = *std::move(log);
  for (const PlannedPoint& point : points_) {
    for (int seed = 0; seed < seedsOf(point); ++seed) left_ += log_.find(keyOf(point, seed)) ? 0 : 1;
  }
  return {};
}

std::size_t SweepWork::runCount() const {
  std::size_t count = 0;
  for (const PlannedPoint& point : points_) count += static_cast<std::size_t>(seedsOf(point));
  return count;
}

Expected<bool> SweepWork::runSeed(int seed, std::span<const SweepWork* const> all, SweepProgress& progress) {
  std::size_t count = 0;
  for (const SweepWork* work : all) count += work->runCount();
  for (const PlannedPoint& point : points_) {
    if (seed >= seedsOf(point)) continue;
    ++progress.passed;
    if (log_.find(keyOf(point, seed)) != nullptr) continue;
    if (stop_) return false;
    const std::string scene = all.size() > 1 ? arguments_.view.scene.stem().string() + ", " : "";
    tell(fmt::format("{} of {}: {}{}, seed {}{}", progress.passed, count, scene, labelOf(point),
                     point.parameters.picture.seed + static_cast<std::uint64_t>(seed), leftText(all)));
    const Clock::time_point begun = Clock::now();
    auto rendered = render(point, seed);
    if (!rendered) return tl::unexpected(rendered.error());
    const std::optional<KeptRun> kept = *std::move(rendered);
    if (!kept) return false;
    if (auto added = log_.add(*kept); !added) return tl::unexpected(added.error());
    --left_;
    ++doneHere_;
    secondsHere_ += std::chrono::duration<double>(Clock::now() - begun).count();
    if (auto written = writeNowAndThen(); !written) return tl::unexpected(written.error());
  }
  return true;
}

Sweep SweepWork::collected() const {
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
  sweep.layerNoise = layerNoise_;
  sweep.varied = arguments_.varied;
  for (const PlannedPoint& planned : points_) {
    SweepPoint point{planned.method, planned.settings, {}, {}, {}, {}, planned.label};
    for (int seed = 0; seed < seedsOf(planned); ++seed) {
      const KeptRun* kept = log_.find(keyOf(planned, seed));
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

Expected<void> SweepWork::writeReport(const Sweep& sweep) {
  if (sweep.points.empty()) return {};
  const auto write = [&](const char* name, const std::string& text) {
    return writeFileAtomically(arguments_.folder / name, text);
  };
  if (auto done = write("runs.csv", sweepCsv(sweep)); !done) return done;
  if (auto done = write("sweep.json", sweepJson(sweep)); !done) return done;
  return write("index.html", sweepReportHtml(sweep, std::string(kFirstMetric), thumbnails_.of(sweep)));
}

void SweepWork::tell(const std::string& text) const {
  if (!arguments_.view.quiet) printNote(text);
}

std::string SweepWork::labelOf(const PlannedPoint& point) {
  return SweepPoint{point.method, point.settings, {}, {}, {}, {}, point.label}.name();
}

/// Scenes differ by orders of magnitude: each is judged by its own runs, and by the others' before it has
/// any.
std::string SweepWork::leftText(std::span<const SweepWork* const> all) {
  double seconds = 0.0;
  std::size_t done = 0;
  for (const SweepWork* work : all) {
    seconds += work->secondsHere_;
    done += work->doneHere_;
  }
  if (done == 0) return {};
  const double perRun = seconds / static_cast<double>(done);
  double left = 0.0;
  for (const SweepWork* work : all) {
    const double own =
        work->doneHere_ > 0 ? work->secondsHere_ / static_cast<double>(work->doneHere_) : perRun;
    left += own * static_cast<double>(work->left_);
  }
  return fmt::format(", about {} left", durationText(left));
}

/// Scenes are compiled by a rule that parameters may vary.
Expected<std::shared_ptr<const Tracer>> SweepWork::tracerFor(const Parameters& parameters, LoadWatch& watch) {
  std::shared_ptr<const Tracer>& tracer = tracers_[energyRuleFor(parameters)];
  if (!tracer) {
    const auto compiled = Scene::compile(description_, energyRuleFor(parameters), watch);
    if (!compiled) return tl::unexpected(compiled.error());
    if (tracers_.size() == 1 && tellsWarnings_) {
      for (const std::string& warning : (*compiled)->warnings) printWarning(warning);
    }
    tracer = std::make_shared<const Tracer>(*compiled, watch);
  }
  return tracer;
}

std::string SweepWork::keyOf(const PlannedPoint& point, int seed) const {
  Parameters parameters = point.parameters;
  parameters.picture.seed += static_cast<std::uint64_t>(seed);
  return keyOfAll_ + " | " + nonDefaultParameters(parameters);
}

Expected<RenderContext> SweepWork::contextOf(const Parameters& parameters) {
  const auto tracer = tracerFor(parameters);
  if (!tracer) return tl::unexpected(tracer.error());
  return RenderContext{
      (*tracer)->sharedScene(), *tracer, view_.camera, view_.region, parameters, pool_, lights_};
}

PictureIdentity SweepWork::identityOf(const RenderContext& context) const {
  PictureIdentity identity =
      identityOfView(arguments_.view, description_, *context.scene, view_, context.parameters);
  identity.lights.insert(identity.lights.end(), putOut_.begin(), putOut_.end());
  return identity;
}

Expected<bool> SweepWork::writeReference(const Parameters& parameters, const fs::path& file) {
  const auto context = contextOf(parameters);
  if (!context) return tl::unexpected(context.error());
  const std::unique_ptr<Renderer> renderer = makeRenderer(*context);
  if (!renderToEnd(*renderer, stop_)) return false;
  LayeredImage layers = renderer->film().toLayers(*context->scene);
  layers.metadata = pictureMetadata(identityOf(*context), file.extension().string());
  if (auto written = writeImage(file, layers); !written) return tl::unexpected(written.error());
  return true;
}

/// Nothing where it was stopped.
Expected<std::optional<KeptRun>> SweepWork::render(const PlannedPoint& point, int seed) {
  Parameters parameters = point.parameters;
  parameters.picture.seed += static_cast<std::uint64_t>(seed);
  const auto made = contextOf(parameters);
  if (!made) return tl::unexpected(made.error());
  const RenderContext& context = *made;
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
  kept.key = keyOf(point, seed);
  kept.method = point.method;
  kept.settings = point.settings;
  kept.run = measured->run;
  kept.command = renderCommand(identityOf(context), ".exr");
  if (seed == 0) {
    if (auto written = writePictures(point, measured->frame, measured->comparison, kept); !written)
      return tl::unexpected(written.error());
  }
  return kept;
}

/// Of all points alike, so that they can be compared by eye.
Expected<void> SweepWork::writePictures(const PlannedPoint& point, const RenderFrame& frame,
                                        const PictureComparison& comparison, KeptRun& kept) const {
  constexpr float kMapEnd = 20.0f;  // per cent
  // Runs that differ in what is not varied have pictures of their own.
  const std::string base =
      fmt::format("pictures/{}-{:08x}",
                  plainFileName(point.settings.empty() ? point.method : point.method + "_" + labelOf(point)),
                  static_cast<std::uint32_t>(lightvane::checksum(kept.key)));
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

Expected<void> SweepWork::writeNowAndThen() {
  constexpr auto kInterval = std::chrono::seconds(20);
  if (Clock::now() - written_ < kInterval) return {};
  auto done = writeReport(collected());
  written_ = Clock::now();
  return done;
}

}  // namespace lightvane
