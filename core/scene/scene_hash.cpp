#include <array>
#include <bit>
#include <concepts>
#include <map>
#include <memory>
#include <type_traits>

#include <fmt/format.h>
#include <xxhash.h>

#include "core/base/check.h"
#include "core/scene/description.h"

namespace lightvane {
namespace {

/// Feeds XXH64 with a canonical serialisation: little-endian numbers of fixed width, counts before sequences,
/// a tag before each alternative; so that no two scenes have the same bytes.
class Hasher {
 public:
  explicit Hasher(LoadWatch& watch) : state_(XXH64_createState(), &XXH64_freeState), watch_(watch) {
    LV_CHECK(state_ && XXH64_reset(state_.get(), 0) == XXH_OK, "xxHash has no state");
  }

  void add(std::uint64_t value) {
    std::array<unsigned char, 8> bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<unsigned char>(value >> (8 * i));
    XXH64_update(state_.get(), bytes.data(), bytes.size());
  }
  void add(double value) {
    // -0 and 0 are the same number.
    add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value));
  }
  void add(float value) { add(static_cast<double>(value)); }
  void add(bool value) { add(std::uint64_t{value}); }
  void add(int value) { add(static_cast<std::uint64_t>(value)); }
  void add(std::uint32_t value) { add(std::uint64_t{value}); }

  template <glm::length_t N, class T>
  void add(const glm::vec<N, T>& v) {
    for (glm::length_t i = 0; i < N; ++i) add(v[i]);
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(std::uint64_t{values.size()});
    for (std::size_t i = 0; i < values.size(); ++i) {
      watch_.piece(i);
      add(values[i]);
    }
  }
  template <class... T>
  void add(const std::variant<T...>& value) {
    add(std::uint64_t{value.index()});
    std::visit([this](const auto& alternative) { this->add(alternative); }, value);
  }

  // The structured bindings name every field: a new one does not compile until it is dealt with here. Names
  // do not change a picture, nor does the file that a mesh came from.

