#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/math.h"

namespace lightvane {

/// A flat, convex piece of a diffuse scene, for the radiosity oracle.
///
/// `vertices` are in metres, counter-clockwise seen from the front. The front emits `emission` (radiance, in
/// W/(m² sr), equal in all directions) and reflects `reflectance` (Lambertian, 0 to 1 a channel). The back
/// emits nothing and is black unless `twoSided`. Both sides block light.
struct DiffusePolygon {
  std::string name;
  std::vector<Vec3d> vertices;
  Vec3d reflectance{0.0};
  Vec3d emission{0.0};
  bool twoSided = false;
};

/// A few tens of diffuse polygons with exact visibility in double precision: the geometry below the oracle.
///
/// Everything is a loop over all polygons. It has nothing in common with the renderer's Scene, on purpose.
class PolygonScene {
 public:
  struct Hit {
    std::size_t polygon;
    bool front;
    Vec3d point;
  };

  /// Throws InvariantViolation for a polygon that is not planar, not convex, has no area, or has a colour
  /// that is negative or not finite.
  explicit PolygonScene(std::vector<DiffusePolygon> polygons);

  const std::vector<DiffusePolygon>& polygons() const { return polygons_; }
  /// Index of the polygon called `name`; throws InvariantViolation if there is none.
  std::size_t indexOf(const std::string& name) const;
  /// Unit normal of the front side.
  const Vec3d& normal(std::size_t polygon) const { return shapes_[polygon].normal; }
  double area(std::size_t polygon) const { return shapes_[polygon].area; }
  Vec3d centroid(std::size_t polygon) const;
  /// Diagonal of the bounding box, in metres.
  double diagonal() const { return diagonal_; }
  /// Distances below this count as zero, in metres.
  double epsilon() const { return 1e-9 * diagonal_; }
  /// Signed distance of a point from a polygon's plane, positive in front, in metres.
  double height(std::size_t polygon, const Vec3d& point) const;
  /// Whether a point lies on the polygon, its rim included, within `tolerance` metres.
  bool contains(std::size_t polygon, const Vec3d& point, double tolerance) const;

  /// What a ray with unit `direction` meets first, nearer than epsilon() excepted.
  std::optional<Hit> nearestHit(const Vec3d& origin, const Vec3d& direction) const;

  /// The form factor from a surface element to the part of a polygon's front that it sees: the
  /// cosine-weighted share of the hemisphere about `normal` (a unit vector), 0 to 1.
  ///
  /// Exact but for rounding: what other polygons hide is cut away by their shadow pyramids, and each
  /// remaining convex piece is given by Lambert's formula (Baum, Rushmeier & Winget, "Improving Radiosity
  /// Solutions Through the Use of Analytically Determined Form-Factors", SIGGRAPH 1989, eq. 9).
  double visibleFormFactor(const Vec3d& point, const Vec3d& normal, std::size_t polygon) const;

  /// Irradiance straight from the emitters, in W/m²; exact like visibleFormFactor.
  Vec3d directIrradiance(const Vec3d& point, const Vec3d& normal) const;

 private:
  struct Shape {
    Vec3d normal;
    double offset;  // normal · x of every point x of the plane
    double area;
    std::vector<Vec3d> inward;  // in the plane, one for each edge, unit, towards the inside
    std::vector<double> inwardOffset;
  };
  // How an occluder lies with respect to an emitter, to leave out pairs that cannot matter.
  struct Relation {
    double emitterLow, emitterHigh;    // heights of the emitter's vertices over the occluder's plane
    double occluderLow, occluderHigh;  // heights of the occluder's vertices over the emitter's plane
  };

  Relation relate(std::size_t emitter, std::size_t occluder) const;

  std::vector<DiffusePolygon> polygons_;
  std::vector<Shape> shapes_;
  std::vector<Relation> relations_;  // [emitter * count + occluder]
  std::vector<std::size_t> emitters_;
  double diagonal_ = 0.0;
};

}  // namespace lightvane
