#include "app/render_command.h"

#include <algorithm>
#include <chrono>
#include <climits>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/command_load.h"
#include "app/error_report.h"
#include "app/output_files.h"
#include "app/picture_metadata.h"
#include "app/progress.h"
#include "app/render_status.h"
#include "app/settings.h"
#include "app/statistics_file.h"
#include "app/stop.h"
#include "app/text_table.h"
#include "app/version.h"
#include "app/view.h"
#include "core/base/file.h"
#include "core/base/number_text.h"
#include "core/image/image_file.h"
#include "core/inspect/units.h"
#include "core/io/cache_file.h"
#include "core/io/ply_file.h"
#include "core/measure/picture_error.h"
#include "core/measure/target_error.h"
#include "core/render/error_estimate.h"
#include "core/render/memory.h"
#include "core/scene/load_scene.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// What the arguments mean on this scene: all that is known before the work begins.
struct Job {
  const RenderArguments& arguments;
  SceneDescription description;
  Parameters parameters;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Tracer> tracer;
  View view;
  LightMix lights;
  ErrorBase reference;  ///< with which the Error view compares
  fs::path checkpointPath;
};

/// How far --target-error has come.
struct Refinement {
  std::optional<double> error;          ///< of the picture as it is
  std::optional<double> samplingError;  ///< of light that no vectors interpolate; the same in all rounds
  std::uint32_t rounds = 0;             ///< in which vectors were added
  int idleRounds = 0;                   ///< of those the last ones, without a gain worth its name
  bool isOver = false;                  ///< the target is met, or more vectors do not help
};

/// The rendering itself, and where it began.
struct Work {
  RenderContext context;
  std::unique_ptr<Renderer> renderer;
  CacheIdentity checkpointIdentity;
  int passesBefore = 0;                 ///< of the checkpoint that it goes on from
  std::optional<double> noise;          ///< where a target was set: that of the picture as it is
  Refinement refinement;                ///< where an error was set as the target
  std::optional<ErrorSources> sources;  ///< where they were asked for, and found

  bool isComplete(const Job& job) const {
    const std::optional<double>& target = job.arguments.targetNoise;
    const bool isDone = renderer->done() && (!job.arguments.targetError || refinement.isOver);
    return isDone || (noise && target && *noise <= *target);
  }
};

void note(const Job& job, const std::string& text) {
  if (!job.arguments.quiet) printNote(text);
}

/// The rules `printed` work on a cache of their own, row by row: they take no other's vectors, and a stopped
/// picture begins anew.
bool hasPrivateCache(const Parameters& parameters) {
  return parameters.picture.method == Method::Vectors && parameters.vectors.rules == Rules::Printed;
}

