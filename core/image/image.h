#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/color.h"

namespace lightvane {

/// Memory of zeros that the system clears when it is first touched: a large picture is there at once, and is
/// cleared by the threads that fill it.
template <class T>
struct ZeroedAllocator {
  static_assert(std::is_trivially_copyable_v<T>);
  using value_type = T;

  ZeroedAllocator() = default;
  template <class U>
  explicit ZeroedAllocator(const ZeroedAllocator<U>&) {}

  T* allocate(std::size_t count) {
    void* memory = std::calloc(count, sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  /// What is made without a value is zero already.
  void construct(T*) const {}
  template <class... Arguments>
  void construct(T* at, Arguments&&... arguments) const {
    ::new (static_cast<void*>(at)) T(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const ZeroedAllocator&) const = default;
};

/// A rectangle of pixels, row by row from the top left.
template <class T>
class Image {
 public:
  Image() = default;
  /// All zero.
  Image(int width, int height)
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}
  Image(int width, int height, const T& value)
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
  std::vector<T, ZeroedAllocator<T>> pixels_;
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
