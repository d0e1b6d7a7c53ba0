#pragma once

#include <span>
#include <vector>

#include "core/image/image.h"

namespace lightvane {

enum class FilterBorder {
  Nearest,  ///< beyond the picture are its outermost pixels once more
  Nothing,  ///< beyond the picture is 0
};

/// Row y of `image` correlated with a vertical kernel of odd size; beyond the picture are its outermost
/// pixels. With filterRow it is a separable filter row by row, without a picture in between.
void filterColumns(const ImageFloat& image, int y, std::span<const float> kernel, std::span<float> out);

/// A row correlated with a horizontal kernel of odd size. `padded` is memory to work in.
template <class T>
void filterRow(std::span<const T> row, std::span<const T> kernel, FilterBorder border, std::span<T> out,
               std::vector<T>& padded);

}  // namespace lightvane
