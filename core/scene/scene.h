#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/base/math.h"
#include "core/scene/brdf.h"
#include "core/scene/description.h"
#include "core/scene/light_tree.h"
#include "core/scene/lights.h"
#include "core/scene/normalisation.h"
#include "core/scene/scene_needs.h"
#include "core/scene/texture.h"

namespace lightvane {

/// What a primitive belongs to.
struct Surface {
  std::uint32_t material = 0;
  std::uint32_t shape = 0;             ///< index into SceneDescription::shapes
  std::uint32_t light = kNone;         ///< index into Scene::lights, where the surface emits
  std::uint32_t planarMirror = kNone;  ///< index into Scene::planarMirrors, where it is one
};

/// A planar face that reflects specularly. Lights seen in one are sampled as lights behind it, because rays
/// that meet a small bright light by chance make splotches.
struct PlanarMirror {
  std::vector<Vec3> outline;  ///< convex, in order
  std::vector<Vec3> inwards;  ///< for each side of the outline, the one from that corner on: in the plane
  Vec3 normal;                ///< unit, front side
  std::uint32_t surface;
};

/// The image of an area light in a planar mirror: an area light of its own, visible through the mirror's
/// outline only.
struct MirroredLight {
  std::uint32_t light;   ///< index into Scene::lights
  std::uint32_t mirror;  ///< index into Scene::planarMirrors
  bool frontSide;        ///< seen from the mirror's front side (a mirror reflects on both)
  Light image;           ///< the area light's reflection in the mirror's plane
};

/// Triangles of one shape or of many polygons together. normals, colors and uvs are empty or one for each
/// position.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Rgb> colors;
  std::vector<Vec2> uvs;
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> surfaces;  ///< for each triangle
  /// For each triangle its number in its area light; kNone where it is no piece of one: it emits nothing, or
  /// all that its texture leaves of the emission is black.
  std::vector<std::uint32_t> pieces;
};
/// Twice the area of a triangle of the mesh, along the normal of its front; zero where it has none. In
/// double, as those of small triangles are nothing in float.
inline Vec3d doubleArea(const TriangleMesh& mesh, const glm::uvec3& corners) {
  const Vec3d a(mesh.positions[corners.x]);
  return glm::cross(Vec3d(mesh.positions[corners.y]) - a, Vec3d(mesh.positions[corners.z]) - a);
}

/// Where a shape puts a mesh that it shares with others, which has coordinates of its own: some of about 1.
struct MeshInstance {
  std::uint32_t mesh = 0;          ///< index into Scene::sharedMeshes
  std::uint32_t firstSurface = 0;  ///< what the mesh's surfaces count from
  glm::mat3 linear{1.0f};          ///< from the mesh's coordinates into normalised units ...
  Vec3 offset{0.0f};               ///< ... and what is added to that
  glm::mat3 ofNormals{1.0f};       ///< moves normals, whose length it changes
  bool mirrors = false;            ///< turns the mesh's surfaces inside out: their front sides stay in front
  float reach = 0.0f;              ///< the largest coordinate that places go through on the way

  Vec3 place(const Vec3& position) const { return linear * position + offset; }
};

struct SphereShape {
  Vec3 center;
  float radius;
  std::uint32_t surface;
  std::uint32_t piece;
};
struct DiscShape {
  Vec3 center;
  Vec3 normal;
  float radius;
  std::uint32_t surface;
  std::uint32_t piece;
};

/// A material as the renderer uses it. ILV trees go by the keys.
struct Material {
  std::string name;
  Brdf brdf;
  Rgb emission{0.0f};  ///< normalised radiance; where it has a texture, what that is multiplied by
  bool twoSided = false;
  bool hasTangent = false;
  bool isTinted = false;  ///< its colours differ from place to place: by textures, or by those of a mesh
  Vec3 tangent{1, 0, 0};
  MaterialTextures textures;
  OpacityDescription opacity;
  /// Equal for materials with the same BRDF, textures apart: what these do is left out of vectors.
  std::uint32_t brdfKey = 0;

  /// Shadow rays do not end at it: they ask what it lets pass.
  bool isPane() const { return brdf.isThin() || !opacity.isFull(); }
};

/// A line of sight: where it begins, and its unit direction.
struct Sight {
  Vec3 origin;
  Vec3 direction;
};

