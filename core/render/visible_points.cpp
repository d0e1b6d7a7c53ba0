#include "core/render/visible_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/random.h"

namespace lightvane {
namespace {

static_assert(kMostFilmSamples <= std::numeric_limits<decltype(VisiblePoint::sample)>::max());

struct PendingRay {
  Ray ray;
  Rgb throughput;  ///< of the sample
  float share;     ///< of the sample in its pixel
  std::uint32_t pixel;
  std::uint16_t sample;
  int depth;
  float width;       ///< of the pixel's cone at the ray's origin, for a picture 256 pixels high
  float spread;      ///< of the cone, per unit of length
  int panes = 0;     ///< gaps in surfaces that the ray came through
  float way = 0.0f;  ///< to the last of them
};

/// Traces one tile; keeps its memory between tiles.
class TileTracer {
 public:
  TileTracer(const Tracer& tracer, const Camera& camera, const VisiblePoints& points,
             const Parameters& parameters)
      : tracer_(tracer),
        scene_(tracer.scene()),
        camera_(camera),
        points_(points),
        region_(points.region),
        parameters_(parameters),
        asksClearance_(parameters.picture.method == Method::Vectors &&
                       parameters.vectors.ilv.clearance > 0.0) {}

  /// The tile is not to be used where `stop` was set before the end.
  void trace(VisibleTile& tile, SeenSurfaces& seen, const StopFlag& stop, RayCounts& counts) {
    pending_.clear();
    if (camera_.hasLens()) meetByWayOfCentre(tile, seen, stop, counts);
    const float width = pixelWidth();
    const float spread = pixelSpread();
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        if (stop) return;
        const std::size_t pixel = seen.depth.index(x, y);
        const int samples = points_.samplesOf(pixel);
        for (int s = 0; s < samples; ++s) {
          pending_.emplace_back(cameraRay(camera_, region_.x + x, region_.y + y, s, samples), Rgb(1.0f),
                                1.0f / static_cast<float>(samples), static_cast<std::uint32_t>(pixel),
                                static_cast<std::uint16_t>(s), 0, width, spread);
        }
      }
    }
    tile.points.clear();
    tile.points.reserve(pending_.size());
    tile.tints = nullptr;
    while (!pending_.empty()) {
      next_.clear();
      counts.camera += pending_.size();
      HitPacket packet;
      for (std::size_t begin = 0; begin < pending_.size(); begin += kPacketWidth) {
        if (stop) return;
        const int lanes = static_cast<int>(std::min<std::size_t>(kPacketWidth, pending_.size() - begin));
        for (int lane = 0; lane < lanes; ++lane)
          packet.rays.set(lane, pending_[begin + static_cast<std::size_t>(lane)].ray);
        tracer_.intersect(packet, lanes, Coherence::Coherent);
        for (int lane = 0; lane < lanes; ++lane) {
          shade(pending_[begin + static_cast<std::size_t>(lane)], packet.hit(lane), tile, seen);
        }
      }
      std::swap(pending_, next_);
    }
    if (stop) return;
    const auto isBefore = [](const VisiblePoint& a, const VisiblePoint& b) { return a.pixel < b.pixel; };
    // Points seen through mirrors were added after all others.
    if (!std::is_sorted(tile.points.begin(), tile.points.end(), isBefore))
      std::stable_sort(tile.points.begin(), tile.points.end(), isBefore);
    if (asksClearance_) measureClearance(tile, stop, counts);
    makeClusters(tile, region_.width, stop);
  }

 private:
  // How wide a pixel of a picture 256 pixels high is where its line of sight begins, and by how much it
  // widens with each unit of length. That a lens blurs what is out of focus does not widen it: pixels ask for
  // vectors as densely as if the place were sharp, which is more than a blur needs and never less, and a
  // place keeps its vectors when the focus moves.
  float pixelWidth() const { return camera_.isOrthographic() ? 2.0f * camera_.halfHeight / 256.0f : 0.0f; }
  float pixelSpread() const { return camera_.isOrthographic() ? 0.0f : 2.0f * camera_.tanHalfFovY / 256.0f; }

