#pragma once

#include <gtest/gtest.h>

#include "core/vectors/gather.h"

namespace lightvane::vectors_test {

/// Directions at the middles of the cells; `cellOf(direction)` gives radiance and distance.
template <class CellOf>
Hemisphere centredHemisphere(int rows, int columns, const CellOf& cellOf) {
  Hemisphere h;
  h.rows = rows;
  h.columns = columns;
  for (int j = 0; j < rows; ++j) {
    for (int k = 0; k < columns; ++k) {
      const double cosine = (rows - j - 0.5) / rows;
      const double sine = std::sqrt(1.0 - cosine * cosine);
      const double phi = 2.0 * kPiD * (k + 0.5) / columns;
      const Vec3 direction(Vec3d(sine * std::cos(phi), sine * std::sin(phi), cosine));
      GatherCell cell = cellOf(direction);
      cell.direction = direction;
      h.cells.push_back(cell);
    }
  }
  return h;
}

}  // namespace lightvane::vectors_test
