#pragma once

#include "core/base/tasks.h"
#include "core/render/film.h"

namespace lightvane {

/// Not 0 where a pixel of the beauty picture differs from one of its eight neighbours by more than
/// `contrast`: the largest difference of a channel, as a part of the largest channel of both.
Image<std::uint8_t> pixelsThatDiffer(const Film& film, double contrast, TaskPool& pool);

}  // namespace lightvane