  /// What the pixels' middles show by way of the lens's centre.
  void meetByWayOfCentre(const VisibleTile& tile, SeenSurfaces& seen, const StopFlag& stop,
                         RayCounts& counts) {
    HitPacket packet;
    std::array<Ray, kPacketWidth> rays;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int begin = tile.x0; begin < tile.x1; begin += kPacketWidth) {
        if (stop) return;
        const int lanes = std::min(kPacketWidth, tile.x1 - begin);
        for (int lane = 0; lane < lanes; ++lane) {
          const Sight sight = camera_.sight(static_cast<float>(region_.x + begin + lane) + 0.5f,
                                            static_cast<float>(region_.y + y) + 0.5f);
          rays[static_cast<std::size_t>(lane)] = {sight.origin, sight.direction, 0.0f, kInfinity};
          packet.rays.set(lane, rays[static_cast<std::size_t>(lane)]);
        }
        tracer_.intersect(packet, lanes, Coherence::Coherent);
        counts.camera += static_cast<std::uint64_t>(lanes);
        for (int lane = 0; lane < lanes; ++lane) {
          const Hit hit = packet.hit(lane);
          if (!hit.found()) continue;
          note(seen, seen.depth.index(begin + lane, y), hit.t,
               tracer_.surfaceAt(rays[static_cast<std::size_t>(lane)], hit));
        }
      }
    }
  }

  static void note(SeenSurfaces& seen, std::size_t pixel, float distance, const SurfacePoint& point) {
    seen.depth[pixel] = distance;
    seen.position[pixel] = point.position;
    seen.normal[pixel] = point.frame.z;
  }

  void shade(const PendingRay& pending, const Hit& hit, VisibleTile& tile, SeenSurfaces& seen) {
    ImageRgb& emissionLayer = pending.depth == 0 ? seen.emission : seen.specularEmission;
    if (!hit.found()) {
      for (const Light& light : scene_.lights) {
        emissionLayer[pending.pixel] +=
            pending.share * pending.throughput * radianceFromInfinity(light, pending.ray.direction);
      }
      return;
    }
    const SurfacePoint point = tracer_.surfaceAt(pending.ray, hit);
    if (point.opacity < 1.0f) {
      lookThrough(pending, point, hit.t);
      if (!(point.opacity > 0.0f)) return;
      PendingRay rest = pending;
      rest.throughput *= point.opacity;
      return shadeSurface(rest, hit, point, tile, seen);
    }
    shadeSurface(pending, hit, point, tile, seen);
  }

  /// What is seen through the gaps of a surface, as if that were not there.
  void lookThrough(const PendingRay& pending, const SurfacePoint& point, float distance) {
    if (pending.panes >= Tracer::kMostPanes) return;
    PendingRay next = pending;
    next.ray.origin = point.originTowards(pending.ray.direction);
    next.throughput *= 1.0f - point.opacity;
    if (!(maxComponent(next.throughput) > static_cast<float>(parameters_.transport.specularCutoff))) return;
    next.width += pending.spread * distance;
    next.way += distance;
    ++next.panes;
    next_.push_back(next);
  }

  void shadeSurface(const PendingRay& pending, const Hit& hit, const SurfacePoint& point, VisibleTile& tile,
                    SeenSurfaces& seen) {
    ImageRgb& emissionLayer = pending.depth == 0 ? seen.emission : seen.specularEmission;
    const Material& material = scene_.materials[point.material];
    const float width = pending.width + pending.spread * hit.t;
    if (pending.depth == 0) {
      // Of what is seen one behind the other, the first.
      const bool isFirst = pending.panes == 0 || seen.depth[pending.pixel] == kInfinity;
      if (pending.sample == 0 && !camera_.hasLens() && isFirst)
        note(seen, pending.pixel, pending.way + hit.t, point);
      seen.albedo[pending.pixel] += pending.share * pending.throughput * albedo(material, point, pending.ray);
    }
    emissionLayer[pending.pixel] += pending.share * pending.throughput * emittedRadiance(scene_, point);
    if (material.brdf.hasNonSpecular()) {
      const float straight = pixelWidth() + pixelSpread() * glm::length(point.position - camera_.position);
      const float vectorWidth = pending.depth == 0 ? width : std::min(width, straight);
      const Tint* ofTextures = nullptr;
      if (material.isTinted) {
        if (!tile.tints) tile.tints = std::make_shared<std::deque<Tint>>();
        ofTextures = &tile.tints->emplace_back(point.tint);
      }
      // In their place: copies would wait for the stores of their parts.
      tile.points.emplace_back(point.position, point.geometricNormal, point.frame.z, point.frame.x,
                               -pending.ray.direction, pending.share * pending.throughput, point.offset,
                               kInfinity, width, vectorWidth, point.surface, pending.pixel, pending.sample,
                               point.frontSide, pending.depth > 0, ofTextures);
    }
    if (!material.brdf.hasSpecular() || pending.depth >= parameters_.transport.specularDepth) return;
    std::array<SpecularBranch, 2> branches;
    const Vec3 outgoing = point.frame.toLocal(-pending.ray.direction);
    const int count = material.brdf.specularBranches(outgoing, point.frontSide, point.tint, branches);
    for (int i = 0; i < count; ++i) {
      const SpecularBranch& branch = branches[static_cast<std::size_t>(i)];
      const Rgb throughput = pending.throughput * branch.weight;
      if (!(maxComponent(throughput) > static_cast<float>(parameters_.transport.specularCutoff))) continue;
      const Vec3 direction = glm::normalize(point.frame.toWorld(branch.direction));
      // A curved mirror widens the cone by twice the angle that its normal turns over the footprint.
      const float spread = pending.spread + 2.0f * width * point.curvature / std::max(outgoing.z, 0.1f);
      next_.push_back({{point.originTowards(direction), direction, 0.0f, kInfinity},
                       throughput,
                       pending.share,
                       pending.pixel,
                       pending.sample,
                       pending.depth + 1,
                       width,
                       spread});
    }
  }

  void measureClearance(VisibleTile& tile, const StopFlag& stop, RayCounts& counts) {
    HitPacket packet;
    for (std::size_t begin = 0; begin < tile.points.size(); begin += kPacketWidth) {
      if (stop) return;
      const int lanes = static_cast<int>(std::min<std::size_t>(kPacketWidth, tile.points.size() - begin));
      for (int lane = 0; lane < lanes; ++lane) {
        const VisiblePoint& p = tile.points[begin + static_cast<std::size_t>(lane)];
        packet.rays.set(lane,
                        {p.position + p.offset * p.geometricNormal, p.geometricNormal, 0.0f, kInfinity});
      }
      tracer_.intersect(packet, lanes, Coherence::Coherent);
      counts.visibility += static_cast<std::uint64_t>(lanes);
      for (int lane = 0; lane < lanes; ++lane) {
        tile.points[begin + static_cast<std::size_t>(lane)].clearance = packet.hit(lane).t;
      }
    }
  }

  /// Reflectance for the AOV: Lambert's own, or an approximation of what lobes and mirrors reflect.
  static Rgb albedo(const Material& material, const SurfacePoint& point, const Ray& ray) {
    Rgb value = material.brdf.diffuse(point.tint);
    if (material.brdf.hasLobe()) value = material.brdf.nonSpecularAlbedoBound(point.tint);
    if (material.brdf.hasSpecular()) {
      std::array<SpecularBranch, 2> branches;
      const int count = material.brdf.specularBranches(point.frame.toLocal(-ray.direction), point.frontSide,
                                                       point.tint, branches);
      for (int i = 0; i < count; ++i) value += branches[static_cast<std::size_t>(i)].weight;
    }
    return glm::min(value, Rgb(1.0f));
  }

  /// Blocks of 8 x 8 pixels, split greedily where BRDF, normal or place differ.
  void makeClusters(VisibleTile& tile, int width, const StopFlag& stop) {
    constexpr int kBlock = 8;
    constexpr float kNearFootprints = 48.0f;  // at 256 pixels: a block at 512 is 4 wide and may slope steeply
    tile.clusters.clear();
    const int blocksX = (tile.x1 - tile.x0 + kBlock - 1) / kBlock;
    const int blocksY = (tile.y1 - tile.y0 + kBlock - 1) / kBlock;
    blocks_.assign(static_cast<std::size_t>(blocksX) * static_cast<std::size_t>(blocksY), {});
    for (std::uint32_t i = 0; i < tile.points.size(); ++i) {
      const auto pixel = static_cast<int>(tile.points[i].pixel);
      const int bx = (pixel % width - tile.x0) / kBlock;
      const int by = (pixel / width - tile.y0) / kBlock;
      blocks_[static_cast<std::size_t>(by) * static_cast<std::size_t>(blocksX) + static_cast<std::size_t>(bx)]
          .push_back(i);
    }
    for (const std::vector<std::uint32_t>& block : blocks_) {
      const std::size_t firstOfBlock = tile.clusters.size();
      for (const std::uint32_t i : block) {
        if (stop) return;
        const VisiblePoint& p = tile.points[i];
        const std::uint32_t brdf = scene_.materialOf(p.surface).brdfKey;
        PointCluster* home = nullptr;
        for (std::size_t c = firstOfBlock; c < tile.clusters.size() && home == nullptr; ++c) {
          PointCluster& cluster = tile.clusters[c];
          const VisiblePoint& leader = tile.points[cluster.points.front()];
          const Vec3 away = p.position - leader.position;
          if (cluster.points.size() < kClusterSize && scene_.materialOf(leader.surface).brdfKey == brdf &&
              glm::dot(leader.normal, p.normal) > 0.95f &&
              glm::dot(away, away) < square(kNearFootprints * leader.footprint)) {
            home = &cluster;
          }
        }
        if (home == nullptr) home = &tile.clusters.emplace_back();
        home->points.push_back(i);
      }
      for (std::size_t c = firstOfBlock; c < tile.clusters.size(); ++c) {
        tile.clusters[c].ball = ballAround(tile, tile.clusters[c].points);
      }
    }
  }

  const Tracer& tracer_;
  const Scene& scene_;
  const Camera& camera_;
  const VisiblePoints& points_;
  const PictureRegion& region_;
  const Parameters& parameters_;
  bool asksClearance_;
  std::vector<PendingRay> pending_;
  std::vector<PendingRay> next_;
  std::vector<std::vector<std::uint32_t>> blocks_;
};

