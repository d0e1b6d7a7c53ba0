#include "core/scene/gltf_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace lightvane {
namespace {

/// A picture's height; its width is by the aspect ratio, up to kMostAspect either way.
constexpr int kGltfPictureHeight = 512;
constexpr double kMostAspect = 16.0;

/// The direction of an axis of the node in the world; no length where it has none.
Vec3d worldAxis(const GltfPlacedNode& node, int axis) {
  const Vec3d direction(node.toWorld[axis]);
  const double length = glm::length(direction);
  return length > 0.0 && std::isfinite(length) ? direction / length : Vec3d(0.0);
}

int widthOf(double aspect) {
  if (!(aspect > 0.0)) aspect = 1.0;
  return static_cast<int>(
      std::lround(kGltfPictureHeight * std::clamp(aspect, 1.0 / kMostAspect, kMostAspect)));
}

/// Fills what is of the camera itself; what is wrong with it, or nothing.
std::string fillProjection(const tinygltf::Camera& source, CameraDescription& camera) {
  camera.height = kGltfPictureHeight;
  if (source.type == "orthographic") {
    const double width = 2.0 * std::abs(source.orthographic.xmag);
    const double height = 2.0 * std::abs(source.orthographic.ymag);
    if (!(height > 0.0) || !(width > 0.0)) return "its picture has no extent (xmag, ymag)";
    camera.projection = Projection::Orthographic;
    camera.orthographicHeight = height;
    camera.width = widthOf(width / height);
    return {};
  }
  camera.fovYDegrees = source.perspective.yfov * 180.0 / kPiD;
  if (!(camera.fovYDegrees >= 0.001 && camera.fovYDegrees <= 179.999))
    return fmt::format("expected a yfov above 0 and below pi, found {}", source.perspective.yfov);
  camera.width = widthOf(source.perspective.aspectRatio);
  return {};
}

/// The first of "name", "name 2", "name 3" and so on that is free.
std::string uniqueName(const std::string& name, std::set<std::string>& taken) {
  std::string unique = name;
  for (int number = 2; !taken.insert(unique).second; ++number) unique = fmt::format("{} {}", name, number);
  return unique;
}

std::string firstName(const std::string& first, const std::string& second, const std::string& otherwise) {
  return !first.empty() ? first : !second.empty() ? second : otherwise;
}

constexpr double degreesOf(double radians) { return radians * 180.0 / kPiD; }

SpotLightDescription spotOf(const tinygltf::SpotLight& source, const Vec3d& position, const Vec3d& direction,
                            const Rgb& intensity, GltfNotes& notes) {
  if (source.innerConeAngle > source.outerConeAngle)
    notes.say("of spot lights whose inner cone is wider than the outer one it is taken as wide as that");
  SpotLightDescription spot;
  spot.position = position;
  spot.direction = direction;
  spot.intensity = intensity;
  spot.outerDegrees = std::clamp(degreesOf(source.outerConeAngle), 0.0, 180.0);
  spot.innerDegrees = std::clamp(degreesOf(source.innerConeAngle), 0.0, spot.outerDegrees);
  return spot;
}

/// The power of a light; none where a number is not one of light.
std::optional<Rgb> gltfPower(const tinygltf::Light& source) {
  if (!source.color.empty() && source.color.size() != 3) return std::nullopt;
  Rgb power(0.0f);
  for (int c = 0; c < 3; ++c) {
    const double factor = source.color.empty() ? 1.0 : source.color[static_cast<std::size_t>(c)];
    const double value = factor * source.intensity;
    if (!(value >= 0.0 && value <= std::numeric_limits<float>::max())) return std::nullopt;
    power[c] = static_cast<float>(value);
  }
  return power;
}

Expected<LightGeometryDescription> lightGeometry(const GltfFile& file, const tinygltf::Light& source,
                                                 const GltfPlacedNode& node, const std::string& title,
                                                 GltfNotes& notes) {
  const std::optional<Rgb> power = gltfPower(source);
  if (!power) return file.error(title + ": its color and intensity are no power of light");
  const Vec3d position(node.toWorld[3]);
  if (!isFinite(position)) return file.error(title + ": a coordinate is not a finite number");
  if (source.type == "point") return PointLightDescription{position, *power};
  const Vec3d direction = -worldAxis(node, 2);
  if (direction == Vec3d(0.0)) return file.error(title + " shines nowhere: its node has no extent");
  if (source.type == "spot") return spotOf(source.spot, position, direction, *power, notes);
  if (source.type == "directional") return DirectionalLightDescription{direction, *power, 0.0};
  return file.error(fmt::format("{}: expected point, spot or directional, found another type", title));
}

}  // namespace

Expected<void> addGltfCameras(const GltfFile& file, const std::vector<GltfPlacedNode>& nodes,
                              const BoundsD& bounds, SceneDescription& scene) {
  std::set<std::string> names;
  for (const GltfPlacedNode& placed : nodes) {
    const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.camera < 0) continue;
    const tinygltf::Camera& source = file.model.cameras[static_cast<std::size_t>(node.camera)];
    const std::string title = gltfName("camera", node.camera, source.name);
    CameraDescription camera;
    if (const std::string wrong = fillProjection(source, camera); !wrong.empty())
      return file.error(fmt::format("{}: {}", title, wrong));
    const Vec3d forward = -worldAxis(placed, 2);
    camera.up = worldAxis(placed, 1);
    if (forward == Vec3d(0.0) || camera.up == Vec3d(0.0))
      return file.error(title + " looks nowhere: its node has no extent");
    camera.position = Vec3d(placed.toWorld[3]);
    const double toMiddle = glm::dot(bounds.centre() - camera.position, forward);
    const double distance = toMiddle > 0.0 && std::isfinite(toMiddle) ? toMiddle : 1.0;
    camera.target = camera.position + distance * forward;
    camera.name = uniqueName(firstName(node.name, source.name, fmt::format("camera {}", node.camera)), names);
    scene.cameras.push_back(std::move(camera));
  }
  return {};
}

Expected<void> addGltfLights(const GltfFile& file, const std::vector<GltfPlacedNode>& nodes, GltfNotes& notes,
                             SceneDescription& scene) {
  for (const GltfPlacedNode& placed : nodes) {
    const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.node)];
    const int index = gltfLightOf(node);
    if (index < 0) continue;
    const tinygltf::Light& source = file.model.lights[static_cast<std::size_t>(index)];
    Expected<LightGeometryDescription> geometry =
        lightGeometry(file, source, placed, gltfName("light", index, source.name), notes);
    if (!geometry) return tl::unexpected(geometry.error());
    if (source.range > 0.0) notes.unused("the range of lights");
    scene.lights.push_back(
        {firstName(node.name, source.name, fmt::format("light {}", index)), std::move(*geometry)});
  }
  return {};
}

}  // namespace lightvane