Expected<void> checkOptions(const RenderArguments& arguments, const Parameters& parameters,
                            const fs::path& checkpointPath) {
  if (arguments.lockCache && !arguments.cache) {
    return makeError("--lock-cache", "there is no cache to lock", "give one with --cache FILE");
  }
  const char* cacheOption = arguments.cache ? "--cache" : arguments.saveCache ? "--save-cache" : nullptr;
  if (cacheOption != nullptr && parameters.picture.method != Method::Vectors) {
    return makeError(cacheOption, "caches hold light vectors, and this method has none",
                     "use --method vectors");
  }
  if (arguments.cache && isPlyPath(*arguments.cache)) {
    return makeError("--cache",
                     fmt::format("{} is a point cloud for other programs, and no cache can be read from one",
                                 arguments.cache->string()),
                     "give a file that --save-cache wrote under another extension");
  }
  if (arguments.cache && hasPrivateCache(parameters)) {
    return makeError("--cache", "the rules `printed` begin with an empty cache, as the paper does",
                     "use --set method.rules=paper or refined");
  }

  const bool keepsVectors = parameters.picture.method == Method::Vectors && !hasPrivateCache(parameters);
  if (arguments.targetError && !keepsVectors) {
    return makeError("--target-error", "only light vectors that may be added to tell how far off they are",
                     "use --method vectors with --set method.rules=refined or paper");
  }
  if (arguments.targetError && arguments.lockCache)
    return makeError("--target-error", "a locked cache takes no more vectors", "leave out --lock-cache");

  if (arguments.explain && !keepsVectors) {
    return makeError("--explain", "only light vectors that are kept tell where their error comes from",
                     "use --method vectors with --set method.rules=refined or paper");
  }
  const PictureView view = arguments.look.view;
  if (tellsOfVectors(view) && !keepsVectors) {
    return makeError("--view",
                     fmt::format("`{}` tells of light vectors, and neither other methods nor the rules "
                                 "`printed` have any to show",
                                 pictureViewInfo(view).name),
                     "use --method vectors with --set method.rules=refined or paper");
  }

  std::vector<NamedFile> written;
  for (const fs::path& output : arguments.outputs) {
    if (auto checked = checkWritableImage(output); !checked) return checked;
    written.push_back({output, "--output"});
  }
  const auto addFile = [&](const std::optional<fs::path>& path, const char* option) -> Expected<void> {
    if (!path) return {};
    written.push_back({*path, option});
    return checkWritable(*path);
  };
  if (auto checked = addFile(arguments.stats, "--stats"); !checked) return checked;
  if (auto checked = addFile(arguments.saveCache, "--save-cache"); !checked) return checked;
  if (auto checked = addFile(checkpointPath, "the file that --resume goes on from"); !checked) return checked;
  std::vector<NamedFile> kept = {{arguments.scene, "the scene"}};
  if (arguments.reference) kept.push_back({*arguments.reference, "--reference"});
  return checkDistinct(written, kept);
}

/// Refuses a picture that the machine has no memory for before anything is allocated for it: a system that
/// gives what it does not have would end the process in the middle.
Expected<void> checkMemory(const Job& job) {
  const std::size_t bytes = estimatedPictureBytes(*job.scene, job.parameters, job.view.region);
  const std::uint64_t most = memoryBytes();
  if (bytes <= most) return {};
  return makeError(
      "--size",
      fmt::format("a picture of {} x {} pixels takes about {}, and the machine has {}", job.view.region.width,
                  job.view.region.height, byteText(bytes), byteText(most)),
      "make it smaller, take fewer samples a pixel or, where lights are many, dlv.mode=auto");
}

Expected<ErrorBase> readReference(const fs::path& path, const PictureRegion& region, LoadWatch& watch) {
  const LoadStage stage(watch, "reading " + path.filename().string());
  const auto image = readImage(path, watch);
  if (!image) return tl::unexpected(image.error());
  if (image->width != region.width || image->height != region.height) {
    return makeError("--reference", fmt::format("{} has {}x{} pixels, the picture {}x{}", path.string(),
                                                image->width, image->height, region.width, region.height));
  }
  return ErrorBase{std::make_shared<const ImageRgb>(image->rgb()), path.filename().string()};
}

/// Where a target is to be met, the mean of ilv.n_max vectors is not the best there is to have.
void takeAllVectors(const CommandLineSettings& command, Parameters& parameters) {
  constexpr int kAll = 256;
  const bool isSet = std::any_of(command.settings.begin(), command.settings.end(),
                                 [](const RenderSetting& setting) { return setting.key == "ilv.n_max"; });
  int& most = parameters.vectors.ilv.nMax;
  if (!isSet) most = std::max(most, kAll);
}