/// Point `s` of Sobol's sequence in two dimensions, 32 bits each: any 2^k points that begin at a multiple of
/// 2^k lie in as many cells of equal area, whatever the cells' shape (Sobol 1967).
glm::uvec2 sobol(std::uint32_t s) {
  glm::uvec2 bits(0);
  std::uint32_t first = 0x80000000U, second = 0x80000000U;
  for (; s != 0; s >>= 1, first >>= 1, second ^= second >> 1) {
    if ((s & 1U) != 0) bits ^= glm::uvec2(first, second);
  }
  return bits;
}

/// Where sample `s` of a pixel looks through the lens. A digital rotation (Kollig & Keller 2002) gives each
/// pixel places of its own: what few samples leave of a blur is noise, not many pictures of a sharp edge.
Vec2 lensPlace(const Camera& camera, int x, int y, std::uint32_t s) {
  constexpr std::uint32_t kLensStream = 0x6c656e73U;
  const RandomKey pixel = RandomKey{}
                              .with(kLensStream)
                              .with(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(camera.width) +
                                    static_cast<std::uint32_t>(x));
  const glm::uvec2 bits = sobol(s) ^ glm::uvec2(randomBits(pixel, 0, 0), randomBits(pixel, 0, 1));
  const DiscPoint place = concentricDisc({unitFloat(bits.x), unitFloat(bits.y)});
  const double radius = std::sqrt(place.radiusSquared);
  return {radius * place.cosine, radius * place.sine};
}

