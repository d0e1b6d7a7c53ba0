#include "core/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "core/base/check.h"
#include "core/base/random.h"
#include "core/scene/emission_pattern.h"
#include "core/scene/layer_shapes.h"
#include "core/scene/shared_meshes.h"
#include "core/scene/transform.h"

namespace lightvane {
namespace {

// A scene's planar mirrors times its area lights, at most: beyond that their images are left to chance.
constexpr std::size_t kMaxMirroredLights = 64;
// What meshes may have of vertices and triangles that are copied for each shape: some 4 GB.
constexpr std::size_t kMostCopiedElements = std::size_t{1} << 26;
// Emitting pieces that the image of a light may have: more would cost more per look than they save.
constexpr std::size_t kMaxMirroredPieces = 16;

/// The polygons of a box, front sides outwards.
std::vector<std::vector<Vec3d>> boxFaces(const BoxDescription& box) {
  const Vec3d lo = glm::min(box.min, box.max);
  const Vec3d hi = glm::max(box.min, box.max);
  const auto corner = [&](int i) {
    return Vec3d(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
  };
  constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  std::vector<std::vector<Vec3d>> faces;
  for (const auto& face : kFaces) {
    std::vector<Vec3d> vertices;
    for (const int i : face) vertices.push_back(corner(i));
    faces.push_back(std::move(vertices));
  }
  return faces;
}

/// Texture coordinates of a planar face: from 0 to 1 over its extent along `right`, and across, where 1 is up
/// as seen from the front.
std::vector<Vec2> faceUvs(const std::vector<Vec3d>& vertices, const Vec3d& right) {
  Vec3d normal(0.0);
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
    normal += glm::cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  const Vec3d up = glm::cross(normal, right);
  glm::dvec2 least(std::numeric_limits<double>::infinity());
  glm::dvec2 greatest(-least);
  std::vector<glm::dvec2> places;
  for (const Vec3d& v : vertices) {
    places.emplace_back(glm::dot(v - vertices[0], right), glm::dot(v - vertices[0], up));
    least = glm::min(least, places.back());
    greatest = glm::max(greatest, places.back());
  }
  std::vector<Vec2> uvs;
  for (const glm::dvec2& place : places) {
    const glm::dvec2 extent = greatest - least;
    uvs.emplace_back((place - least) / glm::max(extent, glm::dvec2(std::numeric_limits<double>::min())));
  }
  return uvs;
}

/// What of a material's numbers is none of a reflectance, of light or of glass; nothing where all are.
std::optional<std::string> wrongNumbers(const MaterialDescription& material) {
  std::vector<std::pair<const char*, const Rgb*>> reflectances = {
      {"diffuse", &material.diffuse}, {"mirror", &material.mirror}, {"transmission", &material.transmission}};
  for (const LayerDescription& layer : material.layers)
    reflectances.emplace_back("color of a layer", &layer.color);
  const auto text = [](const Rgb& c) { return fmt::format("[{:g}, {:g}, {:g}]", c.r, c.g, c.b); };
  for (const auto& [what, color] : reflectances) {
    if (!isValidSample(*color) || maxComponent(*color) > 1.0f)
      return fmt::format("{}: expected numbers from 0 to 1, found {}", what, text(*color));
  }
  for (const LayerDescription& layer : material.layers) {
    if (!(layer.roughness >= 0.0 && layer.roughness <= 1.0))
      return fmt::format("roughness: expected a number from 0 to 1, found {:g}", layer.roughness);
  }
  if (!isValidSample(material.emission))
    return fmt::format("emission: expected finite numbers, 0 or above, found {}", text(material.emission));
  if (!(material.ior > 0.0 && std::isfinite(material.ior)))
    return fmt::format("ior: expected a finite number above 0, found {:g}", material.ior);
  if (!(material.opacity.value >= 0.0 && material.opacity.value <= 1.0))
    return fmt::format("opacity: expected a number from 0 to 1, found {:g}", material.opacity.value);
  return std::nullopt;
}

/// Builds the scene step by step; each step reads what the earlier ones left.
class Compiler {
 public:
  Compiler(const SceneDescription& description, EnergyRule rule, LoadWatch& watch)
      : in_(description), rule_(rule), watch_(watch) {}

  Expected<std::shared_ptr<const Scene>> run() {
    if (in_.shapes.empty()) return makeError(in_.path.string(), "the scene has no shapes", "add a [[shape]]");
    if (in_.cameras.empty()) return makeError(in_.path.string(), "the scene has no camera", "add a [camera]");
    const LoadStage stage(watch_, "preparing the scene");
    scene_->name = in_.name;
    scene_->hash = sceneHash(in_, HashScope::Picture, watch_);
    watch_.part(0.3, 0.5);
    watch_.look(0.0);
    scene_->metresPerUnit = in_.metresPerUnit() > 0.0 ? in_.metresPerUnit() : 1.0;
    scene_->warnings = in_.warnings;
    if (auto done = normaliseLengths(); !done) return tl::unexpected(done.error());
    shared_ = std::make_unique<SharedMeshes>(in_, scene_->normalisation, watch_);
    if (auto done = checkSize(); !done) return tl::unexpected(done.error());
    if (auto done = checkMaterials(); !done) return tl::unexpected(done.error());
    normaliseRadiances();
    compileMaterials();
    watch_.part(0.5, 1.0);
    for (std::size_t i = 0; i < in_.shapes.size(); ++i) {
      watch_.look(static_cast<double>(i) / static_cast<double>(in_.shapes.size()));
      if (auto done = compileShape(i); !done) return tl::unexpected(done.error());
    }
    if (auto done = finishAreaLights(); !done) return tl::unexpected(done.error());
    compileOtherLights();
    scene_->lightTree = LightTree(scene_->lights);
    if (auto done = compileCameras(); !done) return tl::unexpected(done.error());
    if (scene_->meshes.front().triangles.empty()) scene_->meshes.erase(scene_->meshes.begin());
    if (!mappedFaces_.triangles.empty()) scene_->meshes.push_back(std::move(mappedFaces_));
    if (droppedTriangles_ > 0) {
      scene_->warnings.push_back(fmt::format("{} triangle{} without area left out", droppedTriangles_,
                                             droppedTriangles_ == 1 ? "" : "s"));
    }
    workOutBounds();
    mirrorLights();
    workOutNeeds();
    return std::shared_ptr<const Scene>(scene_);
  }

 private:
  Error shapeError(std::size_t index, const std::string& what, const std::string& hint = {}) const {
    const ShapeDescription& shape = in_.shapes[index];
    const std::string name =
        shape.name.empty() ? fmt::format("shape {}", index + 1) : "shape '" + shape.name + "'";
    return Error{in_.path.string(), name + ": " + what, hint};
  }

  /// Calls `visit` with every point that spans a shape other than a mesh, in scene units.
  template <class Visit>
  static void visitExtent(const ShapeDescription& shape, Visit&& visit) {
    const Transform transform(shape.transform);
    if (const auto* polygon = std::get_if<PolygonDescription>(&shape.geometry)) {
      for (const Vec3d& v : polygon->vertices) visit(transform.point(v));
    } else if (const auto* sphere = std::get_if<SphereDescription>(&shape.geometry)) {
      const Vec3d centre = transform.point(sphere->center);
      const double radius = sphere->radius * transform.uniformScale();
      visit(centre - Vec3d(radius));
      visit(centre + Vec3d(radius));
    } else if (const auto* box = std::get_if<BoxDescription>(&shape.geometry)) {
      for (const auto& face : boxFaces(*box)) {
        for (const Vec3d& v : face) visit(transform.point(v));
      }
    } else if (const auto* disc = std::get_if<DiscDescription>(&shape.geometry)) {
      const Vec3d centre = transform.point(disc->center);
      const Vec3d n = transform.normal(disc->normal / glm::length(disc->normal));
      const Vec3d extent =
          disc->radius * transform.uniformScale() * glm::sqrt(glm::max(Vec3d(0.0), 1.0 - n * n));
      visit(centre - extent);
      visit(centre + extent);
    }
  }

  /// Adds the shape to the bounds; false where a coordinate is not finite.
  bool addExtent(const ShapeDescription& shape, std::map<const MeshGeometry*, BoundsD>& ofMeshes,
                 BoundsD& bounds) const {
    if (const auto* mesh = std::get_if<MeshDescription>(&shape.geometry)) {
      const auto [box, isNew] = ofMeshes.try_emplace(mesh->geometry.get());
      if (isNew) box->second = boundsOf<Vec3d>(mesh->geometry->positions);
      const Transform transform(shape.transform, mesh->placement);
      std::size_t looked = 0;
      const auto place = [&](const Vec3d& p) {
        watch_.piece(looked++);
        return transform.point(p);
      };
      return addPlaced<Vec3d>(mesh->geometry->positions, box->second, place, bounds);
    }
    bool isAllFinite = true;
    visitExtent(shape, [&](const Vec3d& p) {
      isAllFinite = isAllFinite && isFinite(p);
      bounds.add(p);
    });
    return isAllFinite;
  }

  /// A small file can place a large mesh many times.
  Expected<void> checkSize() const {
    std::size_t copied = 0;
    for (std::size_t i = 0; i < in_.shapes.size(); ++i) {
      const auto* mesh = std::get_if<MeshDescription>(&in_.shapes[i].geometry);
      if (mesh == nullptr || shared_->has(i)) continue;
      copied += mesh->geometry->positions.size() + mesh->geometry->triangles.size();
      if (copied <= kMostCopiedElements) continue;
      return tl::unexpected(
          shapeError(i,
                     fmt::format("with it, meshes have more than {} vertices and triangles, not counting "
                                 "those that shapes share",
                                 kMostCopiedElements),
                     "large meshes that do not emit count once, however many shapes place them"));
    }
    return {};
  }

  Expected<void> normaliseLengths() {
    BoundsD bounds;
    std::map<const MeshGeometry*, BoundsD> ofMeshes;
    for (std::size_t i = 0; i < in_.shapes.size(); ++i) {
      watch_.look(static_cast<double>(i) / static_cast<double>(in_.shapes.size()));
      if (!addExtent(in_.shapes[i], ofMeshes, bounds))
        return tl::unexpected(shapeError(i, "a coordinate is not a finite number"));
    }
    const double diagonal = bounds.diagonal();
    if (!std::isfinite(diagonal))
      return makeError(in_.path.string(), "the scene is larger than a number can tell");
    if (!(diagonal > 0.0))
      return makeError(in_.path.string(), "the scene has no extent: all shapes are one point");
    scene_->normalisation.centre = bounds.centre();
    std::frexp(diagonal, &scene_->normalisation.lengthExponent);
    return {};
  }

  /// W sr^-1 in scene units become W sr^-1 in normalised ones: the same irradiance at the same place.
  double intensityScale() const { return std::ldexp(1.0, -2 * scene_->normalisation.lengthExponent); }

  void normaliseRadiances() {
    double brightest = 0.0;
    const auto see = [&](const Rgb& c, double scale) {
      brightest = std::max(brightest, static_cast<double>(maxComponent(c)) * scale);
    };
    for (const ShapeDescription& shape : in_.shapes) {
      watch_.look();
      see(in_.materials[shape.material].emission, 1.0);
      if (const auto* mesh = std::get_if<MeshDescription>(&shape.geometry)) {
        for (const std::uint32_t material : mesh->materials) see(in_.materials[material].emission, 1.0);
      }
    }
    // Point lights: the irradiance at a quarter of the scene's size, as if it were radiance from the
    // hemisphere.
    constexpr double kPointLightFactor = 16.0 / kPiD;
    for (const LightDescription& light : in_.lights) {
      if (const auto* point = std::get_if<PointLightDescription>(&light.geometry)) {
        see(point->intensity, intensityScale() * kPointLightFactor);
      } else if (const auto* spot = std::get_if<SpotLightDescription>(&light.geometry)) {
        see(spot->intensity, intensityScale() * kPointLightFactor);
      } else if (const auto* volume = std::get_if<VolumicSphereLightDescription>(&light.geometry)) {
        see(volume->intensity, intensityScale() * kPointLightFactor);
      } else if (const auto* sun = std::get_if<DirectionalLightDescription>(&light.geometry)) {
        see(sun->irradiance, 1.0 / kPiD);
      } else if (const auto* sky = std::get_if<EnvironmentLightDescription>(&light.geometry)) {
        see(sky->radiance, sky->pixels ? static_cast<double>(brightestOf(*sky->pixels)) : 1.0);
      }
    }
    if (brightest > 0.0) std::frexp(brightest, &scene_->normalisation.radianceExponent);
    // The scale itself must be a float, and not one of those that are flushed to 0.
    constexpr int kMostExponent = 127;
    constexpr int kLeastExponent = -126;
    scene_->normalisation.radianceExponent =
        std::clamp(scene_->normalisation.radianceExponent, kLeastExponent, kMostExponent);
  }

  Rgb radiance(const Rgb& c, double scale = 1.0) const {
    return {glm::dvec3(c) * std::ldexp(scale, -scene_->normalisation.radianceExponent)};
  }

  /// Loaders let no such numbers through: a fault of theirs is to be a message, and no picture.
  Expected<void> checkMaterials() const {
    for (const MaterialDescription& material : in_.materials) {
      watch_.look();
      if (const auto wrong = wrongNumbers(material))
        return makeError(in_.path.string(), fmt::format("material '{}': {}", material.name, *wrong));
    }
    return {};
  }

  void compileMaterials() {
    for (const TextureDescription& texture : in_.textures) scene_->textures.emplace_back(texture);
    LayerShapes shapes;
    const auto sameBrdf = [](const MaterialDescription& a, const MaterialDescription& b) {
      return a.diffuse == b.diffuse && a.mirror == b.mirror && a.transmission == b.transmission &&
             ((a.ior == b.ior && a.thin == b.thin) || !a.isGlass()) && a.layers == b.layers &&
             a.tangent == b.tangent && a.textures.layers[0].has_value() == b.textures.layers[0].has_value() &&
             a.textures.layers[1].has_value() == b.textures.layers[1].has_value();
    };
    for (std::size_t i = 0; i < in_.materials.size(); ++i) {
      const MaterialDescription& d = in_.materials[i];
      Material material;
      material.name = d.name;
      material.emission = radiance(d.emission);
      material.twoSided = d.twoSided;
      if (d.tangent) {
        material.hasTangent = true;
        material.tangent = Vec3(*d.tangent);
      }
      material.textures = d.textures;
      material.isTinted = d.textures.ofReflection();
      material.opacity = d.opacity;
      watch_.look();
      std::size_t same = 0;
      while (!sameBrdf(in_.materials[same], d)) ++same;
      material.brdfKey = static_cast<std::uint32_t>(same);
      material.brdf = same == i ? Brdf::compile(d, rule_, shapes) : scene_->materials[same].brdf;
      scene_->materials.push_back(std::move(material));
    }
  }

  std::uint32_t addSurface(std::size_t shape, std::size_t material) {
    scene_->surfaces.push_back(
        {static_cast<std::uint32_t>(material), static_cast<std::uint32_t>(shape), kNone, kNone});
    return static_cast<std::uint32_t>(scene_->surfaces.size() - 1);
  }

  /// The area light that an emitting surface belongs to; made when it is first met.
  Expected<std::uint32_t> lightOf(std::size_t shape, std::size_t material) {
    const ShapeDescription& d = in_.shapes[shape];
    const Material& m = scene_->materials[material];
    const std::string key = d.light.empty() ? fmt::format("\n{}/{}", shape, material) : d.light;
    const auto [entry, isNew] =
        lightIndices_.try_emplace(key, static_cast<std::uint32_t>(scene_->lights.size()));
    if (isNew) {
      AreaLight light;
      light.radiance = m.emission;
      light.twoSided = m.twoSided;
      scene_->lights.emplace_back(std::move(light));
      emissionTextures_.push_back({m.textures.emission, {}});
      scene_->lightNames.push_back(!d.light.empty()  ? d.light
                                   : !d.name.empty() ? d.name
                                                     : fmt::format("shape {}", shape + 1));
    } else {
      const auto& light = std::get<AreaLight>(scene_->lights[entry->second]);
      if (light.radiance != m.emission || light.twoSided != m.twoSided ||
          emissionTextures_[entry->second].use != m.textures.emission) {
        return tl::unexpected(shapeError(
            shape, fmt::format("belongs to light '{}' but emits otherwise than its other shapes", d.light),
            "give it a light of its own, or the same emission"));
      }
    }
    return entry->second;
  }

  AreaLight& areaLight(std::uint32_t index) { return std::get<AreaLight>(scene_->lights[index]); }

  bool usesUv(std::size_t material) const {
    bool uses = false;
    forEachUse(in_.materials[material],
               [&](const TextureUse& use) { uses = uses || scene_->textures[use.texture].usesUv(); });
    return uses;
  }

  /// Triangulates a planar convex face into the mesh that all flat shapes share, or into that of those with
  /// texture coordinates. `right` is the direction of u.
  Expected<void> addFace(std::size_t shape, const std::vector<Vec3d>& vertices, const Vec3d& right,
                         const Transform& transform) {
    const std::size_t material = in_.shapes[shape].material;
    const std::uint32_t surface = addSurface(shape, material);
    std::vector<Vec3> outline;
    for (const Vec3d& v : vertices) outline.push_back(scene_->normalisation.point(transform.point(v)));
    if (transform.flips()) std::reverse(outline.begin(), outline.end());
    TriangleMesh& mesh = usesUv(material) ? mappedFaces_ : scene_->meshes.front();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), outline.begin(), outline.end());
    if (usesUv(material)) {
      std::vector<Vec2> uvs = faceUvs(vertices, right);
      if (transform.flips()) std::reverse(uvs.begin(), uvs.end());
      mesh.uvs.insert(mesh.uvs.end(), uvs.begin(), uvs.end());
    }
    Vec3 normal(0.0f);
    for (std::uint32_t i = 1; i + 1 < outline.size(); ++i) {
      const std::optional<Vec3> triangleNormal =
          addTriangle(mesh, {first, first + i, first + i + 1}, surface);
      if (!triangleNormal) continue;
      normal = *triangleNormal;
      if (auto done = addEmitter(mesh, surface); !done) return done;
    }
    if (normal == Vec3(0.0f)) return {};
    Surface& s = scene_->surfaces[surface];
    if (s.light != kNone) {
      outlines_[s.light].push_back(outline);
    }
    // What a mirror with a texture or with gaps reflects of a light differs from place to place: it is left
    // to chance.
    const Material& m = scene_->materials[material];
    const bool isEvenMirror = m.brdf.hasSpecular() && !m.brdf.isGlass() && !m.textures.mirror &&
                              !m.textures.layers[0] && !m.textures.layers[1] && m.opacity.isFull();
    if (isEvenMirror) {
      s.planarMirror = static_cast<std::uint32_t>(scene_->planarMirrors.size());
      PlanarMirror mirror{outline, {}, normal, surface};
      for (std::size_t i = 0; i < outline.size(); ++i)
        mirror.inwards.push_back(glm::cross(normal, outline[(i + 1) % outline.size()] - outline[i]));
      scene_->planarMirrors.push_back(std::move(mirror));
    }
    return {};
  }

