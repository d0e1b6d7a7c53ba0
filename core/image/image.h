#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/check.h"
#include "core/base/color.h"

namespace lightvane {

/// A rectangle of pixels, row by row from the top left.
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, const T& value = T{})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return pixels_.size(); }
  bool empty() const { return pixels_.empty(); }

  T& at(int x, int y) { return pixels_[index(x, y)]; }
  const T& at(int x, int y) const { return pixels_[index(x, y)]; }
  T& operator[](std::size_t i) { return pixels_[i]; }
  const T& operator[](std::size_t i) const { return pixels_[i]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  T* data() { return pixels_.data(); }
  const T* data() const { return pixels_.data(); }
  auto begin() { return pixels_.begin(); }
  auto end() { return pixels_.end(); }
  auto begin() const { return pixels_.begin(); }
  auto end() const { return pixels_.end(); }

  bool operator==(const Image&) const = default;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

using ImageRgb = Image<Rgb>;
using ImageFloat = Image<float>;
using ImageUint = Image<std::uint32_t>;

/// A picture with everything that belongs to it: named channels of one size and the words that reproduce it.
/// Channel names are those of OpenEXR: "R", "direct.G", "Z", "cache.record_id".
struct LayeredImage {
  int width = 0;
  int height = 0;
  std::map<std::string, ImageFloat> channels;     ///< 32-bit float
  std::map<std::string, ImageUint> uintChannels;  ///< 32-bit unsigned integer
  /// UTF-8 without zero bytes; a key is 1 to 79 letters, digits and underscores.
  std::map<std::string, std::string> metadata;

  /// Adds R, G and B of `layer` ("" for the beauty picture) as `layer.R`, `layer.G`, `layer.B`.
  void setRgb(const std::string& layer, const ImageRgb& pixels);
  /// The three channels of `layer`; black where the picture does not have them.
  ImageRgb rgb(const std::string& layer = {}) const;
  bool hasRgb(const std::string& layer = {}) const;
};

}  // namespace lightvane