/// Traces those of the points' tiles.
bool traceTiles(const Tracer& tracer, const Camera& camera, const Parameters& parameters,
                std::span<const std::size_t> tiles, TaskPool& pool, const StopFlag& stop,
                VisiblePoints& points, SeenSurfaces& seen, RayCounts& counts) {
  std::vector<TileTracer> tracers(static_cast<std::size_t>(pool.threadCount()),
                                  TileTracer(tracer, camera, points, parameters));
  std::vector<RayCounts> tileCounts(tiles.size());
  pool.forEach(tiles.size(), [&](std::size_t i, int worker) {
    if (stop) return;
    tracers[static_cast<std::size_t>(worker)].trace(points.tiles[tiles[i]], seen, stop, tileCounts[i]);
  });
  for (const RayCounts& tile : tileCounts) counts += tile;
  return !stop;
}

}  // namespace

LitPoint VisiblePoint::lit(const Scene& scene) const {
  LitPoint point;
  point.surface.position = position;
  point.surface.geometricNormal = geometricNormal;
  point.surface.frame = frame();
  point.surface.frontSide = frontSide;
  point.surface.tint = tint();
  point.surface.offset = offset;
  point.surface.surface = surface;
  point.surface.material = scene.surfaces[surface].material;
  point.outgoing = outgoing;
  return point;
}

Ball ballAround(const VisibleTile& tile, std::span<const std::uint32_t> points) {
  return ballOf(points, [&](std::uint32_t i) { return tile.points[i].position; });
}

