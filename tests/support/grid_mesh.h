#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace lightvane::test {

/// The triangles of a grid of cells whose corners are numbered row by row, `columns` + 1 in a row: two for
/// each cell, which run from a corner along its row first.
inline std::vector<glm::uvec3> gridTriangles(std::uint32_t rows, std::uint32_t columns) {
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
      triangles.emplace_back(a, a + 1, b);
      triangles.emplace_back(a + 1, b + 1, b);
    }
  }
  return triangles;
}

}  // namespace lightvane::test
