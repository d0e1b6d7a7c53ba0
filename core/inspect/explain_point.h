#pragma once

#include <vector>

#include "core/inspect/frame_points.h"
#include "core/inspect/record_ref.h"
#include "core/vectors/answer.h"

namespace lightvane {

/// Where the light at a visible point came from.
enum class AnswerOrigin : std::uint8_t {
  NotYet,        ///< no pass has looked at the point
  Unanswered,    ///< no vector is valid and none may be computed
  Interpolated,  ///< the weighted mean of vectors
  Own,           ///< the vector that was computed at the point itself, alone
  Computed       ///< computed here, and not kept as a vector
};
/// "not looked at yet", "interpolated", ...
const char* answerOriginName(AnswerOrigin origin);

/// What a visible point got from the ILVs of one key, in normalised units.
struct IndirectSource {
  SurfaceKey key = kLambertKey;
  AnswerOrigin origin = AnswerOrigin::NotYet;
  Rgb radiance{0.0f};          ///< towards the viewer, as the picture has it
  std::uint32_t own = kNone;   ///< number of the vector that was computed at the point
  IndirectExplanation answer;  ///< of the vectors that were known when the point was answered
  /// Whether the explanation gives the picture's value to the bit. Not so where a visibility ray grazes an
  /// edge: alone, Embree may see it otherwise than in the packet that the renderer traced.
  bool isExact = false;

  /// Whether the ILV of that number has a share in the radiance.
  bool uses(std::uint32_t number) const;
};

/// What a visible point got from lights: one light, or together, where they are many, all that no vectors
/// give it.
struct DirectSource {
  std::vector<std::uint32_t> lights;
  AnswerOrigin origin = AnswerOrigin::NotYet;
  Rgb radiance{0.0f};  ///< of the lights before `factor`
  Rgb factor{1.0f};    ///< by which the picture multiplies it
  std::uint32_t own = kNone;
  DirectExplanation answer;  ///< of lights with vectors
  bool isExact = false;

  /// Whether the DLV of that number has a share in the radiance.
  bool uses(std::uint32_t number) const;
};

/// Whether something hides a vector from a point that is `distance` away, by the ray that ilv.visibility
/// sends.
bool isHiddenFrom(const RenderFrame& frame, const VisiblePoint& point, const IlvCandidate& vector,
                  float distance);

/// Finds out how the visible points of a frame got their light: by asking the vectors again, by the very
/// steps of the renderer, until the picture's value comes out to the bit. A point is not asked again once it
/// has been served, so that a frame in the making shows answers of several generations of the cache; each is
/// found by the publication after which it was given.
///
/// Refers to the frame, which must have points. One a thread. Cost: some 10 us a point and key.
class PointExplainer {
 public:
  explicit PointExplainer(const RenderFrame& frame);

  const VisiblePoint& point(PointRef ref) const { return frame_.points->tiles[ref.tile].points[ref.point]; }
  bool isLookedAt(PointRef ref) const { return frame_.answers[ref.tile]->looked[ref.point] != 0; }

  /// For each key of the point's BRDF. Candidates are those whose validity comes within `radius` of the
  /// point.
  std::vector<IndirectSource> indirect(PointRef ref, float radius);
  /// For each light, or group of lights.
  std::vector<DirectSource> direct(PointRef ref, float radius);
  DirectSource direct(PointRef ref, std::uint32_t vectorLight, float radius);

 private:
  IndirectSource indirectOfKey(PointRef ref, int k, SurfaceKey key, float radius);

  const RenderFrame& frame_;
  const Scene& scene_;
  Answerer answerer_;
  std::vector<std::size_t> indirectStarts_;  ///< of publications, the newest first
  std::vector<std::uint32_t> found_;
};

}  // namespace lightvane
