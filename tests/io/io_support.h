#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/io/cache_file.h"
#include "core/scene/load_scene.h"
#include "tests/support/temporary_folder.h"

namespace lightvane::test {

/// assets/scenes/cornell.toml, compiled once.
struct CornellScene {
  SceneDescription description;
  std::shared_ptr<const Scene> scene;
};
inline const CornellScene& cornellScene() {
  static const CornellScene cornell = [] {
    CornellScene made;
    made.description = loadScene(LIGHTVANE_SOURCE_DIR "/assets/scenes/cornell.toml").value();
    made.scene = Scene::compile(made.description).value();
    return made;
  }();
  return cornell;
}

/// What a program that renders the Cornell box writes into its files.
inline CacheIdentity identityOf(const Parameters& parameters) {
  CacheIdentity identity;
  identity.sceneHash = sceneHash(cornellScene().description, HashScope::Lighting);
  for (const FieldDescription& row : describeParameters(parameters)) {
    identity.parameters[row.field.key] = row.value;
  }
  identity.view = "camera 48x48";
  return identity;
}

/// Every number of a vector by its bits, written out here again so that one that the files forget is missed.
using Bits = std::vector<std::uint32_t>;

inline void addBits(Bits& bits, float x) { bits.push_back(std::bit_cast<std::uint32_t>(x)); }
inline void addBits(Bits& bits, const Vec3& v) {
  for (int i = 0; i < 3; ++i) addBits(bits, v[i]);
}
inline void addBits(Bits& bits, const VectorPoint& p) {
  for (const Vec3& v : {p.position, p.normal, p.tangent, p.outgoing}) addBits(bits, v);
  bits.push_back(p.key);
  addBits(bits, p.footprint);
}
inline void addBits(Bits& bits, const Birth& b) {
  bits.insert(bits.end(),
              {b.pass, b.order, b.pixel, b.rays, b.identity.high, b.identity.low, b.throughSpecular});
}
inline Bits bitsOf(const DirectLightVector& v) {
  Bits bits;
  addBits(bits, v.point);
  addBits(bits, v.direction);
  addBits(bits, v.solidAngle);
  addBits(bits, v.energy);
  addBits(bits, v.lobeRadiance);
  bits.push_back(v.occluded);
  addBits(bits, v.birth);
  return bits;
}
inline Bits bitsOf(const IndirectLightVector& v) {
  Bits bits;
  addBits(bits, v.point);
  for (const Vec3& part : {v.direction, v.energy, v.irradiance, v.gradient[0], v.gradient[1], v.gradient[2],
                           v.rotation[0], v.rotation[1], v.rotation[2]}) {
    addBits(bits, part);
  }
  for (const float part : {v.arithmeticMean, v.harmonicMean, v.leastDistance, v.lobeWidth})
    addBits(bits, part);
  addBits(bits, v.birth);
  return bits;
}
template <class Record>
std::vector<Bits> bitsOf(const RecordSet<Record>& set) {
  std::vector<Bits> all;
  for (std::size_t i = 0; i < set.size(); ++i) all.push_back(bitsOf(set[i]));
  return all;
}
inline std::vector<std::vector<Bits>> bitsOf(const Snapshot& snapshot) {
  std::vector<std::vector<Bits>> all{bitsOf(snapshot.indirect)};
  for (const auto& direct : snapshot.direct) all.push_back(bitsOf(direct));
  return all;
}

}  // namespace lightvane::test
