#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/base/color.h"
#include "core/base/math.h"
#include "core/scene/environment.h"
#include "core/scene/spherical.h"

namespace lightvane {

class EmissionPattern;

/// The number of nothing: of what has no light, piece or the like.
inline constexpr std::uint32_t kNone = 0xffffffffU;

// Light sources, compiled: normalised units, float. Everything that sends light straight to a point.

/// One emitting piece of an area light.
struct EmitterTriangle {
  Vec3 a, b, c;  ///< front side by the right-hand rule
  Vec3 normal;   ///< unit
  float area;
};
struct EmitterSphere {
  Vec3 center;
  float radius;
};
struct EmitterDisc {
  Vec3 center;
  Vec3 normal;  ///< unit
  float radius;
};

struct PointLight {
  Vec3 position;
  Rgb intensity;
};
struct SpotLight {
  Vec3 position;
  Vec3 direction;  ///< unit, into the scene
  Rgb intensity;
  float cosInner, cosOuter;  ///< smoothstep of the cosine between them
};
struct DirectionalLight {
  Vec3 toLight;         ///< unit
  Rgb irradiance;       ///< on a facing surface
  double cosHalfAngle;  ///< 1 for a Dirac; the radiance is constant within. Double, as 1 - cos is what counts
};
struct VolumicSphereLight {
  std::vector<Vec3> points;
  Rgb intensity;  ///< of each point
};
/// One or more emitting shapes that count as one source.
struct AreaLight {
  std::vector<EmitterTriangle> triangles;
  std::vector<EmitterSphere> spheres;
  std::vector<EmitterDisc> discs;
  Rgb radiance;
  bool twoSided = false;
  /// What a texture leaves of the radiance from place to place; null where it is the same everywhere.
  std::shared_ptr<const EmissionPattern> pattern;
  /// The planar, convex outline of a light that is a single polygon, in order; empty otherwise. Lets one
  /// solid-angle map serve the whole light, which keeps the samples stratified across its triangles.
  std::vector<Vec3> polygon;
  /// Over triangles, spheres, discs in this order; ends at 1; empty without area. Pieces count by their area,
  /// with a pattern by that times its brightness on them. Double, so that small pieces of a light of very
  /// many keep their share.
  std::vector<double> areaCdf;
  double totalArea = 0.0;

  /// What all of the light lies in; for irradianceBound.
  Vec3 boundCenter{0.0f};
  float boundRadius = 0.0f;
  /// Everything lies in (nearly) one plane and emits to the side of `planeNormal` (to both, if twoSided).
  bool planar = false;
  Vec3 planeNormal{0.0f};
  /// Where `polygon` has four corners and its sides are orthogonal: sampled by the map for spherical
  /// rectangles.
  std::optional<RectangleSides> rectangle;

  /// Works out everything from areaCdf on from the pieces, the pattern and the polygon. To be called once,
  /// after they are set and before the light is used.
  void finish();

  std::size_t pieceCount() const { return triangles.size() + spheres.size() + discs.size(); }
};

using Light =
    std::variant<PointLight, SpotLight, DirectionalLight, VolumicSphereLight, AreaLight, EnvironmentLight>;

/// One direction from which a light reaches a point, if nothing stands between.
struct LightSample {
  Vec3 direction{0.0f};   ///< unit, from the point to the light
  float distance = 0.0f;  ///< normalised units; infinity for directional lights and the sky
  /// What the sample stands for, W m^-2 on a surface that faces it: radiance (where the light is met) /
  /// density for lights with an extent, the irradiance itself for Dirac lights. Add f * cos * weight over the
  /// samples and divide by their number.
  Rgb weight{0.0f};
  float pdf = 0.0f;  ///< density over solid angle, sr^-1; 0 for Dirac lights
};

/// Samples of a light side by side.
struct LightSampleBatch {
  static constexpr int kCount = SphericalSampleBatch::kCount;

