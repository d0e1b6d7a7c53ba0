#include "core/inspect/overlays.h"

#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/number_text.h"
#include "core/inspect/frame_points.h"
#include "core/inspect/record_names.h"
#include "core/inspect/validity_zone.h"
#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

OverlayStyle everything() {
  OverlayStyle style;
  for (OverlayLook* look : {&style.directMarkers, &style.directGlyphs, &style.indirectMarkers, &style.zones,
                            &style.directZones, &style.gradients, &style.mirrorImages}) {
    look->shown = true;
  }
  return style;
}

// ---- zones ----

struct RuleSet {
  const char* name;
  Settings settings;
  bool cuts;  ///< some zone is cut
};
void PrintTo(const RuleSet& rules, std::ostream* out) { *out << rules.name; }

class Zones : public testing::TestWithParam<RuleSet> {};

// Random points of the tangent planes, with the vector's own normal and direction of view: the zone has a
// point exactly where ilvWeight does not refuse it for distance or gradient.
TEST_P(Zones, AreWhereTheRulesAccept) {
  const RenderFrame frame = renderShipped("cornell-glossy.toml", 40, GetParam().settings);
  const IlvRules rules(frame.parameters.vectors.ilv, frame.scene->diagonal);
  const RandomKey key = randomKey(7);
  int cut = 0;
  int inside = 0;
  int outside = 0;
  int atBorder = 0;
  for (std::uint32_t n = 0; n < frame.snapshot->indirect.size(); ++n) {
    const IndirectLightVector& record = frame.snapshot->indirect[n];
    const std::optional<OverlayZone> zone = validityZone(record, rules);
    ASSERT_TRUE(zone) << "number " << n;
    cut += zone->cutU != 0.0f || zone->cutV != 0.0f;
    EXPECT_NEAR(glm::length(zone->axisU), ilvRadius(record, rules), 1e-6f * ilvRadius(record, rules));
    const IlvCandidate a = makeCandidate(record, rules);
    for (std::uint32_t s = 0; s < 40; ++s) {
      const Vec2 uv = 2.6f * uniform2(key.with(n), s, 0) - 1.3f;
      // Points at the very edge may fall on either side of it by rounding.
      constexpr float kRounding = 1e-4f;
      const float across = zone->cutU * uv.x + zone->cutV * uv.y;
      if (std::abs(glm::length(uv) - 1.0f) < kRounding || std::abs(across - zone->cutHigh) < kRounding ||
          std::abs(across - zone->cutLow) < kRounding) {
        ++atBorder;
        continue;
      }
      const Vec3 point = zone->centre + uv.x * zone->axisU + uv.y * zone->axisV;
      Refusal refusal;
      ilvWeight(a, point, record.point.normal, record.point.outgoing, rules, refusal);
      const bool accepted = refusal != Refusal::Distance && refusal != Refusal::Gradient;
      ASSERT_EQ(zoneContains(*zone, uv), accepted)
          << "number " << n << " at (" << uv.x << ", " << uv.y << "): " << refusalName(refusal) << ", across "
          << across << " of [" << zone->cutLow << ", " << zone->cutHigh << "]";
      ASSERT_TRUE(refusal == Refusal::None || !accepted) << refusalName(refusal);
      (accepted ? inside : outside)++;
      const Vec2 back = zoneCoordinates(*zone, point);
      EXPECT_NEAR(glm::length(back - uv), 0.0f, 1e-3f);
    }
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(outside, 300);
  EXPECT_LT(atBorder, (inside + outside) / 50);
  EXPECT_EQ(cut > 0, GetParam().cuts) << cut << " zones are cut";
  RecordProperty("points", fmt::format("{} inside, {} outside, {} zones cut", inside, outside, cut));
}

INSTANTIATE_TEST_SUITE_P(
    Rules, Zones,
    testing::Values(RuleSet{"refined", {{"preset", "draft"}}, false},
                    RuleSet{"paper", {{"preset", "draft"}, {"method.rules", "paper"}}, true},
                    RuleSet{"signed",
                            {{"preset", "draft"}, {"method.rules", "paper"}, {"ilv.gradient_test", "signed"}},
                            true},
                    RuleSet{"refined_absolute",
                            {{"preset", "draft"}, {"ilv.gradient_test", "absolute"}, {"ilv.S_E", "0.05"}},
                            true}),
    [](const testing::TestParamInfo<RuleSet>& rules) { return std::string(rules.param.name); });

TEST(Zones, RimIsTheAngleOfSCurv) {
  IlvParameters p;
  p.sCurv = std::cos(kPiD / 6.0);
  IndirectLightVector record;
  record.harmonicMean = record.leastDistance = 0.1f;
  record.point.footprint = 1e-3f;
  EXPECT_NEAR(validityZone(record, IlvRules(p, 1.0f))->rim, 1.0f / 3.0f, 1e-6f);
}

// ---- extremes ----

bool isFinite(const OverlayBatch& batch) {
  const auto finite = [](const Vec3& v) { return lightvane::isFinite(v); };
  for (const OverlayZone& z : batch.zones) {
    if (!finite(z.centre) || !finite(z.axisU) || !finite(z.axisV) || !std::isfinite(z.rim) ||
        !std::isfinite(z.cutU + z.cutV + z.cutLow + z.cutHigh)) {
      return false;
    }
  }
  for (const OverlayLine& l : batch.lines) {
    if (!finite(l.from) || !finite(l.to) || !std::isfinite(l.widthPixels)) return false;
  }
  for (const OverlayMarker& m : batch.markers) {
    if (!finite(m.position) || !std::isfinite(m.sizePixels)) return false;
  }
  return true;
}

TEST(Overlays, NothingThatIsNoNumberGetsIntoABatch) {
  // Vectors of a black room, of an open field, and of sums that overflowed.
  const RenderFrame& base = mirrorFrame();
  std::vector<IndirectLightVector> indirect;
  for (const float mean : {0.0f, 1e-30f, 0.1f, kInfinity, std::nanf("")}) {
    for (const float light : {0.0f, 1e-38f, 1.0f, 1e38f, kInfinity, std::nanf("")}) {
      for (const float slope : {0.0f, 1e-38f, 1.0f, 1e38f, kInfinity, std::nanf("")}) {
        for (const float footprint : {0.0f, 1e-3f, kInfinity}) {
          IndirectLightVector r;
          r.arithmeticMean = r.harmonicMean = r.leastDistance = mean;
          r.energy = r.irradiance = Rgb(light);
          for (Vec3& g : r.gradient) g = Vec3(slope, 0.0f, slope);
          r.point.footprint = footprint;
          indirect.push_back(r);
        }
      }
    }
  }
  std::vector<DirectLightVector> direct;
  for (const float light : {0.0f, 1e-38f, 1.0f, 1e38f, kInfinity, std::nanf("")}) {
    for (const float angle : {0.0f, 1.0f, 20.0f, kInfinity, std::nanf("")}) {
      for (const float length : {0.0f, 1.0f, std::nanf("")}) {
        DirectLightVector r;
        r.energy = Rgb(light);
        r.solidAngle = angle;
        r.direction = Vec3(0.0f, length, 0.0f);
        direct.push_back(r);
      }
    }
  }
  indirect.push_back(indirect.front());
  indirect.back().point.position = Vec3(std::nanf(""));
  RenderFrame frame = base;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->direct.resize(frame.scene->lights.size());
  snapshot->direct[0] = snapshot->direct[0].with(direct, [](const auto&) { return 0.1f; });
  snapshot->indirect = snapshot->indirect.with(indirect, [](const auto&) { return 0.1f; });
  frame.snapshot = snapshot;
  for (const IlvGradientTest test :
       {IlvGradientTest::Off, IlvGradientTest::Signed, IlvGradientTest::Absolute}) {
    for (const auto& coloring : kVectorColoringNames) {
      frame.parameters.vectors.ilv.gradientTest = test;
      OverlayStyle style = everything();
      style.coloring = coloring.value;
      for (std::uint32_t n = 0; n < direct.size(); ++n) style.selected.push_back({0, n});
      const OverlayBatch batch = buildOverlay(frame, style);
      EXPECT_TRUE(isFinite(batch)) << coloring.name;
      EXPECT_GT(batch.markers.size(), indirect.size() - 2);
    }
  }
}

TEST(Overlays, AreEmptyWithoutVectors) {
  const RenderFrame naive =
      renderShipped("cornell.toml", 16, {{"method.name", "naive"}, {"naive.samples", "8"}});
  for (const RenderFrame& frame : {naive, RenderFrame{}}) {
    const OverlayBatch batch = buildOverlay(frame, everything());
    EXPECT_TRUE(batch.markers.empty() && batch.lines.empty() && batch.zones.empty() && batch.counts.empty() &&
                batch.notes.empty());
    for (const auto build : {directMarkers, directGlyphs, indirectMarkers, validityZones, directZones,
                             gradientGlyphs, mirrorImages}) {
      const OverlayBatch one = build(frame, everything());
      EXPECT_TRUE(one.markers.empty() && one.lines.empty() && one.zones.empty() && one.counts.empty() &&
                  one.notes.empty());
    }
  }
}

// ---- what is shown ----

std::set<std::uint32_t> numbersOf(const OverlayBatch& batch) {
  std::set<std::uint32_t> numbers;
  for (const OverlayMarker& marker : batch.markers) numbers.insert(marker.record.number);
  return numbers;
}

TEST(Overlays, ThinningIsStable) {
  const RenderFrame& frame = mirrorFrame();
  const std::size_t total = frame.snapshot->indirect.size();
  OverlayStyle style;
  std::set<std::uint32_t> more;
  for (const std::size_t most : {total, total - 1, total / 3, total / 10, std::size_t{1}, std::size_t{0}}) {
    style.mostShown = most;
    const OverlayBatch batch = indirectMarkers(frame, style);
    EXPECT_LE(batch.markers.size(), std::max<std::size_t>(1, most));
    EXPECT_GE(4 * batch.markers.size() + 4, most) << "no more is left out than has to be";
    const std::set<std::uint32_t> shown = numbersOf(batch);
    if (!more.empty()) {
      EXPECT_TRUE(std::includes(more.begin(), more.end(), shown.begin(), shown.end()))
          << "of " << most << " some were not among more";
    }
    more = shown;
    EXPECT_EQ(numbersOf(indirectMarkers(frame, style)), shown);
    const std::string count = countText(total);
    EXPECT_THAT(batch.counts, Contains(HasSubstr(count)));
    EXPECT_EQ(batch.counts.front().starts_with("every "), shown.size() < total) << batch.counts.front();
  }
}

TEST(Overlays, CountsAreSaidAsPeopleSayThem) {
  const RenderFrame& frame = mirrorFrame();
  const std::size_t total = frame.snapshot->indirect.size();
  OverlayStyle style;
  style.mostShown = total / 20;
  EXPECT_THAT(indirectMarkers(frame, style).counts.front(), testing::StartsWith("every 32nd of "));
  style.mostShown = total / 10;
  EXPECT_THAT(indirectMarkers(frame, style).counts.front(), testing::StartsWith("every 16th of "));
  const std::vector<std::string> none = directMarkers(frame, style).counts;
  style.until = BirthTime{};
  for (const std::string& count : directMarkers(frame, style).counts)
    EXPECT_THAT(count, testing::Not(HasSubstr(" 0 of "))) << none.front();
}

TEST(Overlays, SelectedVectorsAreShownWhateverIsThinned) {
  OverlayStyle style;
  style.mostShown = 1;
  style.selected = {{kNone, 17}};
  style.indirectMarkers.shown = style.directMarkers.shown = false;
  style.zones.shown = style.gradients.shown = false;
  const OverlayBatch batch = buildOverlay(mirrorFrame(), style);
  ASSERT_EQ(batch.markers.size(), 1u);
  EXPECT_EQ(batch.markers.front().record, style.selected.front());
  EXPECT_EQ(batch.zones.size(), 1u);
  EXPECT_TRUE(batch.legend.empty());
  style.indirectMarkers.shown = true;
  EXPECT_EQ(buildOverlay(mirrorFrame(), style).markers.back().record, style.selected.front());
}

TEST(Overlays, TimeHidesWhatCameLater) {
  const RenderFrame& frame = mirrorFrame();
  OverlayStyle style;
  style.until = BirthTime{2, 5};
  const OverlayBatch batch = indirectMarkers(frame, style);
  std::size_t wanted = 0;
  for (std::size_t n = 0; n < frame.snapshot->indirect.size(); ++n) {
    const Birth& birth = frame.snapshot->indirect[n].birth;
    wanted += birth.pass < 2 || (birth.pass == 2 && birth.order <= 5);
  }
  EXPECT_GT(wanted, 20u);
  EXPECT_EQ(batch.markers.size(), wanted);
  EXPECT_THAT(batch.counts, Contains(fmt::format("{} of {} ILVs computed by then", wanted,
                                                 countText(frame.snapshot->indirect.size()))));
  style.until = BirthTime{};
  style.selected = {{kNone, 17}};
  EXPECT_EQ(indirectMarkers(frame, style).markers.size(), 1u) << "also of what is selected";
}

TEST(Overlays, OccludedVectorsAreHollow) {
  const RenderFrame& frame = mirrorFrame();
  int hollow = 0;
  for (const OverlayMarker& marker : directMarkers(frame, {}).markers) {
    const DirectLightVector* record = findDirect(frame, marker.record);
    ASSERT_NE(record, nullptr);
    const bool isHollow = marker.shape == MarkerShape::Ring || marker.shape == MarkerShape::HollowDiamond;
    EXPECT_EQ(isHollow, record->occluded);
    EXPECT_EQ(marker.color, categoryColor(ColorFamily::Cool, marker.record.light));
    hollow += isHollow;
  }
  EXPECT_GT(hollow, 0);
}

TEST(Overlays, ASelectedVectorIsAlsoMarkedWhereAMirrorShowsIt) {
  const RenderFrame& frame = mirrorFrame();
  OverlayStyle all;
  all.mirrorImages.shown = true;
  const OverlayBatch images = mirrorImages(frame, all);
  ASSERT_FALSE(images.markers.empty());
  const OverlayMarker& image = images.markers.front();
  OverlayStyle style;
  style.mirrorImages.shown = false;
  style.indirectMarkers.shown = style.directMarkers.shown = false;
  const auto isImage = [](const OverlayMarker& m) { return m.inMirror; };
  EXPECT_EQ(std::ranges::count_if(buildOverlay(frame, style).markers, isImage), 0);
  style.selected = {image.record};
  const OverlayBatch batch = buildOverlay(frame, style);
  const auto found = std::ranges::find_if(batch.markers, isImage);
  ASSERT_NE(found, batch.markers.end());
  EXPECT_EQ(found->record, image.record);
  EXPECT_EQ(found->position, image.position);
}

TEST(Overlays, CrossesOutWhatAChangeMakesStale) {
  const RenderFrame& frame = mirrorFrame();
  const auto crossed = [&](const StaleKinds& stale) {
    OverlayStyle style;
    style.stale = stale;
    style.mostShown = 1'000'000;
    std::pair<std::size_t, std::size_t> counts;
    for (const OverlayMarker& marker : buildOverlay(frame, style).markers) {
      if (marker.shape == MarkerShape::Cross) ++(marker.record.isIndirect() ? counts.first : counts.second);
    }
    return counts;
  };
  const std::size_t ilvs = frame.snapshot->indirect.size();
  const std::size_t dlvs = frame.snapshot->directCount();
  EXPECT_EQ(crossed({}), std::pair(0UL, 0UL));
  EXPECT_EQ(crossed({.indirect = true}), std::pair(ilvs, 0UL));
  EXPECT_EQ(crossed({.direct = true}), std::pair(0UL, dlvs));
}

TEST(Overlays, EveryColouringHasALegendInOrder) {
  OverlayStyle style;
  for (const auto& coloring : kVectorColoringNames) {
    style.coloring = coloring.value;
    const OverlayBatch batch = indirectMarkers(mirrorFrame(), style);
    ASSERT_GE(batch.legend.size(), coloring.value == VectorColoring::Key ? 1u : 2u) << coloring.name;
    std::set<std::string> texts;
    for (const OverlayLegendEntry& entry : batch.legend) texts.insert(entry.text);
    EXPECT_EQ(texts.size(), batch.legend.size()) << coloring.name;
  }
}

TEST(Overlays, GradientsPointToWhereItIsBrighter) {
  const RenderFrame& frame = mirrorFrame();
  const OverlayBatch batch = gradientGlyphs(frame, {});
  ASSERT_GT(batch.lines.size(), 50u);
  const IlvRules rules(frame.parameters.vectors.ilv, frame.scene->diagonal);
  std::size_t found = 0;
  for (std::size_t n = 0; n < frame.snapshot->indirect.size(); ++n) {
    const IndirectLightVector& record = frame.snapshot->indirect[n];
    for (const OverlayLine& line : batch.lines) {
      if (line.from != record.point.position) continue;
      const IlvCandidate a = makeCandidate(record, rules);
      const Vec3 arrow = line.to - line.from;
      EXPECT_GT(glm::dot(arrow, a.gradient), 0.0f);
      // Float positions around 1 leave 1e-7 of them; arrows are some 1e-3 long.
      const float change = glm::length(a.gradient) * a.radius / a.brightness;
      EXPECT_NEAR(glm::length(arrow), std::min(2.0f, change) * a.radius, 1e-6f + 1e-3f * glm::length(arrow));
      ++found;
      break;
    }
  }
  EXPECT_GT(found, 50u);
  EXPECT_THAT(batch.scales, Contains(HasSubstr("100 %")));
}

TEST(Overlays, ConeSubtendsTheSolidAngle) {
  const RenderFrame& frame = mirrorFrame();
  for (std::uint32_t n = 0; n < frame.snapshot->direct[0].size(); ++n) {
    const DirectLightVector& record = frame.snapshot->direct[0][n];
    const OverlayBatch cone = solidAngleCone(frame, {0, n}, {});
    if (record.occluded) {
      EXPECT_TRUE(cone.lines.empty());
      continue;
    }
    ASSERT_FALSE(cone.lines.empty());
    const Vec3 edge = glm::normalize(cone.lines[0].from - record.point.position);
    const float cosine = glm::dot(edge, glm::normalize(record.direction));
    ASSERT_NEAR(kTwoPi * (1.0f - cosine), record.solidAngle, 1e-4f) << "number " << n;
  }
  EXPECT_TRUE(solidAngleCone(frame, {kNone, 0}, {}).lines.empty());
}

TEST(Overlays, DrawInOrderWithOneLegend) {
  OverlayStyle style = everything();
  const OverlayBatch batch = buildOverlay(mirrorFrame(), style);
  EXPECT_FALSE(batch.zones.empty());
  EXPECT_FALSE(batch.lines.empty());
  EXPECT_FALSE(batch.markers.empty());
  EXPECT_NE(batch.zones.front().record.light, kNone) << "DLVs first";
  EXPECT_EQ(batch.zones.back().record.light, kNone);
  std::set<std::string> texts;
  for (const OverlayLegendEntry& entry : batch.legend) texts.insert(entry.text);
  EXPECT_EQ(texts.size(), batch.legend.size());
  for (const std::vector<std::string>& said : {batch.counts, batch.scales, batch.notes})
    EXPECT_EQ(std::set<std::string>(said.begin(), said.end()).size(), said.size());
}

// Rings are the marks of DLVs that no light reaches: those that it does reach keep their discs in the legend,
// too, where rims are drawn around them.
TEST(Overlays, OfDirectVectorsSayWhatTheirMarksAre) {
  OverlayStyle style = everything();
  const auto shapeOfLight = [&] {
    const OverlayBatch batch = buildOverlay(mirrorFrame(), style);
    for (const OverlayLegendEntry& entry : batch.legend) {
      if (entry.text.starts_with("DLV: ") && entry.text != "DLV: no light arrives") return entry.shape;
    }
    ADD_FAILURE() << "no light in the legend";
    return MarkerShape::Diamond;
  };
  EXPECT_EQ(shapeOfLight(), MarkerShape::Disc);
  style.directMarkers.shown = style.directGlyphs.shown = false;
  EXPECT_EQ(shapeOfLight(), MarkerShape::Ring);
}

TEST(Overlays, OfDirectVectorsAloneExplainDiamonds) {
  const OverlayBatch batch = directMarkers(mirrorFrame(), {});
  const auto isDiamond = [](const auto& each) { return each.shape == MarkerShape::Diamond; };
  ASSERT_TRUE(std::any_of(batch.markers.begin(), batch.markers.end(), isDiamond));
  EXPECT_TRUE(std::any_of(batch.legend.begin(), batch.legend.end(), isDiamond));
}

// ---- mirrors ----

// Vectors that were asked for by way of the mirror block lie where a pixel sees them in it: their images are
// in those pixels.
void expectImagesWhereTheCameraSeesThem(const RenderFrame& frame) {
  const OverlayBatch images = mirrorImages(frame, {});
  ASSERT_FALSE(images.markers.empty());
  std::size_t wanted = 0;
  std::size_t found = 0;
  for (std::uint32_t n = 0; n < frame.snapshot->indirect.size(); ++n) {
    const IndirectLightVector& record = frame.snapshot->indirect[n];
    if (!record.birth.throughSpecular) continue;
    ++wanted;
    for (const OverlayMarker& marker : images.markers) {
      if (marker.record != RecordRef{kNone, n}) continue;
      const std::optional<Vec3> seen = frame.camera.project(marker.position);
      ASSERT_TRUE(seen);
      const auto width = static_cast<std::uint32_t>(frame.region.width);
      const float x = static_cast<float>(record.birth.pixel % width) + 0.5f;
      const float y = static_cast<float>(record.birth.pixel / width) + 0.5f;
      found += std::hypot(seen->x - x, seen->y - y) < 0.01f;
      EXPECT_TRUE(marker.inMirror);
      EXPECT_TRUE(marker.shape == MarkerShape::Triangle);
    }
  }
  EXPECT_GT(wanted, 10u);
  // Two mirrors in a row show some vectors that one mirror does not.
  EXPECT_GE(static_cast<double>(found), 0.95 * static_cast<double>(wanted)) << found << " of " << wanted;
  // And every image is in a pixel that sees something by way of a mirror.
  std::size_t inMirror = 0;
  for (const OverlayMarker& marker : images.markers) {
    const Vec3 seen = *frame.camera.project(marker.position);
    const auto pixel = static_cast<std::uint32_t>(seen.y) * static_cast<std::uint32_t>(frame.region.width) +
                       static_cast<std::uint32_t>(seen.x);
    const PixelPoints points = pointsOfPixel(*frame.points, pixel);
    bool through = false;
    for (std::uint32_t i = 0; i < points.count; ++i)
      through = through || frame.points->tiles[points.tile].points[points.first + i].throughSpecular;
    inMirror += through;
  }
  // Pixels at the mirror's edge are of their centres.
  EXPECT_GE(static_cast<double>(inMirror), 0.9 * static_cast<double>(images.markers.size()));
}

TEST(MirrorImages, AreWhereTheCameraSeesTheVectors) { expectImagesWhereTheCameraSeesThem(mirrorFrame()); }

TEST(MirrorImages, AreWhereAnOrthographicCameraSeesThem) {
  expectImagesWhereTheCameraSeesThem(orthographicFrame());
}

TEST(MirrorImages, AreNoneWithoutMirrors) {
  EXPECT_TRUE(mirrorImages(renderShipped("cornell.toml", 32), everything()).markers.empty());
}

}  // namespace
}  // namespace lightvane::inspect_test
