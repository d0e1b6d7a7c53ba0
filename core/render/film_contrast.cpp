#include "core/render/film_contrast.h"

#include <algorithm>

namespace lightvane {
namespace {

bool differ(const Rgb& a, const Rgb& b, float contrast) {
  const float most = std::max(maxComponent(a), maxComponent(b));
  return maxComponent(glm::abs(a - b)) > contrast * most;
}

}  // namespace

Image<std::uint8_t> pixelsThatDiffer(const Film& film, double contrast, TaskPool& pool) {
  Image<std::uint8_t> found(film.width, film.height);
  const auto limit = static_cast<float>(contrast);
  // Of each pixel its own row is written, those around it are read.
  pool.forEach(static_cast<std::size_t>(film.height), [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < film.width; ++x) {
      const Rgb own = film.beauty(film.direct.index(x, y));
      bool isFound = false;
      for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, film.height - 1); ++ny) {
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, film.width - 1); ++nx)
          isFound |= differ(own, film.beauty(film.direct.index(nx, ny)), limit);
      }
      found.at(x, y) = isFound ? 1 : 0;
    }
  });
  return found;
}

}  // namespace lightvane
