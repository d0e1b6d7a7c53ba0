#pragma once

#include <algorithm>

#include "core/render/direct_vectors.h"
#include "core/render/visible_points.h"
#include "core/vectors/answer.h"

namespace lightvane {

// How a visible point asks vectors, and what their answers give it: for whoever answers a point, and for
// whoever explains the answer.

/// Of a visible point's own samples. Points of one pixel differ by place: their numbers depend on the tile.
inline RandomKey pointKey(const PictureRegion& region, const VisiblePoint& point, RandomKey seed) {
  const int x = static_cast<int>(point.pixel) % region.width;
  const int y = static_cast<int>(point.pixel) / region.width;
  return seed.with(region.pixelAddress(x, y)).with(point.position);
}

/// Within which distance the point takes ILVs, normalised units.
inline float indirectReach(const VisiblePoint& point, const IlvParameters& ilv) {
  if (!(ilv.clearance > 0.0)) return kInfinity;
  // Never less than the least radius: below a few pixels nothing is gained.
  return std::max(static_cast<float>(ilv.clearance) * point.clearance,
                  static_cast<float>(ilv.radiusMinPixels) * point.footprint);
}

inline QueryPoint queryPoint(const VisiblePoint& point, const IlvParameters& ilv) {
  return {point.position, point.normal, point.geometricNormal,
          point.outgoing, point.offset, indirectReach(point, ilv)};
}

/// Radiance towards the viewer of what ILVs of `key` say: their energy and direction. Normalised units.
inline Rgb indirectRadiance(const Brdf& brdf, const VisiblePoint& point, VectorStore store, SurfaceKey key,
                            const Rgb& energy, const Vec3& direction) {
  const bool isSplit = store == VectorStore::Split;
  if (isSplit && key == kLambertKey) return brdf.diffuse(point.tint()) * kInvPi * energy;
  if (isSplit && !brdf.changesLobe(point.tint())) return energy;
  const Frame frame = point.frame();
  if (isSplit) return energy * brdf.lobeAlbedoShare(frame.toLocal(point.outgoing), point.tint());
  return energy * brdf.evaluate(frame.toLocal(direction), frame.toLocal(point.outgoing), point.tint());
}

/// The key of the DLVs that serve points of a material.
inline SurfaceKey directSurfaceKey(const Material& material, VectorStore store) {
  const bool shared = store == VectorStore::Split && !material.brdf.hasLobe();
  return shared ? kLambertKey : brdfSurfaceKey(material.brdfKey);
}

/// The angle by which the view may turn until DLVs of the BRDF expire, radians; 0 where they never do.
inline float directLobeWidth(const Brdf& brdf) { return brdf.hasLobe() ? brdf.lobeHalfWidth() : 0.0f; }

}  // namespace lightvane