  void add(const LayerDescription& layer) {
    const auto& [color, roughness, isotropy, model] = layer;
    addAll(color, roughness, isotropy);
    if (model != LayerModel::Schlick) add(static_cast<std::uint64_t>(model));
  }
  void add(const MaterialDescription& material) {
    const auto& [name, diffuse, mirror, transmission, ior, thin, layers, emission, twoSided, tangent,
                 textures, opacity] = material;
    addAll(diffuse, mirror, transmission, ior, layers, emission, twoSided, tangent);
    if (thin) add(std::uint64_t{0x7468696eU});
    if (textures.any()) add(textures);
    if (!opacity.isFull()) add(opacity);
  }
  void add(const OpacityDescription& opacity) {
    const auto& [value, texture, cutoff] = opacity;
    addAll(std::uint64_t{0x6f706163U}, value, texture, cutoff);
  }
  void add(const TextureUse& use) {
    const auto& [texture, scale] = use;
    addAll(std::uint64_t{texture}, scale);
  }
  void add(const MaterialTextures& textures) {
    const auto& [diffuse, mirror, transmission, layers, emission] = textures;
    addAll(diffuse, mirror, transmission, layers[0], layers[1]);
    if (emission) addAll(std::uint64_t{0x656d6974U}, *emission);
  }
  void add(const ImageTextureDescription& image) {
    const auto& [file, pixels, wrap, filter, channel] = image;  // what a channel holds is in the pixels
    addAll(static_cast<int>(wrap), static_cast<int>(filter));
    add(*pixels);
  }
  void add(const CheckerDescription& checker) {
    const auto& [even, odd] = checker;
    addAll(even, odd);
  }
  void add(const WoodDescription& wood) {
    const auto& [light, dark, axis, ring, distortion, grain] = wood;
    addAll(light, dark, axis, ring, distortion, grain);
  }
  void add(const MarbleDescription& marble) {
    const auto& [base, vein, axis, spacing, distortion, sharpness, octaves] = marble;
    addAll(base, vein, axis, spacing, distortion, sharpness, octaves);
  }
  void add(const TextureDescription& texture) {
    const auto& [name, pattern] = texture;
    add(pattern);
  }
  void add(const ImageRgb& pixels) {
    addAll(pixels.width(), pixels.height());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      watch_.piece(i);
      add(pixels[i]);
    }
  }
  void add(const TransformDescription& transform) {
    const auto& [translate, rotateDegrees, scale] = transform;
    addAll(translate, rotateDegrees, scale);
  }
  void add(const PolygonDescription& polygon) {
    const auto& [vertices] = polygon;
    add(vertices);
  }
  void add(const SphereDescription& sphere) {
    const auto& [center, radius] = sphere;
    addAll(center, radius);
  }
  void add(const BoxDescription& box) {
    const auto& [min, max] = box;
    addAll(min, max);
  }
  void add(const DiscDescription& disc) {
    const auto& [center, normal, radius] = disc;
    addAll(center, normal, radius);
  }
  void add(const MeshDescription& mesh) {
    const auto& [file, geometry, materials, placement] = mesh;
    const MeshDigest& digest = digestOf(geometry);
    add(digest.triangles);
    if (mesh.bringsMaterials()) addAll(digest.materials, materials);
    for (int column = 0; column < 4; ++column) add(placement[column]);
  }
  void add(const ShapeDescription& shape) {
    const auto& [name, material, light, transform, geometry] = shape;
    // Which shapes are one light matters, not what it is called: lights are numbered as they appear.
    const std::uint64_t group =
        light.empty() ? 0 : lightGroups_.try_emplace(light, lightGroups_.size() + 1).first->second;
    addAll(std::uint64_t{material}, group, transform, geometry);
  }
  void add(const PointLightDescription& light) {
    const auto& [position, intensity] = light;
    addAll(position, intensity);
  }
  void add(const SpotLightDescription& light) {
    const auto& [position, direction, intensity, innerDegrees, outerDegrees] = light;
    addAll(position, direction, intensity, innerDegrees, outerDegrees);
  }
  void add(const DirectionalLightDescription& light) {
    const auto& [direction, irradiance, angleDegrees] = light;
    addAll(direction, irradiance, angleDegrees);
  }
  void add(const VolumicSphereLightDescription& light) {
    const auto& [center, radius, intensity, points] = light;
    addAll(center, radius, intensity, points);
  }
  void add(const EnvironmentLightDescription& light) {
    const auto& [radiance, image, pixels, rotateDegrees, up] = light;
    addAll(radiance, rotateDegrees, up, pixels != nullptr);
    if (pixels) add(*pixels);
  }
  void add(const LightDescription& light) {
    const auto& [name, geometry] = light;
    add(geometry);
  }
  void add(const CameraDescription& camera) {
    const auto& [name, position, target, up, fovYDegrees, width, height, exposureStops, projection,
                 orthographicHeight, lensRadius, focusDistance] = camera;
    addAll(position, target, up, fovYDegrees, width, height, exposureStops);
    // A pinhole has no more bytes than it had when there was nothing else, so that its hash stays. What
    // follows it is a coordinate or a count, which the tags cannot be: as numbers they are not finite.
    if (projection == Projection::Orthographic) {
      addAll(kOrthographicTag, orthographicHeight);
    } else if (lensRadius > 0.0) {
      addAll(kLensTag, lensRadius, camera.resolvedFocusDistance());
    }
  }
  void add(const SceneDescription& scene, HashScope scope) {
    const auto& [path, name, units, cameras, textures, materials, shapes, lights, render, warnings] = scene;
    add(metresPerUnit(units));
    if (scope == HashScope::Picture) add(cameras);
    addAll(materials, shapes, lights);
    // What few scenes have is left out of those that do not: theirs keep the hash that caches know them by.
    if (!textures.empty()) add(textures);
  }

  std::uint64_t digest() const { return XXH64_digest(state_.get()); }

 private:
  static constexpr std::uint64_t kOrthographicTag = ~std::uint64_t{0};
  static constexpr std::uint64_t kLensTag = ~std::uint64_t{1};

  /// Of a mesh's triangles, and of what they say about materials.
  struct MeshDigest {
    std::uint64_t triangles = 0;
    std::uint64_t materials = 0;
  };

  /// Worked out once, however many shapes place the mesh.
  const MeshDigest& digestOf(const std::shared_ptr<const MeshGeometry>& geometry) {
    const auto [entry, isNew] = meshes_.try_emplace(geometry.get());
    if (!isNew) return entry->second;
    const auto& [positions, normals, colors, uvs, triangles, triangleMaterials] = *geometry;
    Hasher ofTriangles(watch_), ofMaterials(watch_);
    ofTriangles.addAll(positions, normals, colors, uvs, triangles);
    ofMaterials.add(triangleMaterials);
    entry->second = {ofTriangles.digest(), ofMaterials.digest()};
    return entry->second;
  }

  template <class... T>
  void addAll(const T&... values) {
    (add(values), ...);
  }

  std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state_;
  LoadWatch& watch_;
  std::map<std::string, std::uint64_t> lightGroups_;
  std::map<const MeshGeometry*, MeshDigest> meshes_;
};

}  // namespace

std::string sceneHash(const SceneDescription& scene, HashScope scope, LoadWatch& watch) {
  Hasher hasher(watch);
  hasher.add(scene, scope);
  return fmt::format("{:016x}", hasher.digest());
}

}  // namespace lightvane
