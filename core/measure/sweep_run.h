#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/tasks.h"
#include "core/measure/comparison.h"
#include "core/measure/sweep.h"
#include "core/render/render_frame.h"

namespace lightvane {

// One run of a sweep: a picture is rendered to its end and held against the reference. The same for the
// command line and for the window.

/// The parameters that a point's settings make of others; see applySettings. Errors name the setting.
Expected<Parameters> withSettings(const Parameters& parameters, const SweepSettings& settings);

/// Every point's parameters, in their order; the first error.
Expected<std::vector<Parameters>> withEachSettings(const Parameters& parameters,
                                                   const std::vector<SweepSettings>& points);

/// How runs are measured. What it refers to must outlive it.
struct RunConditions {
  const LayeredImage& reference;
  std::string referenceName;
  ComparisonRequest comparison;
  /// A clock of what the run's threads work, in seconds: of the process where it does nothing else, of the
  /// calling thread where the run's pool has only that one.
  double (*cpuSeconds)() = nullptr;
  /// Called before each pass, and may wait; time that passes in it is wall time. May be empty.
  std::function<void()> beforePass = {};
};

struct MeasuredRun {
  SweepRun run;
  RenderFrame frame;
  PictureComparison comparison;  ///< metrics as they were asked for
};

/// Passes to the end; false where `stop` ended them.
bool renderToEnd(Renderer& renderer, const StopFlag& stop, const std::function<void()>& beforePass = {});

/// Renders what `context` says and measures it. Nothing where it was stopped; the errors are those of
/// compareImages. What the comparison costs is not in the run's times.
Expected<std::optional<MeasuredRun>> measureRun(const RenderContext& context, const RunConditions& conditions,
                                                const StopFlag& stop);

}  // namespace lightvane