/// Throws LoadStopped as `watch` says.
Expected<Job> prepare(const RenderArguments& arguments, LoadWatch& watch) {
  Job job{arguments, {}, {}, nullptr, nullptr, {}, {}, {}, arguments.outputs.front().string() + ".resume"};
  auto description = loadScene(arguments.scene, watch);
  if (!description) return tl::unexpected(description.error());
  job.description = *std::move(description);

  auto parameters = resolveParameters(job.description.render, arguments.settings);
  if (!parameters) return tl::unexpected(parameters.error());
  job.parameters = *parameters;
  if (arguments.targetError) takeAllVectors(arguments.settings, job.parameters);
  if (auto checked = checkOptions(arguments, job.parameters, job.checkpointPath); !checked) {
    return tl::unexpected(checked.error());
  }

  auto scene = Scene::compile(job.description, energyRuleFor(job.parameters), watch);
  if (!scene) return tl::unexpected(scene.error());
  job.scene = *std::move(scene);
  auto view = chooseView(job.description, *job.scene, arguments);
  if (!view) return tl::unexpected(view.error());
  job.view = *std::move(view);
  if (auto checked = checkMemory(job); !checked) return tl::unexpected(checked.error());
  auto direct = lightFactors(*job.scene, arguments.lights, "--light");
  if (!direct) return tl::unexpected(direct.error());
  auto indirect = arguments.indirectLights.empty()
                      ? direct
                      : lightFactors(*job.scene, arguments.indirectLights, "--indirect-light");
  if (!indirect) return tl::unexpected(indirect.error());
  job.lights = {*std::move(direct), *std::move(indirect)};
  if (arguments.reference) {
    auto reference = readReference(*arguments.reference, job.view.region, watch);
    if (!reference) return tl::unexpected(reference.error());
    job.reference = *std::move(reference);
  }
  job.tracer = std::make_shared<const Tracer>(job.scene, watch);
  return job;
}

/// Of a stopped rendering: where it looked, and which vectors it began with.
CacheIdentity checkpointIdentity(const Job& job, const Snapshot* warm) {
  CacheIdentity identity{litHash(job.scene->hash, job.lights.direct), parametersAsText(job.parameters),
                         viewText(job.view)};
  if (job.lights.indirect != job.lights.direct)
    identity.view += ", reflected light of " + litHash("other lights", job.lights.indirect);
  if (warm != nullptr && job.arguments.cache) {
    identity.view +=
        fmt::format(", on {}{} with {} ILVs and {} DLVs", job.arguments.lockCache ? "locked " : "",
                    job.arguments.cache->string(), warm->indirect.size(), warm->directCount());
  }
  return identity;
}

/// Goes on from the checkpoint where --resume asks for it and there is one.
Expected<void> resume(const Job& job, Work& work) {
  const std::string name = job.checkpointPath.string();
  std::error_code error;
  const bool exists = fs::exists(job.checkpointPath, error);
  if (!job.arguments.resume) {
    if (exists) note(job, fmt::format("{} is not used: --resume would go on from it", name));
    return {};
  }
  if (!exists) {
    note(job, fmt::format("{} is not there: rendering from the start", name));
    return {};
  }
  const auto checkpoint =
      readCheckpoint(job.checkpointPath, work.checkpointIdentity, *job.scene, job.parameters.vectors);
  if (!checkpoint) return tl::unexpected(checkpoint.error());
  if (job.arguments.passes && *job.arguments.passes <= checkpoint->passes) {
    return makeError(name,
                     fmt::format("was stopped after {} passes, and --passes {} asks for no more",
                                 checkpoint->passes, *job.arguments.passes),
                     "leave out --passes or --resume");
  }
  const PictureParameters& picture = job.parameters.picture;
  if (picture.method == Method::Path && picture.pathSamples <= checkpoint->samples) {
    return makeError(
        name,
        fmt::format("has {} samples a pixel, and {} are asked for", checkpoint->samples, picture.pathSamples),
        "ask for more with --spp, or leave out --resume");
  }
  work.renderer->restore(*checkpoint);
  work.passesBefore = checkpoint->passes;
  note(job, fmt::format("going on from {}, stopped after pass {}", name, checkpoint->passes));
  return {};
}

