// What a changed parameter leaves true, against records and points that are computed again.

#include "core/render/change.h"

#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "core/render/direct_vectors.h"
#include "core/render/vector_renderer.h"
#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

/// Another valid value for every kind of field.
struct OtherValue {
  std::string wanted;
  std::string text;

  template <class T>
  void operator()(const T& value, const Field& field, const Range<T>& range) {
    if (wanted != field.key) return;
    if constexpr (std::is_arithmetic_v<T>) {
      const T more = std::is_integral_v<T> ? static_cast<T>(value + 1) : static_cast<T>(value * 1.25 + 0.01);
      text = parameter_text::format(more <= range.max ? more : static_cast<T>(value / 2));
    } else {
      text = parameter_text::format(T::relative(value.value() * 1.5));
    }
  }
  void operator()(const bool& value, const Field& field) {
    if (wanted == field.key) text = parameter_text::format(!value);
  }
  template <class E, std::size_t N>
  void operator()(const E& value, const Field& field, const std::array<Choice<E>, N>& choices) {
    if (wanted != field.key) return;
    for (const Choice<E>& choice : choices) {
      if (choice.value != value) text = choice.name;
    }
  }
};

std::vector<std::string> allKeys() {
  std::vector<std::string> keys;
  for (const FieldDescription& row : describeParameters(Parameters())) keys.emplace_back(row.field.key);
  return keys;
}

std::string bits(const Rgb& c) { return fmt::format("{:a} {:a} {:a};", c.r, c.g, c.b); }

/// Some of all that a rendering computes and keeps, as text.
struct Sample {
  std::string points, sampled, indirect, direct;
};

/// Of the points that `before` sees: vectors belong to points, whoever asks for them.
Sample computeSample(const Stage& stage, const Parameters& before, const Parameters& parameters) {
  Sample sample;
  const RenderContext context = stage.context(parameters);
  VisiblePoints points, pointsAnew;
  SeenSurfaces seen(context.region.width, context.region.height);
  const StopFlag stop{false};
  RayCounts rays;
  SampleFaults faults;
  EXPECT_TRUE(traceVisiblePoints(*stage.tracer, context.camera, context.region, parameters, *stage.pool, stop,
                                 pointsAnew, seen, rays));
  for (const VisibleTile& tile : pointsAnew.tiles) {
    for (const VisiblePoint& p : tile.points) {
      sample.points += fmt::format("{} {} {} ", p.pixel, p.clearance, p.surface) + bits(p.position) +
                       bits(p.throughput) + "\n";
    }
  }
  EXPECT_TRUE(traceVisiblePoints(*stage.tracer, context.camera, context.region, before, *stage.pool, stop,
                                 points, seen, rays));
  Gatherer gatherer(*stage.tracer, parameters.transport, parameters.vectors);
  DirectLightSampler direct(*stage.tracer, parameters.transport);
  const std::vector<bool> hasVectors = lightsWithVectors(*stage.scene, parameters);
  std::size_t count = 0;
  for (const VisibleTile& tile : points.tiles) {
    for (const VisiblePoint& p : tile.points) {
      sample.points +=
          fmt::format("{} {} {} {};", p.pixel, p.clearance, p.surface, bits(p.position)) + bits(p.throughput);
      if (count++ % 37 != 0) continue;
      const Material& material = stage.scene->materialOf(p.surface);
      const SurfaceKeys keys = indirectKeys(material, parameters.vectors.ilv.store);
      for (int k = 0; k < keys.count; ++k) {
        const IndirectLightVector record = gatherer.gather(
            {p.lit(*stage.scene), p.vectorFootprint}, keys.keys[k], parameters.picture.seed, rays, faults);
        sample.indirect += fmt::format("{} {:a} {:a} {:a};", keys.keys[k], record.harmonicMean,
                                       record.lobeWidth, record.leastDistance) +
                           bits(record.energy) + bits(record.direction) + bits(record.gradient[0]) +
                           bits(record.rotation[1]) + "\n";
      }
      const RandomKey key = randomKey(parameters.picture.seed).with(p.position);
      for (std::uint32_t light = 0; light < stage.scene->lights.size(); ++light) {
        const DirectLightEstimate e =
            direct.estimate(p.lit(*stage.scene), light, parameters.transport.lightSamples, key, rays, faults);
        sample.sampled += fmt::format("{} ", hasVectors[light] ? 1 : 0) + bits(e.irradiance);
        const DirectLightVector record = computeDirectVector(
            direct, *stage.scene, p, brdfSurfaceKey(material.brdfKey), light, parameters, rays, faults);
        sample.direct += bits(record.energy) + bits(record.lobeRadiance) + bits(record.direction) + "\n";
      }
      sample.sampled += bits(direct
                                 .estimateMirrored(p.lit(*stage.scene), parameters.transport.lightSamples,
                                                   key, rays, faults)
                                 .irradiance) +
                        "\n";
    }
  }
  return sample;
}