  /// The triangle's unit normal, or nothing where it has no area and was left out.
  std::optional<Vec3> addTriangle(TriangleMesh& mesh, const glm::uvec3& corners, std::uint32_t surface) {
    const Vec3d n = doubleArea(mesh, corners);
    const double length = glm::length(n);
    if (!(length > 0.0)) {
      ++droppedTriangles_;
      return std::nullopt;
    }
    mesh.triangles.push_back(corners);
    mesh.surfaces.push_back(surface);
    mesh.pieces.push_back(kNone);
    return Vec3(n / length);
  }

  /// Makes the mesh's last triangle a piece of its surface's light, where that emits.
  Expected<void> addEmitter(TriangleMesh& mesh, std::uint32_t surfaceIndex) {
    Surface& surface = scene_->surfaces[surfaceIndex];
    if (isBlack(scene_->materials[surface.material].emission)) return {};
    const Expected<std::uint32_t> light = lightOf(surface.shape, surface.material);
    if (!light) return tl::unexpected(light.error());
    surface.light = *light;
    const glm::uvec3& corners = mesh.triangles.back();
    const Vec3 a = mesh.positions[corners.x];
    const Vec3 b = mesh.positions[corners.y];
    const Vec3 c = mesh.positions[corners.z];
    const Vec3d n = doubleArea(mesh, corners);
    const double length = glm::length(n);
    std::vector<EmitterTriangle>& pieces = areaLight(*light).triangles;
    mesh.pieces.back() = static_cast<std::uint32_t>(pieces.size());
    pieces.push_back({a, b, c, Vec3(n / length), static_cast<float>(0.5 * length)});
    if (emissionTextures_[*light].use) emissionTextures_[*light].corners.push_back(cornerUvs(mesh, corners));
    return {};
  }

