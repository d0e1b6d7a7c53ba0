#pragma once

#include <cstdint>

#include "core/render/render_frame.h"

namespace lightvane {

/// A visible point by its tile and its number there.
struct PointRef {
  std::uint32_t tile = kNone;
  std::uint32_t point = kNone;

  bool isNone() const { return point == kNone; }
};

/// The visible point that a vector was computed at, by Birth::pixel; none where the vector belongs to another
/// view: then that pixel has no point of the very same place.
PointRef pointOfRecord(const VisiblePoints& points, const VectorPoint& place, const Birth& birth);

/// Vectors of one kind are numbered in the order of their publication, and those that were published together
/// were computed without knowing each other. The number of the first that was published together with
/// `number`: all below it were known when it was asked for.
template <class Record>
std::size_t firstOfPublication(const RecordSet<Record>& records, std::size_t number) {
  const Birth& birth = records[number].birth;
  if (birth.order <= number) {
    const std::size_t first = number - birth.order;
    if (records[first].birth.order == 0 && records[first].birth.pass == birth.pass) return first;
  }
  // Not as a renderer published it: a cache that was put together otherwise. Passes are all there is.
  std::size_t first = number;
  while (first > 0 && records[first - 1].birth.pass == birth.pass) --first;
  return first;
}

}  // namespace lightvane
