#include "core/render/seed.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace lightvane {

const VisiblePoint* SeedPlace::choose(std::span<const VisiblePoint> points) const {
  const auto first =
      std::lower_bound(points.begin(), points.end(), pixel,
                       [](const VisiblePoint& p, std::uint32_t wanted) { return p.pixel < wanted; });
  const auto last =
      std::find_if(first, points.end(), [&](const VisiblePoint& p) { return p.pixel != pixel; });
  if (first == last) return nullptr;
  const auto chosen = static_cast<std::ptrdiff_t>(which * static_cast<float>(last - first));
  return &*(first + std::min(last - first - 1, chosen));
}

std::vector<SeedPlace> seedPlaces(const PictureRegion& region, int count, std::uint64_t seed,
                                  std::uint32_t stream) {
  std::vector<SeedPlace> places;
  if (count <= 0) return places;
  const double aspect = static_cast<double>(region.width) / region.height;
  const int columns = std::max(1, static_cast<int>(std::lround(std::sqrt(count * aspect))));
  const int rows = (count + columns - 1) / columns;
  const RandomKey key = randomKey(seed).with(stream);
  for (int i = 0; i < count; ++i) {
    const auto sample = static_cast<std::uint32_t>(i);
    const int cellX = i % columns;
    const int cellY = i / columns;
    const double x = (cellX + static_cast<double>(uniform(key, sample, 0))) / columns * region.width;
    const double y = (cellY + static_cast<double>(uniform(key, sample, 1))) / rows * region.height;
    const int column = std::min(region.width - 1, static_cast<int>(x));
    const int row = std::min(region.height - 1, static_cast<int>(y));
    places.push_back({static_cast<std::uint32_t>(row * region.width + column), uniform(key, sample, 2)});
  }
  return places;
}

}  // namespace lightvane