  static EmissionPattern::Corners cornerUvs(const TriangleMesh& mesh, const glm::uvec3& corners) {
    if (mesh.uvs.empty()) return {};
    return {mesh.uvs[corners.x], mesh.uvs[corners.y], mesh.uvs[corners.z]};
  }

  /// How bright the picture of a texture is; null where it shows none.
  const PictureBrightness* brightnessOf(std::size_t texture) {
    const ImageTextureDescription* image = scene_->textures[texture].image();
    if (image == nullptr) return nullptr;
    std::unique_ptr<const PictureBrightness>& entry = pictureBrightness_[texture];
    if (!entry) entry = std::make_unique<const PictureBrightness>(*image);
    return entry.get();
  }

  /// Whether the mesh's last triangle shows nothing but black of the picture that its material emits. Of a
  /// helmet of which a visor glows, the rest is no light.
  bool emitsBlack(const TriangleMesh& mesh, std::size_t material) {
    const Material& m = scene_->materials[material];
    if (!m.textures.emission || isBlack(m.emission)) return false;
    const PictureBrightness* brightness = brightnessOf(m.textures.emission->texture);
    return brightness != nullptr && EmissionPattern::isBlackWithin(cornerUvs(mesh, mesh.triangles.back()),
                                                                   *m.textures.emission, *brightness);
  }

