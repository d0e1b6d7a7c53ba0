#include "app/camera_motion.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace lightvane {
namespace {

// A view straight up or down has no horizon to keep level.
constexpr float kLeastAngleToPole = 0.5f * kPi / 180.0f;

Vec3 rotated(const Vec3& v, const Vec3& axis, float angle) { return glm::angleAxis(angle, axis) * v; }

// Scenes are about 1 large: nearer than this single precision shows.
constexpr float kLeastDistance = 1e-4f;

/// The pitch that is left until a pole is reached.
float allowedPitch(const Camera& camera, const Vec3& up, float pitch) {
  const float fromPole = std::acos(std::clamp(glm::dot(camera.forward, up), -1.0f, 1.0f));
  const float most = std::max(0.0f, fromPole - kLeastAngleToPole);
  const float least = std::min(0.0f, fromPole - kPi + kLeastAngleToPole);
  return std::clamp(pitch, least, most);
}

/// The camera with its axes about `forward`, orthonormal again after many small turns, and level.
void levelAxes(Camera& camera, const Vec3& up) {
  camera.forward = glm::normalize(camera.forward);
  const Vec3 right = glm::cross(camera.forward, up);
  if (glm::dot(right, right) < 1e-8f) {  // along the pole: as level as it was
    camera.right = glm::normalize(camera.right - camera.forward * glm::dot(camera.right, camera.forward));
  } else {
    camera.right = glm::normalize(right);
  }
  camera.up = glm::cross(camera.right, camera.forward);
}

}  // namespace

Vec3 worldUp(const Camera& camera) {
  const Vec3 size = glm::abs(camera.up);
  const int axis = size.y >= size.x && size.y >= size.z ? 1 : size.z >= size.x ? 2 : 0;
  Vec3 up(0.0f);
  up[axis] = camera.up[axis] < 0.0f ? -1.0f : 1.0f;
  return up;
}

Camera turned(const Camera& camera, const Vec3& up, float yaw, float pitch) {
  Camera next = camera;
  pitch = allowedPitch(camera, up, pitch);
  next.forward = rotated(rotated(camera.forward, camera.right, pitch), up, yaw);
  next.right = rotated(camera.right, up, yaw);
  levelAxes(next, up);
  return next;
}

Camera orbited(const Camera& camera, const Vec3& pivot, const Vec3& up, float yaw, float pitch) {
  Camera next = turned(camera, up, yaw, pitch);
  // The pivot keeps its place among the camera's axes.
  const Vec3 seen = pivot - camera.position;
  const Vec3 local(glm::dot(seen, camera.right), glm::dot(seen, camera.up), glm::dot(seen, camera.forward));
  next.position = pivot - (local.x * next.right + local.y * next.up + local.z * next.forward);
  return next;
}

Camera panned(const Camera& camera, const Vec2& drag, float depth) {
  Camera next = camera;
  const float scale = camera.pixelWidth(depth);
  next.position += scale * (drag.y * camera.up - drag.x * camera.right);
  return next;
}

Camera dollied(const Camera& camera, const Vec3& pivot, float factor) {
  Camera next = camera;
  const Vec3 away = camera.position - pivot;
  if (camera.isOrthographic()) {
    // Nearer is larger here. The pivot keeps its place on the picture, and the camera its distance.
    next.halfHeight = std::max(kLeastDistance, camera.halfHeight * factor);
    const Vec3 inPlane = away - camera.forward * glm::dot(away, camera.forward);
    next.position += inPlane * (next.halfHeight / camera.halfHeight - 1.0f);
    return next;
  }
  const float distance = glm::length(away);
  if (!(distance > kLeastDistance)) return factor < 1.0f ? camera : flown(camera, {0, 0, -kLeastDistance});
  next.position = pivot + away * (std::max(kLeastDistance, distance * factor) / distance);
  return next;
}

Camera flown(const Camera& camera, const Vec3& step) {
  Camera next = camera;
  next.position += step.x * camera.right + step.y * camera.up;
  if (camera.isOrthographic()) {
    // As much larger as things become in an eye that sees as high as it is far away.
    next.halfHeight = std::max(kLeastDistance, camera.halfHeight - 0.5f * step.z);
  } else {
    next.position += step.z * camera.forward;
  }
  return next;
}

Camera framing(const Camera& camera, const Vec3& centre, float radius) {
  Camera next = camera;
  const float narrow = std::min(1.0f, static_cast<float>(camera.width) / static_cast<float>(camera.height));
  if (camera.isOrthographic()) {
    next.halfHeight = radius / narrow;
    // From as far away as it was, so that what stood before the ball still does; farther where that is too
    // near.
    const float depth = std::max(glm::dot(centre - camera.position, camera.forward), 2.0f * radius);
    next.position = centre - camera.forward * depth;
    return next;
  }
  const float halfAngle = std::atan(camera.tanHalfFovY * narrow);
  const float distance = radius / std::sin(halfAngle);
  next.position = centre - camera.forward * distance;
  if (camera.hasLens()) next.focusDistance = distance;
  return next;
}

}  // namespace lightvane