  SphericalSampleBatch places;  ///< in: u and v, all of them set; out: LightSample's direction and distance
  Rgb weight[kCount];           ///< LightSample::weight
  float pdf[kCount];            ///< LightSample::pdf
  bool reached[kCount];         ///< what LightSampler::sample says, false beyond the last one

  /// All but `reached`.
  void set(int i, const LightSample& sample) {
    places.directionX[i] = sample.direction.x;
    places.directionY[i] = sample.direction.y;
    places.directionZ[i] = sample.direction.z;
    places.distance[i] = sample.distance;
    weight[i] = sample.weight;
    pdf[i] = sample.pdf;
  }
  LightSample at(int i) const {
    return {Vec3(places.directionX[i], places.directionY[i], places.directionZ[i]), places.distance[i],
            weight[i], pdf[i]};
  }
};

/// A light prepared for many samples at one point: solid angles, edges and angles are worked out once.
///
/// Lives on the stack (some kB, mostly untouched), allocates nothing, and refers to `light`, which must
/// outlive it. Area lights are sampled uniformly in solid angle: a rectangle and a convex polygon of at most
/// kMaxPieces + 2 corners by one map of the whole, spheres by their cone, other lights of at most kMaxPieces
/// pieces piece by piece, chosen by solid angle. Discs are within a factor of 2 of uniform (SphericalDisc).
/// Of a light with more pieces one is chosen by area (and brightness, see AreaLight::areaCdf) and then
/// sampled by solid angle. A pattern changes no other density: samples carry what it is where they meet the
/// light. u.x is stretched to choose a piece, so strata stay strata. Immutable; any thread.
class LightSampler {
 public:
  static constexpr std::size_t kMaxPieces = 16;

  /// `normal`, unit, is that of a surface at the point, which only the sky is sampled by; where it is zero,
  /// no surface is assumed. Cost: linear in the pieces up to kMaxPieces, constant beyond.
  LightSampler(const Light& light, const Vec3& point, const Vec3& normal = Vec3(0.0f));
  /// Would outlive its light: a temporary, or a `Light` made on the way from an AreaLight.
  LightSampler(Light&& light, const Vec3& point, const Vec3& normal = Vec3(0.0f)) = delete;

  /// See sampleLight.
  bool sample(const Vec2& u, LightSample& sample) const;
  /// The same for the first `count` of a batch, to the bit. Cost: of a rectangle, a third of one by one.
  void sample(int count, LightSampleBatch& batch) const;

  /// The density of sample(), sr^-1, where a ray in unit `direction` meets piece `piece` of the area light.
  /// Pieces are numbered triangles first, then spheres, then discs. 0 for Dirac and infinite lights, for
  /// pieces whose emitting side is turned away, for points in a piece's plane, and for kNone: what is no
  /// piece is never sampled. Bit for bit LightSample::pdf at a sample's direction.
  float pdf(const Vec3& direction, std::uint32_t piece) const;

  /// The sum of the solid angles of all pieces that emit towards the point, sr; 0 for Dirac lights, and for
  /// the sky what the surface sees of it. Pieces that hide each other are all counted. Discs: to 1e-3. Cost:
  /// linear in all pieces of a light with more than kMaxPieces.
  float solidAngle() const;
  /// How large the light looks, sr: solidAngle() of lights with up to kMaxPieces; of one with more, the solid
  /// angle of the ball around it. Cost: constant.
  float apparentSize() const;
  /// Whether the light has more than kMaxPieces, none of which is prepared.
  bool isByArea() const { return byArea_; }

 private:
  using Map =
      std::variant<std::monostate, SphericalRectangle, SphericalTriangle, SphericalCap, SphericalDisc>;

  // The map of one piece and its solid angle; monostate and 0 where it cannot reach the point.
  double preparePiece(std::size_t piece, Map& map) const;
  void preparePolygon();
  Map& newMap(std::size_t slot) { return *std::construct_at(&maps_[slot]); }
  void add(std::size_t slot, double pieceSolidAngle);
  bool sampleArea(const Vec2& u, LightSample& sample) const;