  Expected<void> compileShape(std::size_t index) {
    const ShapeDescription& shape = in_.shapes[index];
    scene_->shapeNames.push_back(shape.name.empty() ? fmt::format("shape {}", index + 1) : shape.name);
    if (const auto* mesh = std::get_if<MeshDescription>(&shape.geometry)) {
      const Transform transform(shape.transform, mesh->placement);
      return shared_->has(index) ? addInstance(index, *mesh, transform) : addMesh(index, *mesh, transform);
    }
    const Transform transform(shape.transform);
    const bool round = std::holds_alternative<SphereDescription>(shape.geometry) ||
                       std::holds_alternative<DiscDescription>(shape.geometry);
    if (round && !transform.isUniform()) {
      return tl::unexpected(shapeError(index, "spheres and discs take the same scale along all axes only"));
    }
    if (const auto* polygon = std::get_if<PolygonDescription>(&shape.geometry)) {
      return addFace(index, polygon->vertices, polygon->vertices[1] - polygon->vertices[0], transform);
    }
    if (const auto* box = std::get_if<BoxDescription>(&shape.geometry)) {
      for (const auto& face : boxFaces(*box)) {
        // Seen from outside, side faces stand upright along y, and the others have x to the right.
        const Vec3d normal = glm::cross(face[1] - face[0], face[2] - face[0]);
        const Vec3d right = normal.y != 0.0 ? Vec3d(1.0, 0.0, 0.0) : glm::cross(Vec3d(0.0, 1.0, 0.0), normal);
        if (auto done = addFace(index, face, right, transform); !done) return done;
      }
      return {};
    }
    return addRound(index, shape, transform);
  }

  Expected<void> addRound(std::size_t index, const ShapeDescription& shape, const Transform& transform) {
    const std::uint32_t surface = addSurface(index, shape.material);
    const bool emits = !isBlack(scene_->materials[shape.material].emission);
    if (emits) {
      const Expected<std::uint32_t> light = lightOf(index, shape.material);
      if (!light) return tl::unexpected(light.error());
      scene_->surfaces[surface].light = *light;
    }
    const std::uint32_t light = scene_->surfaces[surface].light;
    if (const auto* sphere = std::get_if<SphereDescription>(&shape.geometry)) {
      SphereShape s{scene_->normalisation.point(transform.point(sphere->center)),
                    scene_->normalisation.length(sphere->radius * transform.uniformScale()), surface, kNone};
      if (!(s.radius > 0.0f)) return {};
      if (emits) {
        s.piece = static_cast<std::uint32_t>(areaLight(light).spheres.size());
        areaLight(light).spheres.push_back({s.center, s.radius});
      }
      scene_->spheres.push_back(s);
    } else {
      const auto& disc = std::get<DiscDescription>(shape.geometry);
      const Vec3d n = transform.normal(disc.normal / glm::length(disc.normal));
      DiscShape d{scene_->normalisation.point(transform.point(disc.center)), Vec3(n),
                  scene_->normalisation.length(disc.radius * transform.uniformScale()), surface, kNone};
      if (!(d.radius > 0.0f)) return {};
      if (emits) {
        d.piece = static_cast<std::uint32_t>(areaLight(light).discs.size());
        areaLight(light).discs.push_back({d.center, d.normal, d.radius});
      }
      scene_->discs.push_back(d);
    }
    return {};
  }