Expected<Work> begin(const Job& job) {
  Work work;
  work.context = {job.scene,       job.tracer,     job.view.camera,
                  job.view.region, job.parameters, std::make_shared<TaskPool>(job.arguments.threads),
                  job.lights};
  CacheInput cache;
  if (job.arguments.cache) {
    auto content =
        readCache(*job.arguments.cache, vectorsIdentity(job.description, job.lights.indirect, job.parameters),
                  *job.scene, job.parameters.vectors);
    if (!content) return tl::unexpected(content.error());
    for (const std::string& warning : content->warnings) printWarning(warning);
    cache.warm = std::make_shared<const Snapshot>(std::move(content->snapshot));
    cache.locked = job.arguments.lockCache;
  }
  work.checkpointIdentity = checkpointIdentity(job, cache.warm.get());
  work.renderer = makeRenderer(work.context, cache);
  if (auto resumed = resume(job, work); !resumed) return tl::unexpected(resumed.error());
  return work;
}

/// Looks how noisy the picture is, where a target was set, and returns how far the work is.
RenderProgress lookAtNoise(const Job& job, Work& work) {
  RenderProgress progress = work.renderer->progress();
  if (!job.arguments.targetNoise) return progress;
  progress.stage = fmt::format("{} paths a pixel", progress.paths);
  progress.fraction = 0.0;
  if (work.renderer->statistics().passes < kLeastReferencePasses) return progress;
  const Film film = work.renderer->film();
  work.noise = pictureNoise(film.beauty(), film.variance);
  progress.stage += fmt::format(", noise {} %", numberText(100.0 * *work.noise));
  const double part = *work.noise > 0.0 ? *job.arguments.targetNoise / *work.noise : 1.0;
  progress.fraction = std::min(part * part, 1.0);  // it falls with the root of the paths
  return progress;
}

/// Of a picture that is done, looks how far off its vectors say it is, and asks for more where that is too
/// much.
void lookAtError(const Job& job, Work& work, const StopFlag& stop) {
  Refinement& refinement = work.refinement;
  if (!job.arguments.targetError || !work.renderer->done() || refinement.isOver) return;
  const RenderFrame frame = makeFrame(work.context, *work.renderer);
  const ErrorEstimate estimate = estimateError(frame, *work.context.pool, stop);
  if (!refinement.samplingError && !stop) {
    const double error = samplingErrorOf(frame, estimateSamplingNoise(frame, *work.context.pool, stop));
    if (std::isfinite(error) && !stop) refinement.samplingError = error;
  }
  if (stop) return;
  const TargetError found = targetErrorOf(frame, estimate, *job.arguments.targetError, refinement.rounds);
  // Where as many vectors as may answer a point do, more of them only come nearer.
  constexpr double kGain = 0.98;
  constexpr int kMostIdleRounds = 3;
  const bool isIdle = refinement.error && found.error > kGain * *refinement.error;
  refinement.idleRounds = isIdle ? refinement.idleRounds + 1 : 0;
  refinement.error = found.error;
  if (refinement.idleRounds < kMostIdleRounds && work.renderer->askMore(found.pixels)) {
    ++refinement.rounds;
  } else {
    refinement.isOver = true;
  }
}

Expected<void> keepForLater(const Job& job, const Work& work) {
  Checkpoint checkpoint = work.renderer->checkpoint();
  // `vectors` runs its passes again: stopped before it has caught up, it still has all that it began with.
  checkpoint.passes = std::max(checkpoint.passes, work.passesBefore);
  return writeCheckpoint(job.checkpointPath, checkpoint, work.checkpointIdentity);
}

