#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math.h"

namespace lightvane {

/// A function of a local direction, tabulated over its cosine with the normal and, in several rows, over its
/// azimuth; linear in between. For functions that turn quickly at grazing angles and are symmetric about the
/// x and y axes.
///
/// Cosines have kCellsPerOctave cells for each factor of two down to 2^-kOctaves and one cell below, so that
/// finding a cell takes the bits of the float and no transcendental function. Rows are even in |y| / sqrt(x^2
/// + y^2).
template <class T>
class DirectionTable {
 public:
  static constexpr int kOctaves = 20;
  static constexpr int kCellsPerOctave = 4;
  static constexpr int kCosines = kOctaves * kCellsPerOctave + 2;  ///< nodes: 0, then 2^-20 to 1
  static constexpr int kAnisotropicRows = 9;

  DirectionTable() = default;
  explicit DirectionTable(int rows) : rows_(rows), values_(static_cast<std::size_t>(rows * kCosines)) {}

  bool empty() const { return rows_ == 0; }
  int rows() const { return rows_; }

  static float nodeCosine(int cosine) {
    if (cosine == 0) return 0.0f;
    return std::bit_cast<float>(kFirstBits + (static_cast<std::uint32_t>(cosine - 1) << kCellShift));
  }
  /// The direction that node (row, cosine) stands for.
  static Vec3 nodeDirection(int rows, int row, int cosine) {
    const float z = nodeCosine(cosine);
    const float sine = std::sqrt((1.0f - z) * (1.0f + z));
    const float y = rows > 1 ? static_cast<float>(row) / static_cast<float>(rows - 1) : 0.0f;
    return {sine * std::sqrt((1.0f - y) * (1.0f + y)), sine * y, z};
  }

  T& node(int row, int cosine) { return values_[index(row, cosine)]; }
  const T& node(int row, int cosine) const { return values_[index(row, cosine)]; }

  /// The interpolated value; `direction` unit, z in [0, 1] up to rounding. Not for empty tables.
  T at(const Vec3& direction) const {
    int cosine = 0;
    float alongCosine = 0.0f;
    if (direction.z < kFirstCosine) {
      alongCosine = std::max(direction.z, 0.0f) / kFirstCosine;
    } else {
      const std::uint32_t offset =
          std::bit_cast<std::uint32_t>(std::min(direction.z, kLastCosine)) - kFirstBits;
      cosine = 1 + static_cast<int>(offset >> kCellShift);
      alongCosine = static_cast<float>(offset & kCellMask) / static_cast<float>(kCellMask + 1);
    }
    if (rows_ == 1) return alongRow(0, cosine, alongCosine);
    const float horizontal = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    const float y = horizontal > 0.0f ? std::min(std::abs(direction.y) / horizontal, 1.0f) : 0.0f;
    const float scaled = y * static_cast<float>(rows_ - 1);
    const int row = std::min(static_cast<int>(scaled), rows_ - 2);
    const float alongAzimuth = scaled - static_cast<float>(row);
    return alongRow(row, cosine, alongCosine) * (1.0f - alongAzimuth) +
           alongRow(row + 1, cosine, alongCosine) * alongAzimuth;
  }

 private:
  static constexpr float kFirstCosine = 0x1p-20f;
  static constexpr std::uint32_t kFirstBits = std::bit_cast<std::uint32_t>(kFirstCosine);
  static constexpr int kCellShift = 23 - std::bit_width(static_cast<unsigned>(kCellsPerOctave - 1));
  static constexpr std::uint32_t kCellMask = (1U << kCellShift) - 1U;
  static constexpr float kLastCosine = 0x1.fffffep-1f;  ///< the largest below 1: still in the last cell
  static_assert(kFirstCosine * static_cast<float>(1U << kOctaves) == 1.0f);
  static_assert(std::has_single_bit(static_cast<unsigned>(kCellsPerOctave)));

  static std::size_t index(int row, int cosine) {
    return static_cast<std::size_t>(row) * kCosines + static_cast<std::size_t>(cosine);
  }
  T alongRow(int row, int cosine, float fraction) const {
    const T* cell = &values_[index(row, cosine)];
    return cell[0] * (1.0f - fraction) + cell[1] * fraction;
  }

  int rows_ = 0;
  std::vector<T> values_;
};

}  // namespace lightvane
