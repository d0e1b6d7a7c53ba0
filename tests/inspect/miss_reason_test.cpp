#include "core/inspect/miss_reason.h"

#include <ctime>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

/// Two vectors on a floor with a wall across it; each test changes what it is about.
class MissReasons : public testing::Test {
 protected:
  MissReasons()
      : stage_(render_test::sceneFromText(R"(
version = 1
[camera]
position = [0, 0.9, 0.9]
target = [0, 0, 0]
up = [0, 1, 0]
fov_y = 60
resolution = [8, 8]
[material.grey]
diffuse = [0.5, 0.5, 0.5]
[[shape]]
type = "polygon"
material = "grey"
vertices = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]
[[shape]]
type = "polygon"
material = "grey"
vertices = [[-0.5, 0, 1], [-0.5, 0, -1], [-0.5, 0.5, -1], [-0.5, 0.5, 1]]
[[light]]
type = "point"
position = [0, 0.8, 0]
intensity = [1, 1, 1]
)")) {
    unit_ = stage_.scene->normalisation.length(1.0);
    ilv_.radiusMaxPixels = 0.0;
    ilv_.radiusMinPixels = 0.0;
    ilv_.radiusScale = 1.0;
    near_ = vectorAt({0.1, 0.0, 0.0});
    far_ = vectorAt({0.4, 0.0, 0.0});
    point_ = {place({0.0, 0.0, 0.0}), {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, 1e-6f};
  }

  Vec3 place(const Vec3d& metres) const { return stage_.scene->normalisation.point(metres); }

  IndirectLightVector vectorAt(const Vec3d& metres) const {
    IndirectLightVector a;
    a.point.position = place(metres);
    a.point.normal = {0, 1, 0};
    a.point.outgoing = {0, 1, 0};
    a.energy = a.irradiance = Rgb(1.0f);
    a.harmonicMean = a.leastDistance = 0.2f * unit_;
    return a;
  }

  MissReason reason(std::size_t before = 2) const {
    const IlvRules rules(ilv_, stage_.scene->diagonal);
    const auto records = RecordSet<IndirectLightVector>().with(
        {near_, far_}, [&](const IndirectLightVector& a) { return ilvRadius(a, rules); });
    return missReason(records, before, kLambertKey, point_, rules, *stage_.tracer);
  }

  Stage stage_;
  IlvParameters ilv_;
  float unit_ = 0.0f;
  IndirectLightVector near_, far_;
  QueryPoint point_;
};

TEST_F(MissReasons, TooFewWhereTheNearestIsValid) { EXPECT_EQ(reason(), MissReason::TooFew); }

TEST_F(MissReasons, FirstWhereThereIsNone) {
  EXPECT_EQ(reason(0), MissReason::NoneYet);
  near_.point.key = far_.point.key = brdfSurfaceKey(3);
  EXPECT_EQ(reason(), MissReason::NoneYet) << "vectors of another key are not candidates";
}

TEST_F(MissReasons, YoungerVectorsAreNotAsked) {
  std::swap(near_, far_);  // the near one is number 1 now
  EXPECT_EQ(reason(2), MissReason::TooFew);
  EXPECT_EQ(reason(1), MissReason::Distance);
}

TEST_F(MissReasons, Distance) {
  near_.harmonicMean = 0.09f * unit_;
  EXPECT_EQ(reason(), MissReason::Distance);
  near_.harmonicMean = 0.11f * unit_;
  EXPECT_EQ(reason(), MissReason::TooFew);
}

TEST_F(MissReasons, TheNearestSpeaksThoughAFartherOneReachesFarther) {
  near_.harmonicMean = 0.09f * unit_;
  far_.harmonicMean = far_.leastDistance = 2.0f * unit_;
  EXPECT_EQ(reason(), MissReason::Distance);
}

TEST_F(MissReasons, Curvature) {
  near_.point.normal = glm::normalize(Vec3(1, 1, 0));
  EXPECT_EQ(reason(), MissReason::Curvature);
}

TEST_F(MissReasons, Gradient) {
  ilv_.gradientTest = IlvGradientTest::Absolute;
  // 0.1 m away, 30 % a 0.1 m: S_E is 20 %.
  for (Vec3& gradient : near_.gradient) gradient = Vec3(3.0f / unit_, 0.0f, 0.0f);
  EXPECT_EQ(reason(), MissReason::Gradient);
  ilv_.sE = 0.4;
  EXPECT_EQ(reason(), MissReason::TooFew);
}

