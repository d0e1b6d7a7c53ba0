#include "tests/bench/tracing_stage.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/trace/radiance.h"

namespace lightvane {
namespace {

/// As RadianceEstimator::traceBounce and traceShadows do it: rays into packets, hits out of them.
void traceOurs(const Tracer& tracer, const RayKind& kind, std::vector<Hit>& hits,
               std::vector<std::uint8_t>& blocked) {
  const Coherence coherence = kind.coherent ? Coherence::Coherent : Coherence::Incoherent;
  const std::vector<Ray>& rays = kind.rays;
  if (kind.occlusion) {
    ShadowPacket packet;
    for (std::size_t begin = 0; begin < rays.size(); begin += kShadowPacketWidth) {
      const int count = static_cast<int>(std::min<std::size_t>(kShadowPacketWidth, rays.size() - begin));
      for (int lane = 0; lane < count; ++lane) packet.set(lane, rays[begin + static_cast<std::size_t>(lane)]);
      tracer.occluded(packet, count, coherence);
      for (int lane = 0; lane < count; ++lane)
        blocked[begin + static_cast<std::size_t>(lane)] = packet.isOccluded(lane) ? 1 : 0;
    }
    return;
  }
  HitPacket packet;
  for (std::size_t begin = 0; begin < rays.size(); begin += kPacketWidth) {
    const int count = static_cast<int>(std::min<std::size_t>(kPacketWidth, rays.size() - begin));
    for (int lane = 0; lane < count; ++lane)
      packet.rays.set(lane, rays[begin + static_cast<std::size_t>(lane)]);
    tracer.intersect(packet, count, coherence);
    for (int lane = 0; lane < count; ++lane) hits[begin + static_cast<std::size_t>(lane)] = packet.hit(lane);
  }
}

/// The unit's points on the floor of the scene, but for those that lie under a block.
std::vector<SurfacePoint> floorPoints(const BenchScene& cornell, const EmbreeUnit& unit, std::size_t most) {
  constexpr double kMillimetre = 0.001;
  constexpr double kHighestBlock = 0.33;  // metres
  const Normalisation& normalisation = cornell.scene->normalisation;
  std::vector<SurfacePoint> points;
  for (const Vec3& millimetres : unit.floorPoints()) {
    if (points.size() == most) break;
    const Ray down{normalisation.point(kMillimetre * Vec3d(millimetres)), {0.0f, -1.0f, 0.0f}};
    const Hit hit = cornell.tracer->intersect(down);
    LV_CHECK(hit.found(), "no floor below ({}, {}) mm", millimetres.x, millimetres.z);
    const SurfacePoint point = cornell.tracer->surfaceAt(down, hit);
    const Hit above = cornell.tracer->intersect({point.originTowards({0, 1, 0}), {0.0f, 1.0f, 0.0f}});
    if (above.found() && above.t < normalisation.length(1.01 * kHighestBlock)) continue;
    points.push_back(point);
  }
  return points;
}

}  // namespace

const Samples& RayKind::fastestPeer() const {
  const Samples* fastest = &one;
  for (const Samples* samples : {&eight, &sixteen}) {
    if (samples->median() < fastest->median()) fastest = samples;
  }
  return *fastest;
}

Samples RayKind::rateRatio() const { return ratio(fastestPeer(), ours); }

TracingStage::TracingStage(const BenchScene& cornell, const EmbreeUnit& unit, std::size_t points,
                           std::size_t rays, int rounds)
    : gather{"first rays of gathers", false, true, {}, {}, {}, {}, {}},
      bounce{"bounces", false, false, {}, {}, {}, {}, {}},
      pointShadow{"shadow rays of a point", true, true, {}, {}, {}, {}, {}},
      bounceShadow{"shadow rays of bounces", true, false, {}, {}, {}, {}, {}} {
  const Tracer& tracer = *cornell.tracer;
  const Light& light = cornell.scene->lights.front();
  const RandomKey key = randomKey(1);
  std::uint32_t number = 0;
  for (const SurfacePoint& point : floorPoints(cornell, unit, points)) {
    const LightSampler sampler(light, point.position);
    const RandomKey pointKey = key.with(number++);
    constexpr std::uint32_t kSide = 4;
    for (std::uint32_t s = 0; s < kSide * kSide; ++s) {
      LightSample sample;
      const Vec2 u = (uniform2(pointKey, s, 0) + Vec2(s % kSide, s / kSide)) / static_cast<float>(kSide);
      if (sampler.sample(u, sample) && glm::dot(sample.direction, point.geometricNormal) > 0.0f)
        pointShadow.rays.push_back(shadowRay(point, sample.direction, sample.distance));
    }
    // Blocks of 2 x 4 cells, as Gatherer orders them.
    constexpr std::uint32_t kRows = 8;
    constexpr std::uint32_t kColumns = 16;
    for (std::uint32_t n = 0; n < kRows * kColumns; ++n) {
      const std::uint32_t block = n / 8;
      const std::uint32_t row = 2 * (block / (kColumns / 4)) + n % 8 / 4;
      const std::uint32_t column = 4 * (block % (kColumns / 4)) + n % 4;
      const Vec2 jitter = uniform2(pointKey, n, 2);
      const float c = (static_cast<float>(kRows - row) - jitter.x) / static_cast<float>(kRows);
      const float s = std::sqrt(std::max(0.0f, 1.0f - c * c));
      const float phi = kTwoPi * (static_cast<float>(column) + jitter.y) / static_cast<float>(kColumns);
      const Vec3 direction = point.frame.toWorld({s * std::cos(phi), s * std::sin(phi), c});
      gather.rays.push_back({point.originTowards(direction), direction, 0.0f, kInfinity});
    }
  }

  std::vector<Hit> hits(gather.rays.size());
  std::vector<std::uint8_t> blocked;
  traceOurs(tracer, gather, hits, blocked);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].found()) continue;
    const SurfacePoint point = tracer.surfaceAt(gather.rays[i], hits[i]);
    const auto sampleNumber = static_cast<std::uint32_t>(i);
    const Vec2 u = uniform2(key, sampleNumber, 0);
    const float radius = std::sqrt(u.x);
    const float phi = kTwoPi * u.y;
    const Vec3 direction = point.frame.toWorld(
        {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.0f, 1.0f - u.x))});
    bounce.rays.push_back({point.originTowards(direction), direction, 0.0f, kInfinity});
    LightSample sample;
    if (sampleLight(light, point.position, uniform2(key, sampleNumber, 2), sample) &&
        glm::dot(sample.direction, point.geometricNormal) > 0.0f)
      bounceShadow.rays.push_back(shadowRay(point, sample.direction, sample.distance));
  }

  const EmbreePeer peer(*cornell.scene);
  for (RayKind* kind : {&gather, &bounce, &pointShadow, &bounceShadow}) {
    hits.resize(kind->rays.size());
    blocked.resize(kind->rays.size());
    std::vector<float> distances(kind->rays.size());
    // A batch is repeated until it is long against the clock and what a preemption leaves in the caches.
    const std::size_t repetitions = 1 + rays / kind->rays.size();
    const auto perRay = [&](const auto& trace) {
      return [&, trace] {
        const double start = threadCpuSeconds();
        for (std::size_t r = 0; r < repetitions; ++r) trace();
        return (threadCpuSeconds() - start) / static_cast<double>(repetitions * kind->rays.size());
      };
    };
    const auto peerOf = [&](EmbreePeer::Width width) {
      return perRay([&, width] {
        if (kind->occlusion) {
          peer.occluded(kind->rays, distances, width, kind->coherent);
        } else {
          peer.intersect(kind->rays, distances, width, kind->coherent);
        }
      });
    };
    const std::function<double()> things[] = {
        perRay([&] { traceOurs(tracer, *kind, hits, blocked); }), peerOf(EmbreePeer::Width::One),
        peerOf(EmbreePeer::Width::Eight), peerOf(EmbreePeer::Width::Sixteen)};
    std::vector<Samples> samples = inTurn(rounds, things);
    kind->ours = std::move(samples[0]);
    kind->one = std::move(samples[1]);
    kind->eight = std::move(samples[2]);
    kind->sixteen = std::move(samples[3]);

    // The last round was the peer's: both must have met the same.
    std::size_t different = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const bool same = kind->occlusion ? (distances[i] < 0.0f) == (blocked[i] != 0)
                                        : (distances[i] < kInfinity) == hits[i].found();
      if (!same) ++different;
    }
    LV_CHECK(different * 1000 <= distances.size(), "{} of {} {} end differently in Embree alone", different,
             distances.size(), kind->name);
  }
}

}  // namespace lightvane