/// The first line in which two texts differ; empty where they are the same.
std::string firstDifference(const std::string& a, const std::string& b) {
  std::istringstream linesA(a), linesB(b);
  std::string lineA, lineB;
  while (true) {
    const bool hasA = static_cast<bool>(std::getline(linesA, lineA));
    const bool hasB = static_cast<bool>(std::getline(linesB, lineB));
    if (!hasA && !hasB) return {};
    if (hasA != hasB || lineA != lineB) return fmt::format("{} and {}", lineA, lineB);
  }
}

class ChangedField : public testing::TestWithParam<std::string> {};

TEST_P(ChangedField, WhatIsSaidToHoldIsTheSameToTheBit) {
  static const Stage stage(sceneFromText(R"(version = 1

[camera]
position = [0.278, 0.274, -0.8]
target = [0.278, 0.274, 0.28]
fov_y = 38
resolution = [24, 24]

[material.glossy]
layers = [{ color = [0.4, 0.4, 0.3], roughness = 0.2 }]

[material.white]
diffuse = [0.7, 0.7, 0.7]

[material.mirror]
mirror = [0.9, 0.9, 0.9]

[material.lamp]
emission = [8, 8, 8]

[[shape]]
type = "box"
material = "white"
min = [0, 0, 0.3]
max = [0.55, 0.2, 0.5]

[[shape]]
type = "polygon"
material = "mirror"
vertices = [[0.0, 0.0, 0.6], [0.56, 0.0, 0.6], [0.56, 0.56, 0.6], [0.0, 0.56, 0.6]]

[[shape]]
type = "sphere"
material = "glossy"
center = [0.2, 0.3, 0.35]
radius = 0.09

[[shape]]
type = "polygon"
material = "lamp"
vertices = [[0.2, 0.54, 0.1], [0.2, 0.54, 0.2], [0.35, 0.54, 0.2], [0.35, 0.54, 0.1]]

[[light]]
type = "point"
position = [0.3, 0.5, -0.2]
intensity = [0.1, 0.1, 0.1]
)"));
  // Sixty-four rays: one sample more and the lamp has vectors.
  const Parameters before =
      parametersWith({{"light.samples", "64"}, {"ilv.rows", "4"}, {"ilv.columns", "8"}});
  static const Sample sampleBefore = computeSample(stage, before, before);
  OtherValue other{GetParam(), {}};
  Parameters described = before;
  visitParameters(described, other);
  ASSERT_FALSE(other.text.empty());
  Parameters after = before;
  ASSERT_TRUE(setParameter(after, GetParam(), other.text, "test"));

  const Sample sampleAfter = computeSample(stage, before, after);
  const StillTrue still = stillTrue(*stage.scene, before, after);
  if (still.points) {
    EXPECT_EQ(firstDifference(sampleAfter.points, sampleBefore.points), "")
        << GetParam() << " = " << other.text;
  }
  if (still.sampled) {
    EXPECT_EQ(firstDifference(sampleAfter.sampled, sampleBefore.sampled), "")
        << GetParam() << " = " << other.text;
  }
  if (still.indirectVectors) {
    EXPECT_EQ(firstDifference(sampleAfter.indirect, sampleBefore.indirect), "")
        << GetParam() << " = " << other.text;
  }
  if (still.directVectors) {
    EXPECT_EQ(firstDifference(sampleAfter.direct, sampleBefore.direct), "")
        << GetParam() << " = " << other.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Every, ChangedField, testing::ValuesIn(allKeys()), [](const auto& parameter) {
  std::string name = parameter.param;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

// Else nothing would ever be kept, and the test above could not fail.
TEST(StillTrue, ThresholdsKeepEverything) {
  const Stage stage(shippedScene("cornell.toml", 8, 8));
  const std::set<std::string> thresholds = {
      "ilv.n_min", "ilv.n_max",      "ilv.radius_scale", "ilv.S_curv",   "ilv.radius_min", "dlv.r_max",
      "dlv.n_min", "dlv.dispersion", "passes.thin",      "path.samples", "ilv.extrapolate"};
  for (const std::string& key : thresholds) {
    const Parameters before;
    OtherValue other{key, {}};
    Parameters described = before;
    visitParameters(described, other);
    Parameters after = before;
    ASSERT_TRUE(setParameter(after, key, other.text, "test")) << key;
    const StillTrue still = stillTrue(*stage.scene, before, after);
    EXPECT_TRUE(still.points && still.sampled && still.indirectVectors && still.directVectors) << key;
  }
}

TEST(StillTrue, VectorsOfOneKindOutliveChangesOfTheOther) {
  const Stage stage(shippedScene("cornell.toml", 8, 8));
  const Parameters before = parametersWith({{"dlv.mode", "always"}});
  Parameters after = before;
  setParameters(after, {{"ilv.rows", "20"}});
  EXPECT_TRUE(stillTrue(*stage.scene, before, after).directVectors);
  EXPECT_FALSE(stillTrue(*stage.scene, before, after).indirectVectors);
  after = before;
  setParameters(after, {{"dlv.store", "vector"}});
  EXPECT_FALSE(stillTrue(*stage.scene, before, after).directVectors);
  EXPECT_TRUE(stillTrue(*stage.scene, before, after).indirectVectors);
}

}  // namespace
}  // namespace lightvane::render_test
