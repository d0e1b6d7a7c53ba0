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
#include "core/scene/lights.h"
#include "core/scene/scene_needs.h"
#include "core/scene/texture.h"

namespace lightvane {

inline constexpr std::uint32_t kNone = 0xffffffffU;

/// How the scene's own numbers become the renderer's: lengths so that the scene fits a box of about 1 around
/// the origin, radiances so that the brightest is about 1. Both factors are powers of two, so that scaling a
/// scene by a power of two changes no bit of what is computed.
struct Normalisation {
  Vec3d centre{0.0};         ///< in scene units
  int lengthExponent = 0;    ///< scene units = centre + normalised * 2^lengthExponent
  int radianceExponent = 0;  ///< W m^-2 sr^-1 = normalised * 2^radianceExponent

  Vec3 point(const Vec3d& scenePoint) const;
  float length(double sceneLength) const;
  Vec3d scenePoint(const Vec3& normalised) const;
  double sceneLength(double normalised) const;
  float radianceScale() const;  ///< 2^radianceExponent
};

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

/// Triangles of one shape or of many polygons together. normals and uvs are empty or one for each position.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> surfaces;  ///< for each triangle
  std::vector<std::uint32_t> pieces;    ///< for each triangle: its number in its area light, or kNone
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
  Rgb emission{0.0f};  ///< normalised radiance
  bool twoSided = false;
  bool hasTangent = false;
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
  std::vector<SphereShape> spheres;
  std::vector<DiscShape> discs;
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Light> lights;
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
  std::size_t triangleCount() const;
  /// Metres in one normalised unit.
  double metresPerNormalisedUnit() const;
};

}  // namespace lightvane