std::size_t VisiblePoints::pointCount() const {
  std::size_t count = 0;
  for (const VisibleTile& tile : tiles) count += tile.points.size();
  return count;
}

std::size_t VisiblePoints::memoryBytes() const {
  std::size_t bytes = sight ? sight->memoryBytes() : 0;
  for (const VisibleTile& tile : tiles) {
    bytes += tile.points.capacity() * sizeof(VisiblePoint) + tile.clusters.capacity() * sizeof(PointCluster);
    if (tile.tints) bytes += tile.tints->size() * sizeof(Tint);
    for (const PointCluster& cluster : tile.clusters)
      bytes += cluster.points.capacity() * sizeof(std::uint32_t);
  }
  return bytes;
}

std::uint32_t tileOfPixel(const PictureRegion& region, std::uint32_t pixel) {
  const auto width = static_cast<std::uint32_t>(region.width);
  constexpr auto kTileSize = static_cast<std::uint32_t>(VisiblePoints::kTileSize);
  const std::uint32_t tilesX = (width + kTileSize - 1) / kTileSize;
  return pixel / width / kTileSize * tilesX + pixel % width / kTileSize;
}

PixelPoints pointsOfPixel(const VisiblePoints& points, std::uint32_t pixel) {
  const std::uint32_t tile = tileOfPixel(points.region, pixel);
  if (tile >= points.tiles.size()) return {};
  const std::vector<VisiblePoint>& all = points.tiles[tile].points;
  const auto first =
      std::lower_bound(all.begin(), all.end(), pixel,
                       [](const VisiblePoint& p, std::uint32_t wanted) { return p.pixel < wanted; });
  auto last = first;
  while (last != all.end() && last->pixel == pixel) ++last;
  return {tile, static_cast<std::uint32_t>(first - all.begin()), static_cast<std::uint32_t>(last - first)};
}

Ray cameraRay(const Camera& camera, int x, int y, int s, int samples) {
  Vec2 within(0.5f);
  if (samples > 1) within = r2Place(static_cast<std::uint32_t>(s));
  const Vec2 onLens = camera.hasLens() ? lensPlace(camera, x, y, static_cast<std::uint32_t>(s)) : Vec2(0.0f);
  const Sight sight =
      camera.sight(static_cast<float>(x) + within.x, static_cast<float>(y) + within.y, onLens);
  return {sight.origin, sight.direction, 0.0f, kInfinity};
}

bool traceVisiblePoints(const Tracer& tracer, const Camera& camera, const PictureRegion& region,
                        const Parameters& parameters, TaskPool& pool, const StopFlag& stop,
                        VisiblePoints& points, SeenSurfaces& seen, RayCounts& counts) {
  points.region = region;
  points.samples = isAdaptive(parameters) ? 1 : parameters.picture.filmSamples;
  points.refined = {};
  points.tiles.clear();
  for (int y = 0; y < region.height; y += VisiblePoints::kTileSize) {
    for (int x = 0; x < region.width; x += VisiblePoints::kTileSize) {
      VisibleTile& tile = points.tiles.emplace_back();
      tile.x0 = x;
      tile.y0 = y;
      tile.x1 = std::min(x + VisiblePoints::kTileSize, region.width);
      tile.y1 = std::min(y + VisiblePoints::kTileSize, region.height);
    }
  }
  std::vector<std::size_t> all(points.tiles.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return traceTiles(tracer, camera, parameters, all, pool, stop, points, seen, counts);
}

bool refineVisiblePoints(const Tracer& tracer, const Camera& camera, const Image<std::uint8_t>& refined,
                         const Parameters& parameters, TaskPool& pool, const StopFlag& stop,
                         VisiblePoints& points, SeenSurfaces& seen, RayCounts& counts) {
  points.samples = parameters.picture.filmSamples;
  points.refined = refined;
  std::vector<std::size_t> changed;
  for (std::size_t t = 0; t < points.tiles.size(); ++t) {
    const VisibleTile& tile = points.tiles[t];
    bool isChanged = false;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) isChanged |= refined.at(x, y) != 0;
    }
    if (!isChanged) continue;
    changed.push_back(t);
    // What samples are added up in.
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (ImageRgb* sums : {&seen.emission, &seen.specularEmission, &seen.albedo})
          sums->at(x, y) = Rgb(0.0f);
      }
    }
  }
  return traceTiles(tracer, camera, parameters, changed, pool, stop, points, seen, counts);
}

}  // namespace lightvane