/// A camera in normalised units: a pinhole, a thin lens, or orthographic. Pixel (0, 0) is at the top left.
struct Camera {
  Vec3 position{0.0f};
  Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< orthonormal
  float tanHalfFovY = 1.0f;                             ///< 1 where orthographic
  int width = 0;
  int height = 0;
  double exposureStops = 0.0;
  Projection projection = Projection::Perspective;
  float halfHeight = 0.0f;  ///< of what an orthographic picture shows; 0 where perspective
  float lensRadius = 0.0f;  ///< 0: a pinhole. An orthographic camera has no lens
  /// Of the plane in which a lens makes all sharp, along the viewing axis; 0 without a lens.
  float focusDistance = 0.0f;

  bool isOrthographic() const { return projection == Projection::Orthographic; }
  bool hasLens() const { return lensRadius > 0.0f; }

  /// What is seen at a point of the picture, x to the right and y downwards, in pixels, by way of a place on
  /// the lens, in the unit disc: along `right` and `up`. The default is the lens's centre. Orthographic lines
  /// of sight begin in the plane of `position`.
  Sight sight(float x, float y, const Vec2& onLens = Vec2(0.0f)) const;
  /// Where the picture shows a point, in pixels, and its distance along the viewing axis as z; nothing for
  /// what is not in front of the camera. Of a lens, what is seen by way of its centre: the middle of the
  /// point's blur.
  std::optional<Vec3> project(const Vec3& point) const;
  /// Where the line of sight begins that leads to a point; of a lens, the one by way of its centre.
  Vec3 eyeOf(const Vec3& point) const;
  /// How far a point is from there, as film depth has it; negative behind an orthographic camera.
  float distanceTo(const Vec3& point) const;
  /// The width of a pixel at this distance along the viewing axis.
  float pixelWidth(float depth) const;
  /// What tolerances for what an eye tells apart at this distance are parts of: the distance itself, or,
  /// since an orthographic camera stands as far away as it pleases, the height of its picture.
  float eyeScale(float distance) const { return isOrthographic() ? 2.0f * halfHeight : distance; }

  bool operator==(const Camera&) const = default;
};

/// The camera that a description means in a scene of this normalisation. Errors begin with `where`.
Expected<Camera> compileCamera(const Normalisation& normalisation, const CameraDescription& description,
                               const std::string& where);

/// A camera in the scene's own units, rounded to twelve digits so that a file or a command line has it word
/// for word: whoever renders by hand of it compiles it again.
CameraDescription describeCamera(const Normalisation& normalisation, const Camera& camera);

/// A scene ready to be rendered: immutable, in normalised units, shared by all threads.
class Scene {
 public:
  /// Works out the normalisation, the lights and what the scene needs. Refuses non-finite coordinates and
  /// degenerate cameras with a message; drops triangles without area, and says how many in `warnings`. Where
  /// `watch` stops it, the error has isStop.
  static Expected<std::shared_ptr<const Scene>> compile(const SceneDescription& description,
                                                        EnergyRule rule = EnergyRule::Refined,
                                                        LoadWatch& watch = LoadWatch::none());

  /// The same scene with the radiance of each light multiplied, colour by colour; factors are finite and not
  /// negative. Everything keeps its number. Cost: a copy of the scene.
  std::shared_ptr<const Scene> relit(std::span<const Rgb> factors) const;

  std::string name;
  std::string hash;
  double metresPerUnit = 1.0;  ///< of the scene's units
  Normalisation normalisation;
  float diagonal = 0.0f;  ///< of the bounds, normalised units
  Bounds bounds;

  std::vector<TriangleMesh> meshes;
  std::vector<TriangleMesh> sharedMeshes;  ///< in coordinates of their own; seen where instances put them
  std::vector<MeshInstance> instances;
  std::vector<SphereShape> spheres;
  std::vector<DiscShape> discs;
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Light> lights;
  LightTree lightTree;  ///< over them
  std::vector<std::string> lightNames;
  std::vector<Rgb>
      lightFactors;  ///< of `relit`, one for each light: what materials emit is to be multiplied too
  std::vector<PlanarMirror> planarMirrors;
  std::vector<MirroredLight> mirroredLights;
  std::vector<std::string> shapeNames;
  std::vector<Camera> cameras;
  std::vector<std::string> cameraNames;
  SceneNeeds needs;
  std::vector<std::string> warnings;

  const Material& materialOf(std::uint32_t surface) const { return materials[surfaces[surface].material]; }
  /// The texture's colour at a place in normalised units and at texture coordinates.
  Rgb textureColor(const TextureUse& use, const Vec3& position, const Vec2& uv) const;
  /// Of all that can be seen: what is shared counts wherever it is.
  std::size_t triangleCount() const;
  /// Metres in one normalised unit.
  double metresPerNormalisedUnit() const;
};

}  // namespace lightvane
