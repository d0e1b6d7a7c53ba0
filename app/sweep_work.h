#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line.h"
#include "app/picture_metadata.h"
#include "app/sweep_files.h"
#include "app/thumbnails.h"
#include "app/view.h"
#include "core/base/load_watch.h"
#include "core/measure/comparison.h"
#include "core/measure/sweep.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// The metric that a report shows first, and maps show.
inline constexpr std::string_view kFirstMetric = "beauty.relative";

/// One choice of method and parameters: a point of the report, before it is rendered.
struct PlannedPoint {
  std::string method;
  SweepSettings settings;
  Parameters parameters;
  std::string label;         ///< as SweepPoint
  std::optional<int> seeds;  ///< so many of them at most
};

/// How far renderings are, of one scene or of several in turn.
struct SweepProgress {
  std::size_t passed = 0;  ///< renderings that were done or found done
};

/// The renderings of one scene, in one folder. In this order: load, points, begin, seed by seed. One
/// thread's.
class SweepWork {
 public:
  SweepWork(SweepArguments arguments, const StopFlag& stop, std::shared_ptr<TaskPool> pool);

  /// Reads and compiles the scene, and finds what is wrong with the view. With `isMost` the view's size is
  /// what the picture fits into, in the shape of the camera's own. Throws LoadStopped as `watch` says.
  Expected<void> load(LoadWatch& watch, bool isMost = false);
  /// Another work, of this loaded scene with one of its lights alone, or with none: loaded, and without
  /// points. Of `arguments` only the folder and the references may differ from this one's. Throws LoadStopped
  /// as `watch` says.
  Expected<std::unique_ptr<SweepWork>> litOnlyBy(std::optional<std::uint32_t> light, SweepArguments arguments,
                                                 LoadWatch& watch) const;
  const SceneDescription& description() const { return description_; }
  const Scene& scene() const { return tracers_.begin()->second->scene(); }
  const SweepArguments& arguments() const { return arguments_; }
  /// Whether direct light is kept in DLVs with these parameters.
  bool keepsDirectVectors(const Parameters& parameters) const;
  /// What the scene's `[render]` and the command line say together.
  Expected<Parameters> sharedParameters() const;
  /// These with a method and `settings`. Errors call one of the settings `where`, with its key and its value
  /// in place of {}.
  Expected<Parameters> parametersOf(const std::string& method, const SweepSettings& settings,
                                    const std::string& where) const;

  /// Renders a picture that others are to be held against, all layers of it. False where it was stopped: then
  /// there is no file.
  Expected<bool> writeReference(const Parameters& parameters, const std::filesystem::path& file);

  void add(PlannedPoint point) { points_.push_back(std::move(point)); }

  /// Reads the reference, or both halves of it, and what the folder has already. Throws LoadStopped as
  /// `watch` says.
  Expected<void> begin(LoadWatch& watch);

  std::size_t runCount() const;
  /// Renders what is not done yet of one seed of all points. `all` works go on together, this one among them:
  /// what is told on stderr counts their runs. False where it was stopped.
  Expected<bool> runSeed(int seed, std::span<const SweepWork* const> all, SweepProgress& progress);

  /// The finished runs of these points; others that the folder has are of other sweeps.
  Sweep collected() const;
  /// Everything but the list of runs, of a sweep as far as it is done.
  Expected<void> writeReport(const Sweep& sweep);

 private:
  using Clock = std::chrono::steady_clock;

  int seedsOf(const PlannedPoint& point) const {
    return std::min(arguments_.seeds, point.seeds.value_or(arguments_.seeds));
  }
  void tell(const std::string& text) const;
  static std::string labelOf(const PlannedPoint& point);
  /// Compiles what was read, and finds the view.
  Expected<void> prepare(LoadWatch& watch);
  Expected<RenderContext> contextOf(const Parameters& parameters);
  /// What names a picture of this work for whoever renders it again.
  PictureIdentity identityOf(const RenderContext& context) const;
  static std::string leftText(std::span<const SweepWork* const> all);
  Expected<std::shared_ptr<const Tracer>> tracerFor(const Parameters& parameters,
                                                    LoadWatch& watch = LoadWatch::none());
  Expected<void> readReference(LoadWatch& watch);
  /// What makes it a poor truth, as far as its file says.
  Expected<void> warnOfReference(const std::filesystem::path& file, const LayeredImage& image);
  std::string keyOf(const PlannedPoint& point, int seed) const;
  Expected<std::optional<KeptRun>> render(const PlannedPoint& point, int seed);
  Expected<void> writePictures(const PlannedPoint& point, const RenderFrame& frame,
                               const PictureComparison& comparison, KeptRun& kept) const;
  Expected<void> writeNowAndThen();

  SweepArguments arguments_;
  const StopFlag& stop_;
  std::shared_ptr<TaskPool> pool_;
  SceneDescription description_;
  std::vector<PlannedPoint> points_;
  std::map<EnergyRule, std::shared_ptr<const Tracer>> tracers_;
  View view_;
  LightMix lights_;
  /// Of litOnlyBy: by which the whole scene's picture is that of this one.
  std::vector<LightChange> putOut_;
  std::string sceneHash_;
  std::string keyOfAll_;  ///< what the keys of all runs begin with
  LayeredImage reference_;
  std::optional<double> referenceNoise_;
  std::map<std::string, double> layerNoise_;
  RunLog log_;
  bool isWarm_ = false;
  bool tellsWarnings_ = true;  ///< of the scene, once it is compiled
  std::size_t left_ = 0;       ///< runs that are not done
  std::size_t doneHere_ = 0;   ///< runs that were rendered by this process
  double secondsHere_ = 0.0;   ///< that they took with all that belongs to them
  Thumbnails thumbnails_;      ///< for the report
  Clock::time_point written_ = Clock::now();
};

}  // namespace lightvane
