#include "core/trace/mirrored_lights.h"

#include <algorithm>
#include <numeric>

namespace lightvane {
namespace {

// Of lengths in a scene that fits a box of about 1: some times the rounding of a plane through three of its
// points.
constexpr float kMargin = 0x1p-18f;

/// 1 where all of the ball is in front of the plane through a, b, c, from where they run counter-clockwise;
/// -1 where it is behind; 0 where it is neither.
int sideOf(const Vec3& centre, float radius, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = glm::cross(b - a, c - a);
  const float height = glm::dot(centre - a, normal);
  const float reach = (radius + kMargin) * glm::length(normal);
  return height > reach ? 1 : height < -reach ? -1 : 0;
}

Vec3 centreOf(const std::vector<Vec3>& outline) {
  return std::accumulate(outline.begin(), outline.end(), Vec3(0.0f)) / static_cast<float>(outline.size());
}

/// A side of `one` has all corners of `other` beyond it, from wherever in the ball they are seen.
bool partedBySide(const std::vector<Vec3>& one, const std::vector<Vec3>& other, const Vec3& centre,
                  float radius) {
  const Vec3 inside = centreOf(one);
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Vec3& a = one[i];
    const Vec3& b = one[i + 1 < one.size() ? i + 1 : 0];
    const int inner = sideOf(centre, radius, a, b, inside);
    if (inner != 0 && std::all_of(other.begin(), other.end(), [&](const Vec3& corner) {
          return sideOf(centre, radius, a, b, corner) == -inner;
        })) {
      return true;
    }
  }
  return false;
}

}  // namespace

void mirroredLightsNear(const Scene& scene, const Vec3& centre, float radius,
                        std::vector<std::uint32_t>& near) {
  near.clear();
  for (std::uint32_t m = 0; m < scene.mirroredLights.size(); ++m) {
    const MirroredLight& mirrored = scene.mirroredLights[m];
    const PlanarMirror& mirror = scene.planarMirrors[mirrored.mirror];
    const std::vector<Vec3>& image = std::get<AreaLight>(mirrored.image).polygon;
    const float height = glm::dot(mirror.normal, centre - mirror.outline.front());
    if ((mirrored.frontSide ? height : -height) < -(radius + kMargin)) continue;
    if (!image.empty() && (partedBySide(mirror.outline, image, centre, radius) ||
                           partedBySide(image, mirror.outline, centre, radius))) {
      continue;
    }
    near.push_back(m);
  }
}

bool imageMayMeetMirror(const Scene& scene, const MirroredLight& mirrored, const Vec3& position) {
  const std::vector<Vec3>& image = std::get<AreaLight>(mirrored.image).polygon;
  const std::vector<Vec3>& outline = scene.planarMirrors[mirrored.mirror].outline;
  if (image.empty()) return true;
  const Vec3 toInside = centreOf(image) - position;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const Vec3 next = image[i + 1 < image.size() ? i + 1 : 0];
    Vec3 inwards = glm::cross(next - position, image[i] - position);
    if (glm::dot(toInside, inwards) < 0.0f) inwards = -inwards;
    const float margin = kMargin * (std::abs(inwards.x) + std::abs(inwards.y) + std::abs(inwards.z));
    if (std::all_of(outline.begin(), outline.end(),
                    [&](const Vec3& corner) { return glm::dot(corner - position, inwards) < -margin; })) {
      return false;
    }
  }
  return true;
}

}  // namespace lightvane
