#pragma once

#include "core/base/random.h"
#include "core/io/archive.h"
#include "core/vectors/records.h"

namespace lightvane {

// What light vectors consist of, for core/io/archive.h. The structured bindings name every field: a new one
// does not compile until it has its place here, and a new place is a new version of the file format.

template <class Archive>
void visitFields(Archive& archive, RandomKey& key) {
  auto& [high, low] = key;
  archive(high, low);
}

template <class Archive>
void visitFields(Archive& archive, Birth& birth) {
  auto& [pass, order, pixel, rays, identity, throughSpecular] = birth;
  archive(pass, order, pixel, rays, identity, throughSpecular);
}

template <class Archive>
void visitFields(Archive& archive, VectorPoint& point) {
  auto& [position, normal, tangent, outgoing, key, footprint] = point;
  archive(position, normal, tangent, outgoing, key, footprint);
}

template <class Archive>
void visitFields(Archive& archive, DirectLightVector& vector) {
  auto& [point, direction, solidAngle, energy, lobeRadiance, occluded, birth] = vector;
  archive(point, direction, solidAngle, energy, lobeRadiance, occluded, birth);
}

template <class Archive>
void visitFields(Archive& archive, IndirectLightVector& vector) {
  auto& [point, direction, energy, irradiance, gradient, rotation, arithmeticMean, harmonicMean,
         leastDistance, lobeWidth, birth] = vector;
  archive(point, direction, energy, irradiance, gradient, rotation, arithmeticMean, harmonicMean,
          leastDistance, lobeWidth, birth);
}

}  // namespace lightvane