  Expected<void> addMesh(std::size_t index, const MeshDescription& in, const Transform& transform) {
    const MeshGeometry& geometry = *in.geometry;
    TriangleMesh mesh;
    mesh.positions.reserve(geometry.positions.size());
    for (const Vec3d& p : geometry.positions) {
      watch_.piece(mesh.positions.size());
      mesh.positions.push_back(scene_->normalisation.point(transform.point(p)));
    }
    for (const Vec3d& n : geometry.normals) {
      watch_.piece(mesh.normals.size());
      mesh.normals.emplace_back(transform.normal(n));
      if (mesh.normals.back() != Vec3(0.0f)) continue;
      // What a transform makes flat or a line has no normals left.
      mesh.normals.clear();
      break;
    }
    mesh.colors = geometry.colors;
    mesh.uvs = geometry.uvs;
    std::map<std::size_t, std::uint32_t> surfaceOf;
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
      watch_.piece(i);
      const std::size_t material =
          in.bringsMaterials() ? in.materials[geometry.triangleMaterials[i]] : in_.shapes[index].material;
      const auto [entry, isNew] = surfaceOf.try_emplace(material, 0);
      if (isNew) entry->second = addMeshSurface(index, material, geometry);
      glm::uvec3 corners = geometry.triangles[i];
      if (transform.flips()) std::swap(corners.y, corners.z);
      if (!addTriangle(mesh, corners, entry->second) || emitsBlack(mesh, material)) continue;
      if (auto done = addEmitter(mesh, entry->second); !done) return done;
    }
    if (!mesh.triangles.empty()) scene_->meshes.push_back(std::move(mesh));
    return {};
  }

  Expected<void> addInstance(std::size_t index, const MeshDescription& in, const Transform& transform) {
    const SharedMeshes::Mesh& mesh = shared_->meshOf(index, scene_->materials, scene_->sharedMeshes);
    droppedTriangles_ += mesh.dropped;
    MeshInstance instance = placeInstance(mesh, transform, scene_->normalisation);
    instance.firstSurface = static_cast<std::uint32_t>(scene_->surfaces.size());
    for (const std::uint32_t material : mesh.materials) {
      addMeshSurface(index, in.bringsMaterials() ? in.materials[material] : in_.shapes[index].material,
                     *in.geometry);
    }
    const TriangleMesh& compiled = scene_->sharedMeshes[mesh.index];
    if (compiled.triangles.empty()) return {};
    scene_->instances.push_back(instance);
    std::size_t looked = 0;
    const auto place = [&](const Vec3& p) {
      watch_.piece(looked++);
      return instance.place(p);
    };
    addPlaced<Vec3>(compiled.positions, mesh.bounds, place, scene_->bounds);
    return {};
  }

  std::uint32_t addMeshSurface(std::size_t shape, std::size_t material, const MeshGeometry& geometry) {
    if (!geometry.colors.empty()) scene_->materials[material].isTinted = true;
    if (geometry.uvs.empty() && usesUv(material) && lackingUvs_.insert(shape).second) {
      scene_->warnings.push_back(fmt::format(
          "the mesh '{}' has a texture and no texture coordinates: it has the texture's colour at (0, 0)",
          scene_->shapeNames[shape]));
    }
    return addSurface(shape, material);
  }

  /// Pieces are numbered triangles first, then spheres, then discs.
  Expected<void> finishAreaLights() {
    for (SphereShape& s : scene_->spheres) {
      if (s.piece != kNone) {
        s.piece += static_cast<std::uint32_t>(areaLight(scene_->surfaces[s.surface].light).triangles.size());
      }
    }
    for (DiscShape& d : scene_->discs) {
      if (d.piece == kNone) continue;
      const AreaLight& light = areaLight(scene_->surfaces[d.surface].light);
      d.piece += static_cast<std::uint32_t>(light.triangles.size() + light.spheres.size());
    }
    for (std::uint32_t i = 0; i < scene_->lights.size(); ++i) {
      watch_.look();
      AreaLight& light = areaLight(i);
      const auto outline = outlines_.find(i);
      const bool isOnePolygon = outline != outlines_.end() && outline->second.size() == 1 &&
                                light.spheres.empty() && light.discs.empty() &&
                                light.triangles.size() + 2 == outline->second.front().size();
      if (isOnePolygon) light.polygon = outline->second.front();
      if (auto& [use, corners] = emissionTextures_[i]; use) {
        light.pattern = std::make_shared<const EmissionPattern>(
            scene_->textures[use->texture], *use, scene_->normalisation, std::move(corners), light,
            light.pieceCount() > LightSampler::kMaxPieces ? brightnessOf(use->texture) : nullptr);
      }
      light.finish();
    }
    return {};
  }

