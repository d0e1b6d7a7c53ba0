#include "tests/bench/instances.h"

#include <cmath>
#include <cstdlib>
#include <memory>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "core/base/random.h"
#include "core/trace/tracer.h"
#include "tests/bench/measure.h"
#include "tests/support/grid_mesh.h"

namespace lightvane {
namespace {

constexpr std::uint32_t kBalls = 400;
constexpr std::uint32_t kRays = 400'000;

MeshGeometry ball(std::uint32_t rings) {
  MeshGeometry mesh;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    for (std::uint32_t j = 0; j <= rings; ++j) {
      const double theta = kPiD * (i + 0.5) / (rings + 1), phi = 2.0 * kPiD * (j % rings) / rings;
      mesh.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                  std::sin(theta) * std::sin(phi));
    }
  }
  mesh.triangles = test::gridTriangles(rings, rings);
  return mesh;
}

Vec3d inCube(RandomKey key, std::uint32_t i, std::uint32_t dimension) {
  return {uniform(key, i, dimension), uniform(key, i, dimension + 1), uniform(key, i, dimension + 2)};
}

std::unique_ptr<const Tracer> room(std::uint32_t rings, bool isShared) {
  SceneDescription description;
  description.cameras.emplace_back();
  description.materials.emplace_back().diffuse = Rgb(0.5f);
  const auto mesh = std::make_shared<const MeshGeometry>(ball(rings));
  const RandomKey key = randomKey(1);
  for (std::uint32_t i = 0; i < kBalls; ++i) {
    glm::dmat4 placement = glm::translate(glm::dmat4(1.0), inCube(key, i, 0));
    placement = glm::rotate(placement, 6.0 * inCube(key, i, 3).x, glm::normalize(inCube(key, i, 6) + 0.1));
    placement = glm::scale(placement, Vec3d(0.01 + 0.05 * inCube(key, i, 9).x));
    ShapeDescription shape;
    shape.geometry =
        MeshDescription{"", isShared ? mesh : std::make_shared<const MeshGeometry>(*mesh), {}, placement};
    description.shapes.push_back(std::move(shape));
  }
  const auto scene = Scene::compile(description);
  if (!scene) {
    fmt::print(stderr, "{}\n", scene.error().message());
    std::exit(2);
  }
  return std::make_unique<const Tracer>(*scene);
}

/// Of rays from place to place in the room.
double secondsOfRays(const Tracer& tracer) {
  const RandomKey key = randomKey(2);
  const double begun = threadCpuSeconds();
  for (std::uint32_t i = 0; i < kRays; i += kPacketWidth) {
    HitPacket packet;
    for (std::uint32_t lane = 0; lane < kPacketWidth; ++lane) {
      const Vec3 from(inCube(key, i + lane, 0) - 0.5), to(inCube(key, i + lane, 3) - 0.5);
      packet.rays.set(static_cast<int>(lane), {from, glm::normalize(to - from), 0.0f, kInfinity});
    }
    tracer.intersect(packet, kPacketWidth, Coherence::Incoherent);
  }
  return threadCpuSeconds() - begun;
}

}  // namespace

std::string instancesTable(int rounds) {
  std::string text = fmt::format(
      "### Meshes that shapes share: {} balls in a room\n\n"
      "| triangles of a ball | instances | a ray, times that among copies | memory of copies, MB | of "
      "instances |\n|--:|--:|--:|--:|--:|\n",
      kBalls);
  for (const std::uint32_t rings : {12U, 24U, 40U, 80U}) {
    const auto shared = room(rings, true), copied = room(rings, false);
    const std::vector<Samples> seconds =
        inTurn(rounds, std::vector<std::function<double()>>{[&] { return secondsOfRays(*shared); },
                                                            [&] { return secondsOfRays(*copied); }});
    text += fmt::format("| {} | {} | {} | {:.1f} | {:.1f} |\n", 2 * rings * rings,
                        shared->scene().instances.size(), withSpread(ratio(seconds[0], seconds[1]), 2),
                        static_cast<double>(copied->memoryBytes()) * 1e-6,
                        static_cast<double>(shared->memoryBytes()) * 1e-6);
  }
  return text;
}

}  // namespace lightvane
