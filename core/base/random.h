#pragma once

#include <bit>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "core/base/math.h"

namespace lightvane {

/// 32 well-mixed bits of `x` (the "lowbias32" hash of C. Wellons, 2018).
constexpr std::uint32_t mixBits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

/// The name of a stream of random numbers: what it belongs to (a record, a pixel), never a thread or a time.
/// Two 32-bit words, so that the generator below is cheap in SIMD code.
struct RandomKey {
  std::uint32_t high = 0;
  std::uint32_t low = 0;

  /// Any order, for sorted containers.
  auto operator<=>(const RandomKey&) const = default;

  /// The stream of something that belongs to this one: key.with(pixel).with(bounce).
  constexpr RandomKey with(std::uint32_t part) const {
    const std::uint32_t a = mixBits(high ^ (part + 0x9e3779b9U));
    const std::uint32_t b = mixBits(low + a + 0x85ebca6bU);
    return {a ^ std::rotl(b, 13), b};
  }
  RandomKey with(float part) const { return with(std::bit_cast<std::uint32_t>(part)); }
  RandomKey with(const Vec3& part) const { return with(part.x).with(part.y).with(part.z); }
  /// For what asks for a seed and not for a key.
  constexpr std::uint64_t asSeed() const { return (static_cast<std::uint64_t>(high) << 32) | low; }
};

/// For unordered containers. A key's bits are mixed already.
struct RandomKeyHash {
  std::size_t operator()(const RandomKey& key) const {
    return (static_cast<std::size_t>(key.high) << 32) ^ key.low;
  }
};

constexpr RandomKey randomKey(std::uint64_t seed) {
  return RandomKey{}.with(static_cast<std::uint32_t>(seed >> 32)).with(static_cast<std::uint32_t>(seed));
}

/// 32 random bits addressed by stream, sample and dimension.
constexpr std::uint32_t randomBits(RandomKey key, std::uint32_t sample, std::uint32_t dimension) {
  const std::uint32_t a = mixBits(key.low + sample * 0x9e3779b9U);
  return mixBits(a ^ (key.high + dimension * 0xc2b2ae35U));
}

/// The number in [0, 1) that 32 random bits stand for: the upper 24, so that it is exact in float and
/// never 1. By way of a signed integer, which vector instructions convert at once.
constexpr float unitFloat(std::uint32_t bits) {
  return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
}

/// A number in [0, 1) addressed by stream, sample and dimension.
constexpr float uniform(RandomKey key, std::uint32_t sample, std::uint32_t dimension) {
  return unitFloat(randomBits(key, sample, dimension));
}

inline Vec2 uniform2(RandomKey key, std::uint32_t sample, std::uint32_t dimension) {
  return {uniform(key, sample, dimension), uniform(key, sample, dimension + 1)};
}

/// Place `n` of the R2 sequence (Roberts 2018) in the unit square: any number of them is evenly spread.
inline Vec2d r2Place(std::uint32_t n) {
  const auto fraction = [](double v) { return v - std::floor(v); };
  return {fraction(0.5 + n * 0.7548776662466927), fraction(0.5 + n * 0.5698402909980532)};
}

/// The unit square in n strata of equal area, in columns and rows as square as n allows.
class Strata {
 public:
  explicit Strata(int n) : columns_(static_cast<int>(std::sqrt(static_cast<float>(n)))) {
    while (n % columns_ != 0) --columns_;
    rows_ = n / columns_;
  }
  /// All in one row: for what only the first coordinate chooses among.
  static Strata row(int n) { return {n, 1}; }

  /// The place in stratum `index` where `jitter` is.
  Vec2 sample(int index, const Vec2& jitter) const {
    // A division of integers would keep loops from being vectorised; this one is exact below 2^22.
    const int row = static_cast<int>((static_cast<float>(index) + 0.5f) / static_cast<float>(columns_));
    const int column = index - row * columns_;
    return {(static_cast<float>(column) + jitter.x) / static_cast<float>(columns_),
            (static_cast<float>(row) + jitter.y) / static_cast<float>(rows_)};
  }

 private:
  Strata(int columns, int rows) : columns_(columns), rows_(rows) {}

  int columns_;
  int rows_ = 1;
};

}  // namespace lightvane