  float brightestOf(const ImageRgb& pixels) const {
    float brightest = 0.0f;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      watch_.piece(i);
      brightest = std::max(brightest, maxComponent(pixels[i]));
    }
    return brightest;
  }

  EnvironmentLight compileSky(const EnvironmentLightDescription& sky) const {
    EnvironmentLight light;
    light.radiance = radiance(sky.radiance);
    if (sky.pixels) {
      const int exponent = exponentOfSky(*sky.pixels);
      light.radiance = radiance(sky.radiance, std::ldexp(1.0, exponent));
      const double scale = std::ldexp(1.0, -exponent);
      ImageRgb copy(sky.pixels->width(), sky.pixels->height());
      for (std::size_t i = 0; i < copy.size(); ++i) {
        watch_.piece(i);
        copy[i] = Rgb(glm::dvec3((*sky.pixels)[i]) * scale);
      }
      light.map = std::make_shared<EnvironmentMap>(std::move(copy), watch_);
    }
    light.frame = environmentFrame(sky.up, sky.rotateDegrees);
    return light;
  }

  /// By what power of two a sky's picture is divided and its radiance multiplied, so that squares of what is
  /// in the picture are within single precision's range; 0 where they are.
  int exponentOfSky(const ImageRgb& pixels) const {
    constexpr int kMostExponent = 60;
    int exponent = 0;
    std::frexp(brightestOf(pixels), &exponent);
    return std::abs(exponent) > kMostExponent ? exponent : 0;
  }

  void addLight(Light light, const std::string& name, const char* kind) {
    scene_->lights.push_back(std::move(light));
    scene_->lightNames.push_back(name.empty() ? fmt::format("{} light {}", kind, scene_->lights.size())
                                              : name);
  }

  void compileOtherLights() {
    for (const LightDescription& d : in_.lights) {
      watch_.look();
      if (const auto* point = std::get_if<PointLightDescription>(&d.geometry)) {
        addLight(PointLight{scene_->normalisation.point(point->position),
                            radiance(point->intensity, intensityScale())},
                 d.name, "point");
      } else if (const auto* spot = std::get_if<SpotLightDescription>(&d.geometry)) {
        addLight(SpotLight{scene_->normalisation.point(spot->position), Vec3(glm::normalize(spot->direction)),
                           radiance(spot->intensity, intensityScale()),
                           static_cast<float>(std::cos(spot->innerDegrees * kPiD / 180.0)),
                           static_cast<float>(std::cos(spot->outerDegrees * kPiD / 180.0))},
                 d.name, "spot");
      } else if (const auto* sun = std::get_if<DirectionalLightDescription>(&d.geometry)) {
        addLight(DirectionalLight{Vec3(-glm::normalize(sun->direction)), radiance(sun->irradiance),
                                  std::cos(0.5 * sun->angleDegrees * kPiD / 180.0)},
                 d.name, "directional");
      } else if (const auto* sky = std::get_if<EnvironmentLightDescription>(&d.geometry)) {
        addLight(compileSky(*sky), d.name, "environment");
      } else if (const auto* volume = std::get_if<VolumicSphereLightDescription>(&d.geometry)) {
        VolumicSphereLight light;
        light.intensity = radiance(volume->intensity, intensityScale() / volume->points);
        const Vec3 centre = scene_->normalisation.point(volume->center);
        const float radius = scene_->normalisation.length(volume->radius);
        const RandomKey key =
            randomKey(0x766f6c756d696300ULL);  // "volumic": the scene's own, whatever the seed is
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(volume->points); ++i) {
          watch_.piece(i);
          // Uniform in the ball: the radius goes with the cube root of its share of the volume.
          const float z = 1.0f - 2.0f * uniform(key, i, 0);
          const float phi = kTwoPi * uniform(key, i, 1);
          const float r = radius * std::cbrt(uniform(key, i, 2));
          const float s = std::sqrt(std::max(0.0f, 1.0f - z * z));
          light.points.push_back(centre + r * Vec3(s * std::cos(phi), s * std::sin(phi), z));
        }
        addLight(std::move(light), d.name, "volumic");
      }
    }
  }

  Expected<void> compileCameras() {
    for (const CameraDescription& d : in_.cameras) {
      const std::string name = d.name.empty() ? "camera" : "camera '" + d.name + "'";
      const auto camera = compileCamera(scene_->normalisation, d, in_.path.string() + ": " + name);
      if (!camera) return tl::unexpected(camera.error());
      scene_->cameras.push_back(*camera);
      scene_->cameraNames.push_back(d.name);
    }
    return {};
  }

  void workOutBounds() {
    for (const TriangleMesh& mesh : scene_->meshes) {
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        watch_.piece(i);
        scene_->bounds.add(mesh.positions[i]);
      }
    }
    for (const SphereShape& s : scene_->spheres) {
      scene_->bounds.add(s.center - Vec3(s.radius));
      scene_->bounds.add(s.center + Vec3(s.radius));
    }
    for (const DiscShape& d : scene_->discs) {
      scene_->bounds.add(d.center - Vec3(d.radius));
      scene_->bounds.add(d.center + Vec3(d.radius));
    }
    scene_->diagonal = scene_->bounds.diagonal();
  }

  void mirrorLights() {
    for (std::uint32_t m = 0; m < scene_->planarMirrors.size(); ++m) {
      watch_.look();
      for (std::uint32_t l = 0; l < scene_->lights.size(); ++l) {
        const auto* light = std::get_if<AreaLight>(&scene_->lights[l]);
        // Of a light with a pattern the mirror would show another part from every place.
        if (light == nullptr || light->pattern || light->pieceCount() > kMaxMirroredPieces) continue;
        for (const bool front : {true, false}) {
          std::optional<AreaLight> image = mirrorImage(*light, scene_->planarMirrors[m], front);
          if (!image) continue;
          if (scene_->mirroredLights.size() == kMaxMirroredLights) {
            scene_->mirroredLights.clear();
            return;
          }
          scene_->mirroredLights.push_back({l, m, front, Light(std::move(*image))});
        }
      }
    }
  }

  /// The light as the mirror shows it; nothing where no part of it stands on the side that is looked at: a
  /// light is seen in a mirror from the side on which it stands itself.
  static std::optional<AreaLight> mirrorImage(AreaLight image, const PlanarMirror& mirror, bool front) {
    const float offset = glm::dot(mirror.normal, mirror.outline.front());
    const float side = front ? 1.0f : -1.0f;
    const auto height = [&](const Vec3& p) { return glm::dot(mirror.normal, p) - offset; };
    const auto reflect = [&](const Vec3& p) { return p - 2.0f * height(p) * mirror.normal; };
    const auto turn = [&](const Vec3& n) { return n - 2.0f * glm::dot(mirror.normal, n) * mirror.normal; };
    bool reaches = false;
    for (EmitterTriangle& t : image.triangles) {
      reaches = reaches || std::max({side * height(t.a), side * height(t.b), side * height(t.c)}) > 0.0f;
      // A reflection turns the winding: swap two corners to keep the front side in front.
      t = {reflect(t.a), reflect(t.c), reflect(t.b), turn(t.normal), t.area};
    }
    for (EmitterSphere& s : image.spheres) {
      reaches = reaches || side * height(s.center) + s.radius > 0.0f;
      s.center = reflect(s.center);
    }
    for (EmitterDisc& d : image.discs) {
      reaches = reaches || side * height(d.center) + d.radius > 0.0f;
      d.center = reflect(d.center);
      d.normal = turn(d.normal);
    }
    for (Vec3& v : image.polygon) v = reflect(v);
    std::reverse(image.polygon.begin(), image.polygon.end());
    if (!reaches) return std::nullopt;
    image.finish();
    return image;
  }

  void workOutNeeds() {
    SceneNeeds& needs = scene_->needs;
    for (const Surface& surface : scene_->surfaces) {
      const Material& material = scene_->materials[surface.material];
      const Brdf& brdf = material.brdf;
      needs.specular = needs.specular || brdf.hasSpecular();
      needs.glass = needs.glass || brdf.isGlass();
      needs.panes = needs.panes || material.isPane();
      needs.lobes = needs.lobes || brdf.hasLobe();
      needs.diffuse = needs.diffuse || brdf.hasDiffuse();
      needs.anisotropy = needs.anisotropy || brdf.isAnisotropic();
      needs.textures = needs.textures || material.isTinted || material.textures.emission ||
                       material.opacity.texture.has_value();
    }
    bool hasDirac = false;
    for (const Light& light : scene_->lights) {
      needs.areaLights = needs.areaLights || std::holds_alternative<AreaLight>(light);
      needs.infiniteLights = needs.infiniteLights || std::holds_alternative<DirectionalLight>(light) ||
                             std::holds_alternative<EnvironmentLight>(light);
      hasDirac = hasDirac || isDirac(light);
    }
    for (const auto* meshes : {&scene_->meshes, &scene_->sharedMeshes}) {
      for (const TriangleMesh& mesh : *meshes)
        needs.smoothNormals = needs.smoothNormals || !mesh.normals.empty();
    }
    needs.analyticShapes = !scene_->spheres.empty() || !scene_->discs.empty();
    warnOfBrushingWithoutDirection();
    needs.missingCaustics = hasDirac && needs.specular;
    if (needs.missingCaustics) {
      scene_->warnings.emplace_back(
          "light of point-like lights by way of mirrors or glass (caustics) is found by no method here and "
          "is missing");
    }
    if (scene_->lights.empty()) scene_->warnings.emplace_back("the scene has no light: its picture is black");
  }

  void warnOfBrushingWithoutDirection() {
    std::set<std::uint32_t> told;
    for (const Surface& surface : scene_->surfaces) {
      const Material& material = scene_->materials[surface.material];
      const auto* mesh = std::get_if<MeshDescription>(&in_.shapes[surface.shape].geometry);
      if (!material.brdf.isAnisotropic() || material.hasTangent ||
          (mesh != nullptr && !mesh->geometry->uvs.empty()) || !told.insert(surface.material).second) {
        continue;
      }
      scene_->warnings.push_back(
          fmt::format("the material '{}' has isotropy below 1, and no tangent for a shape without texture "
                      "coordinates: its brushing goes any way",
                      material.name));
    }
  }

  const SceneDescription& in_;
  EnergyRule rule_;
  LoadWatch& watch_;
  std::unique_ptr<SharedMeshes> shared_;  // once lengths are normalised
  std::shared_ptr<Scene> scene_ = [] {
    auto scene = std::make_shared<Scene>();
    scene->meshes.emplace_back();  // all flat shapes
    return scene;
  }();
  TriangleMesh mappedFaces_;  // flat shapes with texture coordinates
  std::map<std::string, std::uint32_t> lightIndices_;
  std::map<std::uint32_t, std::vector<std::vector<Vec3>>> outlines_;
  std::set<std::size_t> lackingUvs_;  // shapes whose textures have no texture coordinates
  /// The texture of an area light's emission, and where the light's triangles lie on it.
  struct EmissionTexture {
    std::optional<TextureUse> use;
    std::vector<EmissionPattern::Corners> corners;
  };
  std::vector<EmissionTexture> emissionTextures_;                                      // for each area light
  std::map<std::size_t, std::unique_ptr<const PictureBrightness>> pictureBrightness_;  // by texture
  std::size_t droppedTriangles_ = 0;
};

}  // namespace

