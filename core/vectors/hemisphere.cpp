#include <cmath>

#include "core/vectors/gather.h"

// What a sampled hemisphere says by itself: means, irradiance, direction, gradients. Symbols of the paper: M
// rows in theta, N columns in phi, L_i a cell's radiance, R its distance.

namespace lightvane {

MeanDistances meanDistances(const Hemisphere& hemisphere) {
  double sum = 0.0;
  double inverseSum = 0.0;
  std::size_t hits = 0;
  MeanDistances means;
  for (const GatherCell& cell : hemisphere.cells) {
    if (!(cell.distance < kInfinity)) continue;
    ++hits;
    sum += cell.distance;
    inverseSum += 1.0 / std::max(cell.distance, 1e-30f);
    means.least = std::min(means.least, cell.distance);
  }
  if (hits > 0) {
    means.arithmetic = static_cast<float>(sum / static_cast<double>(hits));
    means.harmonic = static_cast<float>(static_cast<double>(hits) / inverseSum);
  }
  return means;
}

Rgb hemisphereIrradiance(const Hemisphere& hemisphere) {
  // In double: in float the sum of 8192 cells is off by 2e-4 already.
  glm::dvec3 sum(0.0);
  for (const GatherCell& cell : hemisphere.cells) sum += glm::dvec3(cell.radiance * cell.direction.z);
  return {sum * (2.0 * kPiD / static_cast<double>(hemisphere.cells.size()))};
}

Vec3 hemisphereDirection(const Hemisphere& hemisphere) {
  Vec3 sum(0.0f);
  for (const GatherCell& cell : hemisphere.cells) {
    sum += paperBrightness(cell.radiance) * cell.direction.z * cell.direction;
  }
  const float length = glm::length(sum);
  return length > 0.0f ? sum / length : Vec3(0, 0, 1);
}

IrradianceGradient printedGradient(const Hemisphere& hemisphere) {
  IrradianceGradient gradient;
  const float scale = kTwoPi / static_cast<float>(hemisphere.cells.size());
  for (const GatherCell& cell : hemisphere.cells) {
    if (!(cell.distance < kInfinity)) continue;
    const Vec3& d = cell.direction;
    const float sinTheta = std::sqrt(d.x * d.x + d.y * d.y);
    // d theta / d(x, y, z) = (-cos theta cos phi, -cos theta sin phi, sin theta) / R
    const Vec3 change =
        sinTheta > 0.0f ? Vec3(-d.z * d.x / sinTheta, -d.z * d.y / sinTheta, sinTheta) : Vec3(-d.z, 0, 0);
    for (int c = 0; c < 3; ++c) {
      gradient.translation[c] += (-cell.radiance[c] * sinTheta * scale / cell.distance) * change;
    }
  }
  return gradient;
}

namespace {

/// Whether something is there, and not so near that its distance is rounding: a point in an edge meets the
/// other face at 0, whose gradient would be 0/0.
bool isWall(float distance) { return distance > 0x1p-24f && distance < kInfinity; }

}  // namespace

IrradianceGradient stratifiedGradient(const Hemisphere& hemisphere) {
  IrradianceGradient gradient;
  const int rows = hemisphere.rows;
  const int columns = hemisphere.columns;
  const auto rowCount = static_cast<float>(rows);
  const float columnAngle = kTwoPi / static_cast<float>(columns);
  const float cellScale = columnAngle / rowCount;  // a cell's solid angle
  const auto cosBoundary = [&](int row) { return 1.0f - static_cast<float>(row) / rowCount; };
  const auto sinBoundary = [&](int row) {
    return std::sqrt(std::max(0.0f, 1.0f - square(cosBoundary(row))));
  };
  for (int k = 0; k < columns; ++k) {
    const float middle = (static_cast<float>(k) + 0.5f) * columnAngle;
    const float wall = static_cast<float>(k) * columnAngle;
    const Vec3 u(std::cos(middle), std::sin(middle), 0.0f);  // outwards along the column
    const Vec3 v(-std::sin(wall), std::cos(wall), 0.0f);     // across the wall to the column before
    const int before = (k + columns - 1) % columns;
    for (int j = 0; j < rows; ++j) {
      const GatherCell& cell = hemisphere.cell(j, k);
      if (j > 0) {
        // The wall between rows j-1 and j: moving by dx turns it by cos(theta)/R, over 2 pi sin(theta) / N of
        // azimuth, and its light counts by cos(theta).
        const GatherCell& inner = hemisphere.cell(j - 1, k);
        const float nearest = std::min(cell.distance, inner.distance);
        if (isWall(nearest)) {
          const float factor = columnAngle * sinBoundary(j) * square(cosBoundary(j)) / nearest;
          for (int c = 0; c < 3; ++c)
            gradient.translation[c] += factor * (cell.radiance[c] - inner.radiance[c]) * u;
        }
      }
      // The wall between columns k-1 and k: moving along v turns it by 1 / (R sin(theta)); the integral of
      // cos(theta) sin(theta) over the row then is sin(theta+) - sin(theta-).
      const GatherCell& neighbour = hemisphere.cell(j, before);
      const float nearest = std::min(cell.distance, neighbour.distance);
      if (isWall(nearest)) {
        const float factor = (sinBoundary(j + 1) - sinBoundary(j)) / nearest;
        for (int c = 0; c < 3; ++c)
          gradient.translation[c] += factor * (cell.radiance[c] - neighbour.radiance[c]) * v;
      }
      // Turning the normal by dA about an axis a changes the cosine of direction d by dA a . (n x d). With
      // the sample's own azimuth: the column's middle would make too much of wide columns (20 % of 4).
      const Vec3 turned(-cell.direction.y, cell.direction.x, 0.0f);
      for (int c = 0; c < 3; ++c) gradient.rotation[c] += (cellScale * cell.radiance[c]) * turned;
    }
  }
  return gradient;
}

}  // namespace lightvane
