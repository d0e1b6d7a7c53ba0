#pragma once

#include <vector>

#include "tests/support/element_mesh.h"
#include "tests/support/polygon_scene.h"

namespace lightvane {

/// Irradiance, in W/m² a channel, by where it comes from.
struct IrradianceParts {
  Vec3d direct;    ///< straight from the emitters: exact
  Vec3d indirect;  ///< all that was reflected at least once

  Vec3d total() const { return direct + indirect; }
};

/// How finely the oracle computes; RadiositySolution tells the error of the defaults.
struct RadiositySettings {
  double elementSize = 0.12;  ///< longest extent of an element, as a fraction of the scene's diagonal
  double creaseSize = 0.015;  ///< width of elements along creases, as a fraction of the scene's diagonal
  int solveRays = 1024;       ///< from each node
  int gatherRays = 1 << 16;   ///< from each point that is asked for
};

/// The light of a scene of diffuse polygons, in double precision, by a method that is not the renderer's.
///
/// Indirect irradiance E(x) is a linear function on each element of each surface, determined by
///     E(x_i) = mean over rays from node x_i of  rho(y) (direct(y) + E(y)),   y what the ray meets,
/// with direct(y) computed exactly at every y, so that shadow edges are as sharp as the rays are dense, and
/// only the smoother rest interpolated. Rays are points of a Fibonacci lattice on the unit disk, lifted to
/// the hemisphere (cosine weights without variance); the linear system is solved by Gauss-Seidel to rounding.
/// A point that is asked for is gathered in the same way with more rays, so that its error is that of E
/// weighted by reflectances.
///
/// Error at the defaults, measured in the Cornell box, in parts of its mean indirect irradiance: over 51
/// places, some of them 8 mm from where three surfaces meet, rms 0.0005 and at most 0.0015, against elements
/// three times finer and four times the rays; the mean itself 0.00015; energy balances within 0.00023. Closer
/// to such a corner than half a creaseSize (7 mm there) expect more. It takes 2.5 s to solve and 35 ms a
/// point. tests/support_tests/radiosity_test.cpp repeats what is quick of this.
///
/// Nothing is random and nothing depends on time: same input, same bytes.
class RadiositySolution {
 public:
  /// Solves the scene. Memory: up to 32 bytes for each pair of a node and an element.
  explicit RadiositySolution(PolygonScene scene, const RadiositySettings& settings = {});

  const PolygonScene& scene() const { return scene_; }

  /// Irradiance at any point in space, on a surface or not, of an element with that unit normal. A point on a
  /// surface must not lie on its rim, where irradiance is not defined. Cost: gatherRays rays.
  IrradianceParts irradianceAt(const Vec3d& point, const Vec3d& normal) const;

  /// Mean indirect irradiance over a polygon's front, from the nodes.
  Vec3d meanIndirect(std::size_t polygon) const;
  /// Mean indirect irradiance over the fronts of all polygons.
  Vec3d meanIndirect() const;

 private:
  // One side of a polygon: its elements are those of the polygon's mesh, counted on from firstElement.
  struct Side {
    bool reflects = false;
    std::size_t firstElement = 0;
  };
  struct Node {
    Vec3d point, normal;
    std::size_t polygon;
    Vec3d indirect{0.0};
  };
  // How much the nodes of an element count for the irradiance at another node.
  struct Coupling {
    std::size_t element;
    std::array<double, ElementMesh::kNodes> weights;
  };

  const Side& sideOf(const PolygonScene::Hit& hit) const {
    return sides_[2 * hit.polygon + (hit.front ? 0 : 1)];
  }
  // Calls visit(hit, normal) for what each ray over the hemisphere meets, where that reflects.
  template <class Visit>
  void forEachReflector(const Vec3d& point, const Vec3d& normal, const std::vector<Vec3d>& directions,
                        double turn, const Visit& visit) const;
  void solve(int rays);

  PolygonScene scene_;
  std::vector<ElementMesh> meshes_;
  std::vector<Side> sides_;  // two for each polygon: front, back
  std::vector<Node> nodes_;
  std::vector<Vec3d> gatherDirections_;
};

}  // namespace lightvane