/// Passes until all is done, or a signal, the time limit or --passes ends it. At least one is whole when the
/// time limit does.
void runPasses(const Job& job, Work& work, Clock::time_point start, const StopFlag& stop) {
  const FlushDenormals flush;
  Renderer& renderer = *work.renderer;
  ProgressDisplay display(progressStyle(job.arguments.quiet));
  display.update(renderer, lookAtNoise(job, work));
  // What a checkpoint brought may be enough; but where the picture is gone it takes a pass to make it again.
  std::error_code ignored;
  if (work.isComplete(job) && !fs::exists(job.arguments.outputs.front(), ignored)) work.noise.reset();
  std::optional<TimeLimit> limit;
  // A reference takes hours, which are not to be lost with the machine.
  constexpr std::chrono::seconds kBetweenCheckpoints(60);
  auto kept = Clock::now();
  while (!work.isComplete(job) && renderer.statistics().passes < job.arguments.passes.value_or(INT_MAX)) {
    if (!renderer.runPass(stop)) break;
    lookAtError(job, work, stop);
    if (stop) break;
    display.update(renderer, lookAtNoise(job, work));
    if (job.arguments.targetNoise && Clock::now() - kept >= kBetweenCheckpoints) {
      if (auto written = keepForLater(job, work); !written) printWarning(written.error().message());
      kept = Clock::now();
    }
    if (!limit) limitTime(limit, start, job.arguments.timeLimitSeconds);
  }
}

/// Writes what there is and remembers the first error: after hours of rendering a full disk for one file is
/// no reason to lose the others.
class Writer {
 public:
  void write(const fs::path& path, const Expected<void>& done) {
    if (done) {
      written_.push_back(path.string());
    } else if (error_) {
      printError(done.error().message());
    } else {
      error_ = done.error();
    }
  }
  bool failed() const { return error_.has_value(); }
  const std::optional<Error>& error() const { return error_; }
  std::string written() const { return fmt::format("{}", fmt::join(written_, ", ")); }

 private:
  std::vector<std::string> written_;
  std::optional<Error> error_;
};

PictureIdentity identityOf(const Job& job, const Renderer& renderer, bool isComplete) {
  PictureIdentity identity =
      identityOfView(job.arguments, job.description, *job.scene, job.view, job.parameters);
  // Without the target, which the command that makes the picture again does not know.
  if (job.arguments.targetNoise) identity.parameters.picture.pathSamples = renderer.progress().paths;
  identity.cache = job.arguments.cache;
  identity.lockedCache = job.arguments.lockCache;
  identity.targetError = job.arguments.targetError;
  identity.explain = job.arguments.explain;
  identity.tellsError = job.arguments.tellsError;
  identity.passes = renderer.statistics().passes;
  identity.complete = isComplete;
  identity.look = job.arguments.look;
  identity.reference = job.arguments.reference;
  return identity;
}

/// Where the error of the complete picture comes from, where that was asked for. A stop ends it.
void explainError(const Job& job, Work& work, const RenderFrame& frame, const StopFlag& stop) {
  if (!job.arguments.explain || stop) return;
  if (const std::string obstacle = errorSourceObstacle(frame); !obstacle.empty())
    return note(job, "where the error comes from is not told: " + obstacle);
  CommandLoad display(stop, job.arguments.quiet);
  const LoadStage stage(display.watch(), "finding out where the error comes from");
  work.sources = errorSources(frame, *job.arguments.explain, *work.context.pool, stop,
                              [&](double part) { display.watch().tellFraction(part); });
  if (!work.sources) note(job, "stopped before it was known where the error comes from");
}

void writePictures(const Job& job, const Work& work, const RenderFrame& frame, Writer& writer) {
  const PictureIdentity identity = identityOf(job, *work.renderer, work.isComplete(job));
  std::optional<LayeredImage> layers, screen;
  for (const fs::path& output : job.arguments.outputs) {
    const std::string ending = fileEnding(output);
    const bool isOfSources = isForScreens(ending) && job.arguments.look.view == PictureView::ErrorSources;
    if (isOfSources && !work.sources) continue;
    std::optional<LayeredImage>& image = isForScreens(ending) ? screen : layers;
    if (!image && isForScreens(ending)) {
      image = screenPicture(frame, job.arguments.look,
                            {.base = job.reference, .errorSources = work.sources ? &*work.sources : nullptr});
    } else if (!image) {
      image = frame.film->toLayers(*job.scene);
      if (work.sources) addErrorLayers(*work.sources, *image);
    }
    image->metadata = pictureMetadata(identity, ending);
    writer.write(output, writeImage(output, *image));
  }
}