float Camera::pixelWidth(float depth) const {
  const auto pixels = static_cast<float>(height);
  return isOrthographic() ? 2.0f * halfHeight / pixels : depth * (2.0f * tanHalfFovY / pixels);
}

Sight Camera::sight(float x, float y, const Vec2& onLens) const {
  const float scale = pixelWidth(1.0f);
  const float px = (x - 0.5f * static_cast<float>(width)) * scale;
  const float py = (0.5f * static_cast<float>(height) - y) * scale;
  if (isOrthographic()) return {position + px * right + py * up, forward};
  const Vec3 throughCentre = forward + px * right + py * up;
  if (!hasLens()) return {position, glm::normalize(throughCentre)};
  // A thin lens bends all light from a place in the plane of focus to one point of the picture.
  const Vec3 aside = lensRadius * (onLens.x * right + onLens.y * up);
  return {position + aside, glm::normalize(focusDistance * throughCentre - aside)};
}

namespace {

double roundedToDigits(double value) {
  // Through text, so that what is written and what is computed with are one number.
  return std::stod(fmt::format("{:.12g}", value));
}
Vec3d roundedToDigits(const Vec3d& v) {
  return {roundedToDigits(v.x), roundedToDigits(v.y), roundedToDigits(v.z)};
}

// A camera's lengths in a scene that is about 1 large. What is a thousand million times smaller is nothing to
// single precision, which tells places of that scene apart down to 1e-7; as much larger, its square is still
// far from overflow.
constexpr float kLeastCameraLength = 1e-9f, kLargestCameraLength = 1e9f;

Expected<float> compileLength(const Normalisation& normalisation, double sceneLength, const char* what,
                              const std::string& where) {
  const float length = normalisation.length(sceneLength);
  if (length >= kLeastCameraLength && length <= kLargestCameraLength) return length;
  return makeError(where, fmt::format("{} must be above 0, and within a factor of 1e9 of the scene's size, "
                                      "found {:g}",
                                      what, sceneLength));
}

Expected<Vec3> compilePosition(const Normalisation& normalisation, const Vec3d& scenePoint,
                               const std::string& where) {
  const Vec3 position = normalisation.point(scenePoint);
  if (glm::length(Vec3d(position)) <= double{kLargestCameraLength}) return position;
  return makeError(
      where,
      fmt::format("position must be no farther from the scene than 1e9 times its size, found {:g} away from "
                  "a scene of about {:g}",
                  glm::length(scenePoint - normalisation.centre), normalisation.sceneLength(1.0)));
}

Expected<void> compileProjection(const Normalisation& normalisation, const CameraDescription& d,
                                 const std::string& where, Camera& camera) {
  camera.projection = d.projection;
  if (!(d.lensRadius >= 0.0)) return makeError(where, "lens_radius must not be below 0");
  if (camera.isOrthographic()) {
    if (d.lensRadius > 0.0) return makeError(where, "an orthographic camera has no lens");
    const auto height = compileLength(normalisation, d.orthographicHeight, "height", where);
    if (!height) return tl::unexpected(height.error());
    camera.halfHeight = 0.5f * *height;
    return {};
  }
  if (!(d.fovYDegrees > 0.0 && d.fovYDegrees < 180.0))
    return makeError(where, "fov_y must lie between 0 and 180 degrees");
  camera.tanHalfFovY = static_cast<float>(std::tan(0.5 * d.fovYDegrees * kPiD / 180.0));
  if (!(d.lensRadius > 0.0)) return {};
  const auto radius = compileLength(normalisation, d.lensRadius, "lens_radius", where);
  if (!radius) return tl::unexpected(radius.error());
  const auto focus = compileLength(normalisation, d.resolvedFocusDistance(), "focus_distance", where);
  if (!focus) return tl::unexpected(focus.error());
  camera.lensRadius = *radius;
  camera.focusDistance = *focus;
  return {};
}

}  // namespace