TEST_F(MissReasons, InFront) {
  near_.point.position = place({0.1, 0.05, 0.0});
  EXPECT_EQ(reason(), MissReason::InFront);
}

TEST_F(MissReasons, Lobe) {
  near_.point.key = far_.point.key = kLambertKey;
  near_.lobeWidth = 0.3f;
  near_.harmonicMean = 2.0f * unit_;
  near_.leastDistance = unit_;
  near_.point.outgoing = glm::normalize(Vec3(1, 1, 0));
  EXPECT_EQ(reason(), MissReason::Lobe);
}

TEST_F(MissReasons, Clearance) {
  point_.reach = 0.09f * unit_;
  EXPECT_EQ(reason(), MissReason::Clearance);
}

TEST_F(MissReasons, Visibility) {
  // On either side of the wall.
  point_.position = place({-0.45, 0.0, 0.0});
  near_.point.position = place({-0.55, 0.0, 0.0});
  ilv_.visibilityDistance = 0.4;
  EXPECT_EQ(reason(), MissReason::Visibility);
  ilv_.visibility = false;
  EXPECT_EQ(reason(), MissReason::TooFew);
}

// Of a whole rendering: every vector of the picture's own is told of, the seed's as such, and the rules that
// made misses are among those that are on.
TEST(ComputedVectors, AreThoseOfTheFrame) {
  const RenderFrame frame = renderShipped("cornell.toml", 96, {{"ilv.seed", "50"}});
  const std::vector<ComputedVector> computed = computedVectors(frame);
  EXPECT_EQ(computed.size(), frame.snapshot->indirect.size());
  std::map<MissReason, int> counts;
  for (const ComputedVector& v : computed) {
    const IndirectLightVector& record = frame.snapshot->indirect[v.number];
    ++counts[v.reason];
    EXPECT_EQ(v.reason == MissReason::Seed, record.birth.pass == 0) << "number " << v.number;
    EXPECT_EQ(frame.points->tiles[v.point.tile].points[v.point.point].pixel, record.birth.pixel);
  }
  EXPECT_EQ(counts[MissReason::Gradient], 0) << "the refined rules have no gradient test";
  EXPECT_EQ(counts[MissReason::Lobe], 0);
  EXPECT_EQ(counts[MissReason::NoneYet], 0);
  EXPECT_GT(counts[MissReason::Distance], 0);
  EXPECT_GT(counts[MissReason::Curvature], 0);
  std::string told;
  for (const auto& [reason, count] : counts) told += fmt::format(" {} {}", count, missReasonName(reason));
  RecordProperty("reasons", told);
}

// Vectors of a camera that stood elsewhere belong to no pixel.
TEST(ComputedVectors, OfAnotherViewAreLeftOut) {
  SceneDescription scene = shippedScene("cornell.toml", 48, 48);
  const RenderFrame first = renderFrame(Stage(scene), parametersWith({}));
  scene.cameras.front().position.x += 0.1;
  const RenderFrame second = renderFrame(Stage(scene), parametersWith({}), -1, {first.snapshot, false});
  ASSERT_GT(second.snapshot->indirect.size(), first.snapshot->indirect.size());
  const std::size_t own = second.snapshot->indirect.size() - first.snapshot->indirect.size();
  EXPECT_EQ(computedVectors(second).size(), own) << first.snapshot->indirect.size() << " vectors are older";
}

TEST(ComputedVectors, KnowThePublicationsOfTheLastPass) {
  const RenderFrame frame = renderShipped("cornell.toml", 64);
  const RecordSet<IndirectLightVector>& records = frame.snapshot->indirect;
  std::size_t first = 0;
  for (std::size_t n = 0; n < records.size(); ++n) {
    if (records[n].birth.order == 0) first = n;
    ASSERT_EQ(firstOfPublication(records, n), first) << "number " << n;
  }
}

// Not a statement about speed (that is tests/bench) but about the order of it: a view must not wait for
// seconds.
TEST(ComputedVectors, AreFoundQuickly) {
  if (!render_test::isFast()) GTEST_SKIP();
  const RenderFrame frame = renderShipped("cornell.toml", 256);
  const std::clock_t start = std::clock();
  const std::size_t count = computedVectors(frame).size();
  const double milliseconds = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("milliseconds", fmt::format("{:.1f} for {} vectors", milliseconds, count));
  // Measured 3 us a vector; more on a busy machine.
  EXPECT_LT(milliseconds, 0.05 * static_cast<double>(count) + 20.0) << count << " vectors";
}

}  // namespace
}  // namespace lightvane::inspect_test