/// As a cache, or as a point cloud for other programs.
Expected<void> saveCache(const Job& job, const fs::path& path, const Snapshot& snapshot) {
  if (!isPlyPath(path))
    return writeCache(path, snapshot, vectorsIdentity(job.description, job.lights.indirect, job.parameters));
  return writePly(path, snapshot, *job.scene, job.parameters.vectors,
                  {fmt::format("Lightvane {}", versionText()), job.arguments.scene.string()});
}

/// Whether a stopped rendering has done anything that --resume could go on from.
bool canGoOn(const Work& work) {
  if (std::max(work.renderer->statistics().passes, work.passesBefore) > 0) return true;
  const std::shared_ptr<const Snapshot> gathered = work.renderer->gathered();
  return gathered && gathered->indirect.size() + gathered->directCount() > 0;
}

/// Leaves behind what --resume goes on from, or removes it where nothing is left to do.
void settleCheckpoint(const Job& job, const Work& work, Writer& writer) {
  if (hasPrivateCache(job.parameters)) return;
  if (!work.isComplete(job) && !canGoOn(work)) return;
  const bool isUnchanged = work.renderer->statistics().passes == work.passesBefore;
  if (job.arguments.targetNoise && isUnchanged) return;
  if (!work.isComplete(job) || writer.failed() || job.arguments.targetNoise) {
    writer.write(job.checkpointPath, keepForLater(job, work));
  } else if (job.arguments.resume) {
    std::error_code ignored;
    fs::remove(job.checkpointPath, ignored);
  }
}

void writeStatistics(const Job& job, const Work& work, Clock::time_point start, Writer& writer) {
  if (!job.arguments.stats) return;
  RunFacts facts;
  facts.wallSeconds = std::chrono::duration<double>(Clock::now() - start).count();
  measureProcess(facts);
  facts.threads = work.context.pool->threadCount();
  facts.stoppedEarly = !work.isComplete(job);
  facts.sceneHash = job.scene->hash;
  facts.estimatedError = work.refinement.error;
  facts.samplingError = work.refinement.samplingError;
  facts.errorSources = work.sources ? &*work.sources : nullptr;
  writer.write(*job.arguments.stats,
               writeFileAtomically(*job.arguments.stats,
                                   statisticsJson(work.renderer->statistics(), facts, job.parameters)));
}

std::string explanationText(const ErrorSources& sources) {
  return fmt::format(
      "{}\n{} pixels computed in full, {} samples each. Of each source: the root of the mean squared "
      "difference, relative to\nthe picture around each pixel, and the mean difference. Squares need not add "
      "up: sources may cancel each other.\n",
      alignedTable(errorSourceTable(sources)), sources.pixels.size(), sources.samples);
}

std::string passesText(int passes) { return fmt::format("{} pass{}", passes, passes == 1 ? "" : "es"); }