Expected<Camera> compileCamera(const Normalisation& normalisation, const CameraDescription& d,
                               const std::string& where) {
  const Vec3d forward = d.target - d.position;
  const Vec3d right = glm::cross(forward, d.up);
  if (!isFinite(d.position) || !isFinite(forward) || !isFinite(d.up)) {
    return makeError(where, "a coordinate is not a finite number");
  }
  const double forwardLength = glm::length(forward);
  const double rightLength = glm::length(right);
  if (!(forwardLength > 0.0)) return makeError(where, "position and target are the same point");
  if (!(rightLength > 1e-9 * forwardLength * glm::length(d.up))) {
    return makeError(where, "up points along the view", "choose another up");
  }
  if (d.width < 1 || d.height < 1) return makeError(where, "the resolution must be positive");
  Camera camera;
  if (auto done = compileProjection(normalisation, d, where, camera); !done)
    return tl::unexpected(done.error());
  const auto position = compilePosition(normalisation, d.position, where);
  if (!position) return tl::unexpected(position.error());
  camera.position = *position;
  const Vec3d f = forward / forwardLength;
  const Vec3d r = right / rightLength;
  camera.forward = Vec3(f);
  camera.right = Vec3(r);
  camera.up = Vec3(glm::cross(r, f));
  camera.width = d.width;
  camera.height = d.height;
  camera.exposureStops = d.exposureStops;
  return camera;
}

CameraDescription describeCamera(const Normalisation& normalisation, const Camera& camera) {
  CameraDescription d;
  d.position = roundedToDigits(normalisation.scenePoint(camera.position));
  // Far enough for the digits of the target to leave all that single precision has of the direction.
  const double distance = std::max(normalisation.sceneLength(1.0), glm::length(d.position));
  d.target = roundedToDigits(d.position + distance * Vec3d(camera.forward));
  d.up = roundedToDigits(Vec3d(camera.up));
  const auto length = [&](float normalised) {
    return roundedToDigits(normalisation.sceneLength(static_cast<double>(normalised)));
  };
  d.projection = camera.projection;
  if (camera.isOrthographic()) {
    d.orthographicHeight = length(2.0f * camera.halfHeight);
  } else {
    d.fovYDegrees = roundedToDigits(2.0 * std::atan(static_cast<double>(camera.tanHalfFovY)) * 180.0 / kPiD);
  }
  if (camera.hasLens()) {
    d.lensRadius = length(camera.lensRadius);
    // The target says no more than a direction here.
    d.focusDistance = length(camera.focusDistance);
  }
  d.width = camera.width;
  d.height = camera.height;
  d.exposureStops = camera.exposureStops;
  return d;
}

std::optional<Vec3> Camera::project(const Vec3& point) const {
  const Vec3 seen = point - position;
  const float depth = glm::dot(seen, forward);
  if (!(depth > 0.0f)) return std::nullopt;
  const float scale = 1.0f / pixelWidth(depth);
  return Vec3(0.5f * static_cast<float>(width) + glm::dot(seen, right) * scale,
              0.5f * static_cast<float>(height) - glm::dot(seen, up) * scale, depth);
}

Vec3 Camera::eyeOf(const Vec3& point) const {
  return isOrthographic() ? point - glm::dot(point - position, forward) * forward : position;
}

float Camera::distanceTo(const Vec3& point) const {
  const Vec3 seen = point - position;
  return isOrthographic() ? glm::dot(seen, forward) : glm::length(seen);
}

std::size_t Scene::triangleCount() const {
  std::size_t count = 0;
  for (const TriangleMesh& mesh : meshes) count += mesh.triangles.size();
  for (const MeshInstance& instance : instances) count += sharedMeshes[instance.mesh].triangles.size();
  return count;
}

namespace {

void dim(Light& light, const Rgb& factor) {
  std::visit(
      [&](auto& source) {
        if constexpr (requires { source.intensity; }) {
          source.intensity *= factor;
        } else if constexpr (requires { source.irradiance; }) {
          source.irradiance *= factor;
        } else {
          source.radiance *= factor;
        }
      },
      light);
}

}  // namespace

std::shared_ptr<const Scene> Scene::relit(std::span<const Rgb> factors) const {
  LV_CHECK(factors.size() == lights.size(), "{} factors for {} lights", factors.size(), lights.size());
  auto scene = std::make_shared<Scene>(*this);
  for (std::size_t light = 0; light < lights.size(); ++light) dim(scene->lights[light], factors[light]);
  scene->lightTree.relight(scene->lights);
  for (MirroredLight& mirrored : scene->mirroredLights) dim(mirrored.image, factors[mirrored.light]);
  if (scene->lightFactors.empty()) scene->lightFactors.assign(lights.size(), Rgb(1.0f));
  for (std::size_t light = 0; light < lights.size(); ++light) scene->lightFactors[light] *= factors[light];
  return scene;
}

Rgb Scene::textureColor(const TextureUse& use, const Vec3& position, const Vec2& uv) const {
  return placedColor(textures[use.texture], use, normalisation, position, uv);
}

double Scene::metresPerNormalisedUnit() const {
  return metresPerUnit * std::ldexp(1.0, normalisation.lengthExponent);
}

Expected<std::shared_ptr<const Scene>> Scene::compile(const SceneDescription& description, EnergyRule rule,
                                                      LoadWatch& watch) {
  return untilStopped([&] { return Compiler(description, rule, watch).run(); });
}

}  // namespace lightvane
