#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include "core/inspect/record_ref.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What vectors of a frame would say without their noise: each computed again at its own point, with many
/// times the samples and other random numbers. How far it reaches stays as it is, so that it has the share in
/// the picture that it had.
///
/// There are two of each, computed independently of each other: what is left of their noise is not in the
/// mean of the product of two numbers of which one comes from each.
class ExactVectors {
 public:
  /// Refers to the frame, which must have vectors.
  explicit ExactVectors(const RenderFrame& frame) : frame_(frame) {}

  /// Computes those of these that are lacking. The same for any number of threads. Not to be called from
  /// within a body of the pool. Cost: some 10 ms for each ILV. Stopped, nothing of it is of use.
  void compute(std::span<const RecordRef> records, TaskPool& pool, const StopFlag& stop);

  /// An ILV or DLV that was computed; `half` is 0 or 1. One under which no surface is found is as the frame
  /// has it.
  const IndirectLightVector& indirect(std::uint32_t number, std::size_t half) const;
  const DirectLightVector& direct(const RecordRef& record, std::size_t half) const;
  /// What that light gives the DLV's point: known where DLVs are of the whole BRDF, which do not keep it.
  const Rgb& irradiance(const RecordRef& record, std::size_t half) const;

  const RayCounts& rays() const { return rays_; }

 private:
  struct Direct {
    DirectLightVector vector;
    Rgb irradiance{0.0f};
  };

  const RenderFrame& frame_;
  std::map<RecordRef, std::size_t> places_;  ///< in one of these, by kind
  std::vector<std::array<IndirectLightVector, 2>> indirect_;
  std::vector<std::array<Direct, 2>> direct_;
  RayCounts rays_;
};

}  // namespace lightvane