void summarise(const Job& job, const Work& work, bool hasPicture, Clock::time_point start,
               const Writer& writer) {
  const Renderer& renderer = *work.renderer;
  const RenderStatistics& statistics = renderer.statistics();
  if (statistics.faults.count > 0) {
    printWarning(fmt::format("{} samples were not finite or negative and are left out of the picture",
                             statistics.faults.count));
  }
  if (statistics.unanswered > 0 && job.arguments.lockCache) {
    printWarning(fmt::format("{} points have no vector in the locked cache and lack indirect light",
                             statistics.unanswered));
  }
  std::string summary =
      fmt::format("{}, {}", durationText(std::chrono::duration<double>(Clock::now() - start).count()),
                  passesText(statistics.passes));
  if (renderer.snapshot() != nullptr) {
    summary += fmt::format(", {} ILVs, {} DLVs", statistics.ilvRecords, statistics.dlvRecords);
  }
  summary += fmt::format(", {} rays", shortCount(static_cast<double>(statistics.rays.total())));
  if (work.refinement.error)
    summary += fmt::format(", indirect light off by about {} %", numberText(100.0 * *work.refinement.error));
  if (work.refinement.samplingError) {
    summary += fmt::format(", sampled direct light by about {} %",
                           numberText(100.0 * *work.refinement.samplingError));
  }
  if (work.noise) summary += fmt::format(", noise {} %", numberText(100.0 * *work.noise));
  note(job, summary + (writer.written().empty() ? "" : "; wrote " + writer.written()));
  const std::optional<double>& target = job.arguments.targetError;
  if (target && work.refinement.samplingError && *work.refinement.samplingError > *target) {
    note(job,
         fmt::format("direct light alone is above the target of {} %: larger light.samples brings it down",
                     numberText(100.0 * *target)));
  }
  if (work.refinement.isOver && target && !(work.refinement.error.value_or(0.0) <= *target)) {
    note(job,
         fmt::format("that is above the target of {} %: more vectors hardly help; larger gathers (ilv.rows, "
                     "ilv.columns) or the preset `fine` may",
                     numberText(100.0 * *target)));
  }
  if (work.isComplete(job) && !hasPicture)
    note(job, fmt::format("{} is as sure as asked already", job.arguments.outputs.front().string()));
  if (work.isComplete(job)) return;
  const std::string picture = job.arguments.outputs.front().string();
  if (job.arguments.targetNoise && canGoOn(work)) {
    note(job, fmt::format("stopped at {} paths a pixel: the same command goes on from there",
                          renderer.progress().paths));
    return;
  }
  note(job, hasPicture ? fmt::format("stopped: {} is the picture after {}, which --passes {} makes again",
                                     picture, passesText(statistics.passes), statistics.passes)
                       : fmt::format("stopped before the next pass was whole: {} is not written", picture));
  note(job, hasPrivateCache(job.parameters) ? "with the rules `printed` it can only begin anew"
            : canGoOn(work)                 ? "the same command with --resume goes on from here"
                                            : "nothing was done that --resume could go on from");
}

}  // namespace

Expected<ExitCode> renderPicture(const RenderArguments& arguments) {
  const Clock::time_point start = Clock::now();
  const StopFlag& stop = stopOnSignals();
  auto job = untilStopped([&] {
    CommandLoad loading(stop, arguments.quiet);
    return prepare(arguments, loading.watch());
  });
  if (!job) return endWithoutScene(job.error(), arguments.quiet);
  for (const std::string& warning : job->scene->warnings) printWarning(warning);
  for (const std::string& warning : contradictions(job->parameters)) printWarning(warning);

  auto work = begin(*job);
  if (!work) return tl::unexpected(work.error());
  Renderer& renderer = *work->renderer;
  runPasses(*job, *work, start, stop);
  const bool isHalf = stopSignalled() && !work->isComplete(*job);
  if (isHalf) {
    note(*job, "stopping, and writing what there is (the next Ctrl+C ends at once and writes nothing more)");
  }

  // A rendering that was stopped before it got beyond its last stop leaves that one's picture in place.
  const bool hasPicture = renderer.statistics().passes > work->passesBefore;
  Writer writer;
  if (hasPicture) {
    const RenderFrame frame = makeFrame(work->context, renderer);
    explainError(*job, *work, frame, stop);
    writePictures(*job, *work, frame, writer);
  }
  if (arguments.saveCache) {
    writer.write(*arguments.saveCache, saveCache(*job, *arguments.saveCache, *renderer.snapshot()));
  }
  settleCheckpoint(*job, *work, writer);
  writeStatistics(*job, *work, start, writer);
  summarise(*job, *work, hasPicture, start, writer);
  if (const auto& error = writer.error()) return tl::unexpected(*error);
  if (const auto& sources = work->sources; sources && arguments.tellsError) {
    if (auto printed = printAnswer(explanationText(*sources)); !printed)
      return tl::unexpected(printed.error());
  }
  const bool isStopped = isHalf || (stopSignalled() && arguments.explain && !work->sources);
  return isStopped ? ExitCode::Stopped : ExitCode::Success;
}

}  // namespace lightvane
