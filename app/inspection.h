#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/background_job.h"
#include "app/panels/workspace.h"
#include "core/inspect/full_computation.h"
#include "core/inspect/overlay.h"
#include "core/inspect/pixel_report.h"
#include "core/inspect/record_report.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What the full computation of a pixel is a function of: how it is lit, and what the picture answers its
/// points with.
struct FullSubject {
  std::shared_ptr<const Scene> scene;
  Camera camera;
  Parameters parameters;
  LightMix lights;
  bool hasPoints = false;            ///< the method keeps visible points
  std::vector<std::uint8_t> looked;  ///< TileAnswers::looked, of each of the pixel's points
  std::vector<Rgb> answers;          ///< of these points: direct light by slots, mirrored and indirect light
};

/// Any frame and pixel. Any thread.
FullSubject fullSubject(const RenderFrame& frame, const PixelRef& pixel);
/// Whether the pixel is lit the same, whatever the picture answers. Parameters count where what is
/// computed follows from them, as stillTrue says: not those that decide where vectors are, as their answers
/// are compared.
bool isLitAlike(const FullSubject& a, const FullSubject& b);
/// Whether a full computation of one is true of the other.
bool isAlike(const FullSubject& a, const FullSubject& b);

/// What is known of the selection, of one frame: reports that are made at once, and full computations that
/// run in the background. On one thread.
class Inspection {
 public:
  /// Samples of a full computation: its standard error is below what an eye sees.
  static constexpr int kSamples = 16'384;

  explicit Inspection(std::function<void()> done) : job_(std::move(done)) {}

  /// Brings the reports up to date. Coarse frames have none. `rests`: no other frame is to come by itself.
  void update(const std::shared_ptr<const RenderFrame>& frame, const Selection& selection, bool rests);
  /// Computes the selected pixel in full. Where that becomes untrue before it is done, as another frame shows
  /// the pixel otherwise, it begins anew as soon as the rendering rests.
  void computeHere();

  const PixelReport* pixel() const { return pixel_ ? &*pixel_ : nullptr; }
  const RecordReport* record() const { return record_ ? &*record_ : nullptr; }
  /// Of the frame that is shown. It stays as long as it is true, whichever frames come: paused or gone on
  /// with, they show the same.
  const FullComputation* full() const { return full_ && holds_ ? &*full_ : nullptr; }
  bool isComputing() const { return job_.isBusy(); }
  /// A computation was asked for and begins when the rendering rests.
  bool isWaiting() const { return waits_; }
  /// The pixels that the reported vector served, as marks for the overlay; null where none is reported on.
  const std::shared_ptr<const OverlayBatch>& served() const { return served_; }

 private:
  void compareFull(const RenderFrame* frame);

  std::shared_ptr<const RenderFrame> frame_;
  std::optional<PixelRef> pixelRef_;
  RecordRef recordRef_;
  std::optional<PixelReport> pixel_;
  std::optional<RecordReport> record_;
  std::optional<FullComputation> full_;
  std::optional<FullSubject> subject_;  ///< of `full_`, or of what the job computes
  bool holds_ = false;                  ///< the frame's pixel is alike
  std::shared_ptr<const OverlayBatch> served_;
  BackgroundJob<FullComputation> job_;
  bool waits_ = false;
};

}  // namespace lightvane
