#pragma once

#include <limits>
#include <random>

#include "tests/io/io_support.h"

namespace lightvane::test {

/// Vectors with any bits in every field, NaN and infinity among them, but for a place in the box.
class RandomVectors {
 public:
  explicit RandomVectors(unsigned seed) : random_(seed) {}

  IndirectLightVector indirect() {
    IndirectLightVector v;
    fill(v.point);
    for (Vec3* part : {&v.direction, &v.energy, &v.irradiance, &v.gradient[0], &v.gradient[1], &v.gradient[2],
                       &v.rotation[0], &v.rotation[1], &v.rotation[2]}) {
      fill(*part);
    }
    for (float* part : {&v.arithmeticMean, &v.harmonicMean, &v.leastDistance, &v.lobeWidth}) *part = number();
    fill(v.birth);
    return v;
  }
  DirectLightVector direct() {
    DirectLightVector v;
    fill(v.point);
    for (Vec3* part : {&v.direction, &v.energy, &v.lobeRadiance}) fill(*part);
    v.solidAngle = number();
    v.occluded = bits() % 2 == 0;
    fill(v.birth);
    return v;
  }
  /// `count` vectors of each kind, for each light of the Cornell box.
  Snapshot snapshot(std::size_t count) {
    Snapshot result;
    result.generation = 7;
    const auto radius = [](const auto&) { return 0.1f; };
    std::vector<IndirectLightVector> ilvs;
    for (std::size_t i = 0; i < count; ++i) ilvs.push_back(indirect());
    result.indirect = RecordSet<IndirectLightVector>().with(ilvs, radius);
    for (std::size_t light = 0; light < cornellScene().scene->lights.size(); ++light) {
      std::vector<DirectLightVector> dlvs;
      for (std::size_t i = 0; i < count; ++i) dlvs.push_back(direct());
      result.direct.push_back(RecordSet<DirectLightVector>().with(dlvs, radius));
    }
    return result;
  }

  float number() {
    constexpr float kSpecial[] = {0.0f,
                                  -0.0f,
                                  1e-42f,
                                  std::numeric_limits<float>::quiet_NaN(),
                                  -std::numeric_limits<float>::quiet_NaN(),
                                  kInfinity,
                                  -kInfinity};
    const std::uint32_t chosen = bits() % 16;
    return chosen < std::size(kSpecial) ? kSpecial[chosen] : std::bit_cast<float>(bits());
  }

 private:
  std::uint32_t bits() { return static_cast<std::uint32_t>(random_()); }
  void fill(Vec3& v) { v = {number(), number(), number()}; }
  void fill(VectorPoint& p) {
    for (int i = 0; i < 3; ++i) p.position[i] = static_cast<float>(bits() >> 8) * 0x1p-24f - 0.5f;
    for (Vec3* part : {&p.normal, &p.tangent, &p.outgoing}) fill(*part);
    p.key = bits() % 4;
    p.footprint = number();
  }
  void fill(Birth& b) { b = {bits(), bits(), bits(), bits(), {bits(), bits()}, bits() % 2 == 0}; }

  std::mt19937 random_;  // its numbers are the standard's, on every machine
};

}  // namespace lightvane::test
