#pragma once

#include <compare>
#include <cstdint>

#include "core/scene/scene.h"
#include "core/vectors/snapshot.h"

namespace lightvane {

/// Names a light vector of a snapshot. Numbers stay for good, so that a name outlives its snapshot.
struct RecordRef {
  std::uint32_t light = kNone;   ///< of a DLV: index into Scene::lights; kNone for ILVs
  std::uint32_t number = kNone;  ///< in its RecordSet

  bool isIndirect() const { return light == kNone; }
  bool isNone() const { return number == kNone; }
  /// By light, then by number; ILVs last.
  auto operator<=>(const RecordRef&) const = default;
};

}  // namespace lightvane