  const Light& light_;
  const AreaLight* area_ = nullptr;  // the light, if it is one
  Vec3 point_;
  Vec3 normal_;
  bool byArea_ = false;  // more than kMaxPieces pieces: nothing is prepared
  std::size_t slots_ = 0;
  double total_ = 0.0;  // of the slots' solid angles
  std::array<double, kMaxPieces> cumulative_;
  // Of slots below slots_, and the first of a sun. In a union because as a member it would be cleared, 3 kB
  // for every vertex of a path.
  union {
    std::array<Map, kMaxPieces> maps_;
  };
};

/// A sample of `light` as seen from `point`; no surface at the point is assumed. False where the light cannot
/// reach it (behind a one-sided light, in its plane, outside a spot's cone) or the sample meets it where its
/// pattern is black; that counts as a sample of zero.
/// `u` in [0, 1)^2, stratified by the caller. Convenience for a single sample: use LightSampler for several.
bool sampleLight(const Light& light, const Vec3& point, const Vec2& u, LightSample& sample);

/// One sample of `light` from each of the first `count` points, with places u and v of its own: to the bit
/// what LightSampler(light, point, normal).sample gives. Cost: of a rectangle, a fifth of one by one.
void sampleFromEach(const Light& light, int count, const SphericalPointBatch& points,
                    std::span<const Vec3> normals, LightSampleBatch& batch);

/// The density with which sampleLight would choose `direction` from `point`, where a ray that way meets piece
/// `piece` of the area light at `distance`, under `cosAtLight` (absolute). Pieces are numbered triangles
/// first, then spheres, then discs. 0 for Dirac lights. Distance and cosine are what a map by area would ask
/// for; none of the present maps does.
float lightPdf(const Light& light, const Vec3& point, const Vec3& direction, std::uint32_t piece,
               float distance, float cosAtLight);

/// The density with which the direction `direction` is chosen for a light at infinity (directional with an
/// angle, or the sky) by a LightSampler with this normal; 0 for all others and outside a sun's cone.
float lightPdfAtInfinity(const Light& light, const Vec3& direction, const Vec3& normal = Vec3(0.0f));
/// Radiance that arrives along a ray that leaves the scene in `direction` (a sun's disc, the sky); black for
/// all others.
Rgb radianceFromInfinity(const Light& light, const Vec3& direction);

/// Lights that a ray of no extent cannot meet: point, spot, volumic sphere, directional without an angle.
bool isDirac(const Light& light);

/// An upper bound of the irradiance, in the strongest colour component, that `light` can give a surface of
/// any orientation at `point` if nothing stands between: for choosing among lights. Never zero where the
/// light can reach the point. Cost: constant, but linear in the points of a volumic sphere.
float irradianceBound(const Light& light, const Vec3& point);

/// How much a surface with this unit normal may get of the light, for choosing among lights: the bound times
/// the greatest cosine under which any of the light is seen. 0 where all of it is below the horizon, and
/// never where it can reach the surface.
float lightImportance(const Light& light, const Vec3& point, const Vec3& normal);

/// The greatest cosine with a normal of a direction within the angle of this sine and cosine about a
/// direction whose own cosine with the normal is `towards`.
inline float greatestCosineInCone(float towards, float sine, float cosine) {
  if (towards >= cosine) return 1.0f;
  return towards * cosine + std::sqrt(std::max(0.0f, 1.0f - square(towards))) * sine;
}

/// Radiant power in W, all colours' luminance: for statistics and for choosing among many lights. Of a light
/// with a pattern to a few percent, at the cost of EmissionPattern::meanColor. Directional
/// lights give their irradiance times `sceneRadius`^2 pi, the sky what goes through the sphere of that
/// radius.
float lightPower(const Light& light, float sceneRadius);

/// The number of independent samples a source has to offer: 1 for a Dirac, the number of points for a volumic
/// sphere, 0 for no limit.
int distinctSamples(const Light& light);

}  // namespace lightvane
