#include "core/scene/texture.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/noise.hpp>

namespace lightvane {
namespace {

/// 0 up to `low`, 1 from `high` on.
double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

Rgb mix(const Rgb& a, const Rgb& b, double share) {
  return {glm::mix(glm::dvec3(a), glm::dvec3(b), std::clamp(share, 0.0, 1.0))};
}

/// Noise of all scales, each half as long and half as strong as the one before: about -1 to 1. In double, so
/// that a scene far from the origin has it, too.
double turbulence(Vec3d place, int octaves) {
  double sum = 0.0;
  double strength = 0.5;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += strength * glm::perlin(place);
    // Not a power of two: lattices that fall together show.
    place = place * 2.03 + Vec3d(17.1, 5.7, 11.3);
    strength *= 0.5;
  }
  return sum;
}

/// `along` is the place along the axis, `across` and `deep` are across it.
Rgb colorOf(const WoodDescription& wood, double along, double across, double deep) {
  // A trunk bends slowly: the noise runs ten times as long along the axis as across it.
  const Vec3d slow = Vec3d(across, deep, 0.1 * along) / (4.0 * wood.ring);
  const double bend = wood.distortion * wood.ring * turbulence(slow, 3);
  const double radius = std::hypot(across, deep) + bend;
  const double ring = radius / wood.ring - std::floor(radius / wood.ring);
  // From early wood slowly to late wood, and back at once.
  const double late = smoothstep(0.15, 0.85, ring) * (1.0 - smoothstep(0.9, 1.0, ring));
  const Vec3d fibre = Vec3d(across, deep, 0.03 * along) / (0.08 * wood.ring);
  const double grain = wood.grain * glm::perlin(fibre);
  return mix(wood.light, wood.dark, late + grain);
}

Rgb colorOf(const MarbleDescription& marble, const Vec3d& place, double along) {
  const double phase =
      along / marble.spacing + marble.distortion * turbulence(place / (2.0 * marble.spacing), marble.octaves);
  // Sharp where the sine passes 1: veins are thin.
  const double wave = 0.5 + 0.5 * std::cos(2.0 * kPiD * phase);
  return mix(marble.base, marble.vein, std::pow(wave, marble.sharpness));
}

Rgb colorOf(const CheckerDescription& checker, const Vec2& uv) {
  const auto number = [](float x) { return static_cast<long long>(std::floor(static_cast<double>(x))); };
  return ((number(uv.x) + number(uv.y)) % 2 == 0) ? checker.even : checker.odd;
}

/// The pixel that stands for number `i` of `count` in a row.
int wrapped(TextureWrap wrap, long long i, int count) {
  if (wrap == TextureWrap::Clamp)
    return static_cast<int>(std::clamp(i, 0LL, static_cast<long long>(count) - 1));
  const long long rest = i % count;
  return static_cast<int>(rest < 0 ? rest + count : rest);
}

Rgb colorOf(const ImageTextureDescription& image, const Vec2& uv) {
  const ImageRgb& pixels = *image.pixels;
  // v rises from the picture's bottom.
  const double x = static_cast<double>(uv.x) * pixels.width();
  const double y = (1.0 - static_cast<double>(uv.y)) * pixels.height();
  const auto pixel = [&](double column, double row) {
    return pixels.at(wrapped(image.wrap, static_cast<long long>(column), pixels.width()),
                     wrapped(image.wrap, static_cast<long long>(row), pixels.height()));
  };
  if (image.filter == TextureFilter::Nearest) return pixel(std::floor(x), std::floor(y));
  const double left = std::floor(x - 0.5);
  const double top = std::floor(y - 0.5);
  const auto right = static_cast<float>(x - 0.5 - left);
  const auto below = static_cast<float>(y - 0.5 - top);
  return glm::mix(glm::mix(pixel(left, top), pixel(left + 1.0, top), right),
                  glm::mix(pixel(left, top + 1.0), pixel(left + 1.0, top + 1.0), right), below);
}

}  // namespace

Texture::Texture(const TextureDescription& description) : pattern_(description.pattern) {
  std::visit(
      [&](const auto& pattern) {
        if constexpr (requires { pattern.axis; }) {
          axis_ = pattern.axis / glm::length(pattern.axis);
          const Vec3d other = std::abs(axis_.x) < 0.9 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
          across_ = glm::normalize(other - glm::dot(other, axis_) * axis_);
          deep_ = glm::cross(axis_, across_);
        } else {
          usesUv_ = true;
        }
      },
      pattern_);
}

Vec2 Texture::withinReach(const Vec2& uv) {
  constexpr float kFarthest = 0x1p23f;
  return glm::clamp(uv, -kFarthest, kFarthest);
}

Rgb Texture::at(const Vec3d& place, const Vec2& anyUv) const {
  const Vec2 uv = withinReach(anyUv);
  if (const auto* image = std::get_if<ImageTextureDescription>(&pattern_)) return colorOf(*image, uv);
  if (const auto* checker = std::get_if<CheckerDescription>(&pattern_)) return colorOf(*checker, uv);
  const double along = glm::dot(place, axis_);
  if (const auto* wood = std::get_if<WoodDescription>(&pattern_))
    return colorOf(*wood, along, glm::dot(place, across_), glm::dot(place, deep_));
  return colorOf(std::get<MarbleDescription>(pattern_), place, along);
}

Rgb placedColor(const Texture& texture, const TextureUse& use, const Normalisation& normalisation,
                const Vec3& position, const Vec2& uv) {
  const auto scale = static_cast<float>(use.scale);
  return texture.at(normalisation.scenePoint(position) / use.scale, uv / scale);
}

Vec2 sphereUv(const Vec3& normal) {
  return {0.5f + std::atan2(normal.x, normal.z) / kTwoPi,
          0.5f + std::asin(std::clamp(normal.y, -1.0f, 1.0f)) * kInvPi};
}

Vec2 discUv(const Vec3& center, const Vec3& normal, float radius, const Vec3& position) {
  const Frame frame = Frame::aboutNormal(normal);
  const Vec3 fromCentre = (position - center) / (2.0f * radius);
  return {0.5f + glm::dot(fromCentre, frame.x), 0.5f + glm::dot(fromCentre, frame.y)};
}

}  // namespace lightvane
