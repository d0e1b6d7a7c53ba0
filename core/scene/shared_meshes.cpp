#include "core/scene/shared_meshes.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lightvane {
namespace {

/// What a ray's way into an instance's coordinates and back may cost in digits: products of the norms of a
/// transform and of its inverse, 3 for what keeps angles.
constexpr double kMostDistortion = 12.0;

/// Of an instance, in the scene's: the inverse of its transform must be far from overflow, and so must the
/// products of that which Embree goes by. Places of the scene are told apart down to 1e-7.
constexpr double kLeastSize = 1e-9;

double norm(const glm::dmat3& m) {
  return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

/// The linear part of what moves points.
template <class Place>
glm::dmat3 linearPart(const Place& place, const Vec3d& origin, double length) {
  const Vec3d moved = place(origin);
  glm::dmat3 linear;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d step(0.0);
    step[axis] = length;
    linear[axis] = place(origin + step) - moved;
  }
  return linear;
}

/// Without what it moves by.
glm::dmat3 linearPart(const Transform& transform) {
  return linearPart([&](const Vec3d& p) { return transform.point(p); }, Vec3d(0.0), 1.0);
}

bool isEven(const Transform& transform) {
  const glm::dmat3 linear = linearPart(transform);
  const double determinant = glm::determinant(linear);
  if (!std::isfinite(determinant) || determinant == 0.0) return false;
  return norm(linear) * norm(glm::inverse(linear)) <= kMostDistortion;
}

bool mayShare(const SceneDescription& scene, const ShapeDescription& shape, const MeshDescription& mesh) {
  if (mesh.geometry->triangles.size() < SharedMeshes::kFewestTriangles) return false;
  const auto emits = [&](std::size_t material) { return scene.materials[material].emits(); };
  const bool isLight = mesh.bringsMaterials()
                           ? std::any_of(mesh.materials.begin(), mesh.materials.end(), emits)
                           : emits(shape.material);
  return !isLight && isEven(Transform(shape.transform, mesh.placement));
}

/// Leaves those shapes that are large enough to be seen.
void dropTiny(const SceneDescription& scene, const Normalisation& normalisation, const MeshGeometry& geometry,
              std::vector<std::size_t>& shapes) {
  const double diagonal = boundsOf<Vec3d>(geometry.positions).diagonal();
  const double toNormalised = std::ldexp(1.0, -normalisation.lengthExponent);
  std::erase_if(shapes, [&](std::size_t i) {
    const auto& mesh = std::get<MeshDescription>(scene.shapes[i].geometry);
    const Transform transform(scene.shapes[i].transform, mesh.placement);
    return !(norm(linearPart(transform)) * diagonal * toNormalised >= kLeastSize);
  });
}

TriangleMesh compileMesh(const MeshGeometry& geometry, bool bringsMaterials, LoadWatch& watch,
                         SharedMeshes::Mesh& mesh) {
  const BoundsD bounds = boundsOf<Vec3d>(geometry.positions);
  mesh.centre = bounds.centre();
  std::frexp(bounds.diagonal(), &mesh.lengthExponent);
  const double scale = std::ldexp(1.0, -mesh.lengthExponent);
  TriangleMesh compiled;
  compiled.positions.reserve(geometry.positions.size());
  for (const Vec3d& position : geometry.positions) {
    watch.piece(compiled.positions.size());
    compiled.positions.emplace_back((position - mesh.centre) * scale);
  }
  mesh.bounds = boundsOf<Vec3>(compiled.positions);
  mesh.reach = maxComponent(glm::max(glm::abs(mesh.bounds.lower), glm::abs(mesh.bounds.upper)));
  compiled.normals.assign(geometry.normals.begin(), geometry.normals.end());
  compiled.colors = geometry.colors;
  compiled.uvs = geometry.uvs;
  std::map<std::uint32_t, std::uint32_t> surfaceOf;
  for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
    watch.piece(t);
    const std::uint32_t material = bringsMaterials ? geometry.triangleMaterials[t] : 0;
    const auto [surface, isNew] =
        surfaceOf.try_emplace(material, static_cast<std::uint32_t>(surfaceOf.size()));
    if (isNew) mesh.materials.push_back(material);
    const glm::uvec3& corners = geometry.triangles[t];
    if (!(glm::length(doubleArea(compiled, corners)) > 0.0)) {
      ++mesh.dropped;
      continue;
    }
    compiled.triangles.push_back(corners);
    compiled.surfaces.push_back(surface->second);
    compiled.pieces.push_back(kNone);
  }
  return compiled;
}

}  // namespace

SharedMeshes::SharedMeshes(const SceneDescription& scene, const Normalisation& normalisation,
                           LoadWatch& watch)
    : scene_(scene), watch_(watch), isShared_(scene.shapes.size()) {
  std::map<const MeshGeometry*, std::vector<std::size_t>> shapesOf;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const auto* mesh = std::get_if<MeshDescription>(&scene.shapes[i].geometry);
    if (mesh != nullptr && mayShare(scene, scene.shapes[i], *mesh))
      shapesOf[mesh->geometry.get()].push_back(i);
  }
  for (auto& [geometry, shapes] : shapesOf) {
    watch_.look();
    if (shapes.size() > 1) dropTiny(scene, normalisation, *geometry, shapes);
    for (const std::size_t shape : shapes) isShared_[shape] = shapes.size() > 1;
  }
}

const SharedMeshes::Mesh& SharedMeshes::meshOf(std::size_t shape, const std::vector<Material>& materials,
                                               std::vector<TriangleMesh>& meshes) {
  const auto& placed = std::get<MeshDescription>(scene_.shapes[shape].geometry);
  std::vector<bool> panes;
  for (const std::uint32_t material : placed.materials) panes.push_back(materials[material].isPane());
  if (!placed.bringsMaterials()) panes = {materials[scene_.shapes[shape].material].isPane()};
  const auto [entry, isNew] =
      meshes_.try_emplace({placed.geometry.get(), placed.bringsMaterials(), std::move(panes)});
  if (isNew) {
    entry->second.index = static_cast<std::uint32_t>(meshes.size());
    meshes.push_back(compileMesh(*placed.geometry, placed.bringsMaterials(), watch_, entry->second));
  }
  return entry->second;
}

MeshInstance placeInstance(const SharedMeshes::Mesh& mesh, const Transform& transform,
                           const Normalisation& normalisation) {
  const double toNormalised = std::ldexp(1.0, -normalisation.lengthExponent);
  const auto place = [&](const Vec3d& p) {
    return (transform.point(p) - normalisation.centre) * toNormalised;
  };
  const glm::dmat3 linear = linearPart(place, mesh.centre, std::ldexp(1.0, mesh.lengthExponent));
  MeshInstance instance;
  instance.mesh = mesh.index;
  instance.linear = glm::mat3(linear);
  instance.offset = Vec3(place(mesh.centre));
  // Scaled to about 1, since the cofactors of small transforms are far smaller still.
  instance.ofNormals = glm::mat3(normalMatrix(linear * (1.0 / norm(linear))));
  instance.mirrors = transform.flips();
  const glm::mat3 sizes(glm::abs(instance.linear[0]), glm::abs(instance.linear[1]),
                        glm::abs(instance.linear[2]));
  instance.reach = maxComponent(sizes * Vec3(mesh.reach) + glm::abs(instance.offset));
  return instance;
}

}  // namespace lightvane
