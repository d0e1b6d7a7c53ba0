#include "core/measure/separable_filter.h"

#include <algorithm>

namespace lightvane {

void filterColumns(const ImageFloat& image, int y, std::span<const float> kernel, std::span<float> out) {
  std::ranges::fill(out, 0.0f);
  const int reach = static_cast<int>(kernel.size() / 2);
  const std::size_t width = out.size();
  for (int k = -reach; k <= reach; ++k) {
    const int row = std::clamp(y + k, 0, image.height() - 1);
    const int place = k + reach;
    const float weight = kernel[static_cast<std::size_t>(place)];
    const float* pixels = image.data() + image.index(0, row);
    for (std::size_t x = 0; x < width; ++x) out[x] += weight * pixels[x];
  }
}

template <class T>
void filterRow(std::span<const T> row, std::span<const T> kernel, FilterBorder border, std::span<T> out,
               std::vector<T>& padded) {
  const std::size_t reach = kernel.size() / 2;
  const std::size_t width = row.size();
  padded.assign(width + 2 * reach, T(0));
  std::ranges::copy(row, padded.begin() + static_cast<std::ptrdiff_t>(reach));
  if (border == FilterBorder::Nearest) {
    for (std::size_t k = 0; k < reach; ++k) {
      padded[k] = row.front();
      padded[reach + width + k] = row.back();
    }
  }
  std::ranges::fill(out, T(0));
  for (std::size_t k = 0; k < kernel.size(); ++k) {
    const T weight = kernel[k];
    const T* pixels = padded.data() + k;
    for (std::size_t x = 0; x < width; ++x) out[x] += weight * pixels[x];
  }
}

template void filterRow(std::span<const float>, std::span<const float>, FilterBorder, std::span<float>,
                        std::vector<float>&);
template void filterRow(std::span<const double>, std::span<const double>, FilterBorder, std::span<double>,
                        std::vector<double>&);

}  // namespace lightvane
