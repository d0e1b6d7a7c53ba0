// The zones that the shaders draw, pixel by pixel against the rules themselves: ilvWeight, which the renderer
// asks.

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/gl/overlay_layer.h"
#include "core/base/random.h"
#include "core/inspect/overlays.h"
#include "core/vectors/validity.h"
#include "tests/gl/memory_gl.h"
#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

constexpr int kZonePicture = 128;  // pixels

struct ZoneRules {
  const char* name;
  inspect_test::Settings settings;
  bool cuts;  ///< the gradient's bound cuts some zones
};
void PrintTo(const ZoneRules& rules, std::ostream* out) { *out << rules.name; }

/// Looks at a vector's whole zone, up to 50 degrees askew: no ray passes over the horizon of its plane, which
/// is another 30 degrees away. `random`: from which side, and how much askew.
Camera cameraTowards(const VectorPoint& place, float radius, const Vec2& random) {
  const float tilt = random.x * kPi * 50.0f / 180.0f, turn = kTwoPi * random.y;
  const Vec3 bitangent = glm::cross(place.normal, place.tangent);
  const Vec3 side = std::cos(turn) * place.tangent + std::sin(turn) * bitangent;
  const Vec3 away = std::cos(tilt) * place.normal + std::sin(tilt) * side;
  Camera camera;
  camera.position = place.position + 4.0f * radius * away;
  camera.forward = -away;
  camera.right = glm::normalize(glm::cross(away, std::cos(tilt) * side - std::sin(tilt) * place.normal));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.tanHalfFovY = 0.4f;
  camera.width = camera.height = kZonePicture;
  return camera;
}

/// What the rules say of the points of a vector's plane that a camera sees.
class RulesOfAPlane {
 public:
  RulesOfAPlane(const IndirectLightVector& record, const IlvRules& rules, const Camera& camera)
      : point_(record.point), candidate_(makeCandidate(record, rules)), rules_(rules), camera_(camera) {}

  Refusal at(const Vec2& pixel) const {
    const Sight sight = camera_.sight(pixel.x, pixel.y);
    const float distance =
        glm::dot(point_.position - sight.origin, point_.normal) / glm::dot(sight.direction, point_.normal);
    Refusal refusal;
    ilvWeight(candidate_, sight.origin + distance * sight.direction, point_.normal, point_.outgoing, rules_,
              refusal);
    return refusal;
  }

  /// Whether the rules say something else at some of 16 places `distance` pixels around.
  bool changesWithin(float distance, const Vec2& pixel) const {
    const bool isValid = at(pixel) == Refusal::None;
    for (int i = 0; i < 16; ++i) {
      const float angle = kTwoPi * static_cast<float>(i) / 16.0f;
      const Vec2 other = pixel + distance * Vec2(std::cos(angle), std::sin(angle));
      if ((at(other) == Refusal::None) != isValid) return true;
    }
    return false;
  }

 private:
  const VectorPoint& point_;
  IlvCandidate candidate_;
  const IlvRules& rules_;
  const Camera& camera_;
};

class ZonePixels : public GlTest, public testing::WithParamInterface<ZoneRules> {
 protected:
  /// The zone alone, white on black, with no part of it clear.
  Image<Color8> drawn(OverlayZone zone, const Camera& camera) {
    zone.color = {255, 255, 255, 255};
    OverlayBatch batch;
    batch.zones = {zone};
    OverlayView view;
    view.batches = {std::make_shared<const OverlayBatch>(std::move(batch))};
    view.camera = camera;
    view.placement = {0, 0, kZonePicture, kZonePicture, Vec2(0.0f), 1.0f};
    view.pen.zoneFill = view.pen.zoneRim = 1.0f;
    layer_.update(view);
    target_.clear({0, 0, 0, 255});
    layer_.composite(target_, 1.0f);
    return target_.read();
  }

  OverlayLayer layer_ = OverlayLayer::create(gl(), {}).value();
  const Framebuffer target_{gl(), kZonePicture, kZonePicture};
};

// Of vectors of a real rendering, of walls that face anywhere, each seen from a side of its own: a pixel is
// covered where ilvWeight refuses its point for nothing, and bare where it does.
TEST_P(ZonePixels, AreThoseThatTheRulesAccept) {
  constexpr std::size_t kZones = 60;
  constexpr int kEvery = 3;  // pixels
  // A pixel that an edge crosses is covered in part, and the shader's distance from an edge is that of the
  // tangent.
  constexpr float kEdgePixels = 1.5f;

  const RenderFrame frame = inspect_test::renderShipped("cornell-glossy.toml", 40, GetParam().settings);
  const IlvRules rules(frame.parameters.vectors.ilv, frame.scene->diagonal);
  const std::vector<OverlayZone> zones = validityZones(frame, {}).zones;
  ASSERT_GE(zones.size(), kZones);
  const RandomKey key = randomKey(11);
  int valid = 0, tooFar = 0, cut = 0;
  for (std::size_t i = 0; i < kZones; ++i) {
    const OverlayZone& zone = zones[i * zones.size() / kZones];
    const std::uint32_t number = zone.record.number;
    const IndirectLightVector& record = frame.snapshot->indirect[number];
    const Camera camera =
        cameraTowards(record.point, ilvRadius(record, rules), uniform2(key.with(number), 0, 0));
    const RulesOfAPlane said(record, rules, camera);
    const Image<Color8> picture = drawn(zone, camera);
    for (int y = 0; y < kZonePicture; y += kEvery) {
      for (int x = 0; x < kZonePicture; x += kEvery) {
        const Vec2 pixel = Vec2(x, y) + 0.5f;
        if (said.changesWithin(kEdgePixels, pixel)) continue;
        const Refusal refusal = said.at(pixel);
        const bool isValid = refusal == Refusal::None;
        const int covered = picture.at(x, y).r;
        // A zone that is cut to less than a pixel may pass between the places that changesWithin looks at.
        ASSERT_TRUE(isValid ? covered == 255 : covered < 128)
            << "ILV " << number << ", pixel (" << x << ", " << y << "): covered by " << covered
            << " of 255, refused for: " << refusalName(refusal);
        valid += isValid;
        tooFar += refusal == Refusal::Distance;
        cut += refusal == Refusal::Gradient;
      }
    }
  }
  EXPECT_GT(valid, 1000);
  EXPECT_GT(tooFar, 1000);
  if (GetParam().cuts) {
    EXPECT_GT(cut, 1000);
  } else {
    EXPECT_EQ(cut, 0);
  }
  RecordProperty("pixels", fmt::format("{} valid, {} too far, {} cut", valid, tooFar, cut));
}

INSTANTIATE_TEST_SUITE_P(
    Rules, ZonePixels,
    testing::Values(ZoneRules{"refined", {{"preset", "draft"}}, false},
                    ZoneRules{"paper", {{"preset", "draft"}, {"method.rules", "paper"}}, true},
                    ZoneRules{
                        "signed",
                        {{"preset", "draft"}, {"method.rules", "paper"}, {"ilv.gradient_test", "signed"}},
                        true}),
    [](const testing::TestParamInfo<ZoneRules>& rules) { return std::string(rules.param.name); });

}  // namespace
}  // namespace lightvane
