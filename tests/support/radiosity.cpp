#include "tests/support/radiosity.h"

#include <algorithm>

#include "core/base/check.h"

namespace lightvane {
namespace {

constexpr std::size_t kNodes = ElementMesh::kNodes;

// Directions over the hemisphere about z, distributed like the cosine: a Fibonacci lattice on the disk (Vogel
// 1979), lifted to the sphere.
std::vector<Vec3d> cosineDirections(int count) {
  const double goldenAngle = kPiD * (3.0 - std::sqrt(5.0));
  std::vector<Vec3d> directions;
  directions.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double radiusSquared = (i + 0.5) / count;
    const double radius = std::sqrt(radiusSquared);
    directions.push_back({radius * std::cos(goldenAngle * i), radius * std::sin(goldenAngle * i),
                          std::sqrt(1.0 - radiusSquared)});
  }
  return directions;
}

// A different turn of the lattice for each node, so that their errors do not add up: multiples of the inverse
// of the plastic number, which fill the circle evenly (Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences").
double latticeTurn(std::size_t node) {
  const double turns = static_cast<double>(node) * 0.7548776662466927;
  return 2.0 * kPiD * (turns - std::floor(turns));
}

}  // namespace

RadiositySolution::RadiositySolution(PolygonScene scene, const RadiositySettings& settings)
    : scene_(std::move(scene)), gatherDirections_(cosineDirections(settings.gatherRays)) {
  const ElementMesh::Sizes sizes{settings.elementSize * scene_.diagonal(),
                                 settings.creaseSize * scene_.diagonal()};
  for (std::size_t polygon = 0; polygon < scene_.polygons().size(); ++polygon) {
    meshes_.emplace_back(scene_, polygon, sizes);
    const ElementMesh& mesh = meshes_.back();
    for (const bool front : {true, false}) {
      const bool reflects = front || scene_.polygons()[polygon].twoSided;
      sides_.push_back({reflects, nodes_.size() / kNodes});
      if (!reflects) continue;
      const Vec3d normal = front ? scene_.normal(polygon) : -scene_.normal(polygon);
      for (std::size_t element = 0; element < mesh.elements().size(); ++element) {
        for (std::size_t k = 0; k < kNodes; ++k) nodes_.push_back({mesh.node(element, k), normal, polygon});
      }
    }
  }
  solve(settings.solveRays);
}

template <class Visit>
void RadiositySolution::forEachReflector(const Vec3d& point, const Vec3d& normal,
                                         const std::vector<Vec3d>& directions, double turn,
                                         const Visit& visit) const {
  // Any tangent does: the axis that is farthest from the normal, made perpendicular.
  const Vec3d size = glm::abs(normal);
  const Vec3d axis = size.x <= size.y && size.x <= size.z ? Vec3d(1, 0, 0)
                     : size.y <= size.z                   ? Vec3d(0, 1, 0)
                                                          : Vec3d(0, 0, 1);
  const Vec3d tangent = glm::normalize(glm::cross(normal, axis));
  const Vec3d bitangent = glm::cross(normal, tangent);
  const Vec3d x = std::cos(turn) * tangent + std::sin(turn) * bitangent;
  const Vec3d y = glm::cross(normal, x);
  for (const Vec3d& local : directions) {
    const auto hit = scene_.nearestHit(point, local.x * x + local.y * y + local.z * normal);
    if (!hit || !sideOf(*hit).reflects || scene_.polygons()[hit->polygon].reflectance == Vec3d(0.0)) continue;
    visit(*hit, hit->front ? scene_.normal(hit->polygon) : -scene_.normal(hit->polygon));
  }
}

