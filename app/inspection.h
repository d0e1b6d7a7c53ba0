#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/background_job.h"
#include "app/panels/workspace.h"
#include "core/inspect/full_computation.h"
#include "core/inspect/overlay.h"
#include "core/inspect/pixel_report.h"
#include "core/inspect/record_report.h"

namespace lightvane {

/// What is known of the selection, of one frame: reports that are made at once, and full computations that
/// run in the background. On one thread.
class Inspection {
 public:
  /// Samples of a full computation: its standard error is below what an eye sees.
  static constexpr int kSamples = 16'384;

  explicit Inspection(std::function<void()> done) : job_(std::move(done)) {}

  /// Brings the reports up to date. Coarse frames have none. `rests`: no other frame is to come by itself.
  void update(const std::shared_ptr<const RenderFrame>& frame, const Selection& selection, bool rests);
  /// Computes the selected pixel in full. Where another frame comes before that is done, it is of no use with
  /// that one: it begins anew as soon as the rendering rests.
  void computeHere();

  const PixelReport* pixel() const { return pixel_ ? &*pixel_ : nullptr; }
  const RecordReport* record() const { return record_ ? &*record_ : nullptr; }
  const FullComputation* full() const { return full_ ? &*full_ : nullptr; }
  bool isComputing() const { return job_.isBusy(); }
  /// A computation was asked for and begins when the rendering rests.
  bool isWaiting() const { return waits_; }
  /// The pixels that the reported vector served, as marks for the overlay; null where none is reported on.
  const std::shared_ptr<const OverlayBatch>& served() const { return served_; }

 private:
  std::shared_ptr<const RenderFrame> frame_;
  std::optional<PixelRef> pixelRef_;
  RecordRef recordRef_;
  std::optional<PixelReport> pixel_;
  std::optional<RecordReport> record_;
  std::optional<FullComputation> full_;
  std::shared_ptr<const OverlayBatch> served_;
  BackgroundJob<FullComputation> job_;
  bool waits_ = false;
};

}  // namespace lightvane
