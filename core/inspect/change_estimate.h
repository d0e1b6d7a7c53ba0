#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/inspect/record_ref.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What other parameters or lights would cost in vectors.
struct ChangeEstimate {
  // Of the frame's vectors, exactly: those that would no longer be true.
  std::size_t staleIndirect = 0;
  std::size_t staleDirect = 0;
  // Vectors that would be computed, about.
  std::size_t newIndirect = 0;
  std::size_t newDirect = 0;

  bool operator==(const ChangeEstimate&) const = default;
};

/// What the frame's rendering would cost with `candidate` and `lights`, going on from the frame's vectors.
/// Nothing where nobody can tell: for coarse previews, for frames without vectors, and for the rules
/// `printed`.
///
/// Some hundred points of each pass are asked how many of the vectors that stay true would serve them, by the
/// renderer's own rules. Of the points that are short of vectors each gets one in its pass, and those of
/// later passes are expected to find as many of these as fit into the radius that vectors have around here.
/// 0 where the frame is complete and the candidate is what it was made with. Where it is not complete, what
/// is still to be computed counts too.
///
/// Of what is really computed it is half to twice as many, where that is more than the few that one point of
/// the sample stands for; up to 2.5 times as many where a threshold is tightened by a hair.
///
/// Deterministic. Any thread. Cost: 3 to 10 ms for 5,000 vectors; it does not grow with the picture.
std::optional<ChangeEstimate> estimateChange(const RenderFrame& frame, const Parameters& candidate,
                                             const LightMix& lights);

/// The same for whoever asks again and again, as a tooltip does in every frame: remembers its last answers.
/// One a thread.
class ChangeEstimator {
 public:
  /// `frame` must not be null.
  explicit ChangeEstimator(std::shared_ptr<const RenderFrame> frame) : frame_(std::move(frame)) {}

  const std::shared_ptr<const RenderFrame>& frame() const { return frame_; }
  std::optional<ChangeEstimate> estimate(const Parameters& candidate, const LightMix& lights);

 private:
  struct Answer {
    Parameters candidate;
    LightMix lights;
    std::optional<ChangeEstimate> estimate;
  };

  std::shared_ptr<const RenderFrame> frame_;
  std::vector<Answer> answers_;  ///< the newest last
};

}  // namespace lightvane