void RadiositySolution::solve(int rays) {
  const std::vector<Vec3d> directions = cosineDirections(rays);
  const double share = 1.0 / rays;
  const std::size_t elementCount = nodes_.size() / kNodes;
  std::vector<std::vector<Coupling>> couplings(nodes_.size());
  std::vector<Vec3d> firstBounce(nodes_.size(), Vec3d(0.0));
  std::vector<std::array<double, kNodes>> row(elementCount);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    std::fill(row.begin(), row.end(), std::array<double, kNodes>{});
    forEachReflector(nodes_[i].point, nodes_[i].normal, directions, latticeTurn(i),
                     [&](const PolygonScene::Hit& hit, const Vec3d& normal) {
                       const Vec3d& reflectance = scene_.polygons()[hit.polygon].reflectance;
                       firstBounce[i] += reflectance * scene_.directIrradiance(hit.point, normal) * share;
                       const ElementMesh& mesh = meshes_[hit.polygon];
                       const std::size_t element = mesh.find(hit.point);
                       const auto weights = mesh.weights(element, hit.point);
                       auto& sums = row[sideOf(hit).firstElement + element];
                       for (std::size_t k = 0; k < kNodes; ++k) sums[k] += weights[k] * share;
                     });
    for (std::size_t element = 0; element < elementCount; ++element) {
      if (row[element] != std::array<double, kNodes>{}) couplings[i].push_back({element, row[element]});
    }
  }

  // Gauss-Seidel. A row sums to at most the share of rays that meet something, so it converges where some
  // light is lost; each sweep takes off about the mean reflectance.
  constexpr int kMaxSweeps = 10000;
  double change = 1.0, largest = 0.0;
  for (int sweep = 0; change > 1e-14 * largest || sweep == 0; ++sweep) {
    LV_CHECK(sweep < kMaxSweeps, "radiosity changes by {} of {} after {} sweeps: does nothing absorb?",
             change, largest, sweep);
    change = largest = 0.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Vec3d sum = firstBounce[i];
      for (const Coupling& coupling : couplings[i]) {
        const Node* from = &nodes_[coupling.element * kNodes];
        Vec3d gathered(0.0);
        for (std::size_t k = 0; k < kNodes; ++k) gathered += coupling.weights[k] * from[k].indirect;
        sum += scene_.polygons()[from->polygon].reflectance * gathered;
      }
      const Vec3d difference = glm::abs(sum - nodes_[i].indirect);
      change = std::max({change, difference.x, difference.y, difference.z});
      largest = std::max({largest, sum.x, sum.y, sum.z});
      nodes_[i].indirect = sum;
    }
  }
}

IrradianceParts RadiositySolution::irradianceAt(const Vec3d& point, const Vec3d& normal) const {
  Vec3d sum(0.0);
  forEachReflector(point, normal, gatherDirections_, 0.0,
                   [&](const PolygonScene::Hit& hit, const Vec3d& facing) {
                     const std::size_t element = meshes_[hit.polygon].find(hit.point);
                     const auto weights = meshes_[hit.polygon].weights(element, hit.point);
                     const Node* from = &nodes_[(sideOf(hit).firstElement + element) * kNodes];
                     Vec3d received = scene_.directIrradiance(hit.point, facing);
                     for (std::size_t k = 0; k < kNodes; ++k) received += weights[k] * from[k].indirect;
                     sum += scene_.polygons()[hit.polygon].reflectance * received;
                   });
  return {scene_.directIrradiance(point, normal), sum / static_cast<double>(gatherDirections_.size())};
}

Vec3d RadiositySolution::meanIndirect(std::size_t polygon) const {
  const std::vector<ElementMesh::Element>& elements = meshes_[polygon].elements();
  Vec3d sum(0.0);
  for (std::size_t element = 0; element < elements.size(); ++element) {
    const Node* nodes = &nodes_[(sides_[2 * polygon].firstElement + element) * kNodes];
    for (std::size_t k = 0; k < kNodes; ++k) sum += nodes[k].indirect * (elements[element].area / kNodes);
  }
  return sum / scene_.area(polygon);
}

Vec3d RadiositySolution::meanIndirect() const {
  Vec3d sum(0.0);
  double area = 0.0;
  for (std::size_t polygon = 0; polygon < meshes_.size(); ++polygon) {
    sum += meanIndirect(polygon) * scene_.area(polygon);
    area += scene_.area(polygon);
  }
  return sum / area;
}

}  // namespace lightvane
