#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/gl/overlay_layer.h"
#include "app/gl/picture_layer.h"
#include "tests/gl/golden.h"
#include "tests/gl/memory_gl.h"
#include "tests/gl/test_pictures.h"

namespace lightvane {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr Color8 kOrange = {230, 159, 0, 255}, kBlue = {86, 180, 233, 255}, kGreen = {0, 158, 115, 255},
                 kWhite = {245, 245, 245, 255};

/// Looks down on the floor y = 0, on which the origin is in the picture's middle.
Camera floorCamera() {
  Camera camera;
  camera.position = {0.0f, 1.2f, 1.6f};
  camera.forward = glm::normalize(-camera.position);
  camera.up = glm::normalize(glm::cross(camera.right, camera.forward));
  camera.tanHalfFovY = 0.5f;
  camera.width = kWidth / 2;
  camera.height = kHeight / 2;
  return camera;
}

Camera orthographic(Camera camera) {
  camera.projection = Projection::Orthographic;
  camera.tanHalfFovY = 1.0f;
  camera.halfHeight = 0.9f;
  return camera;
}

constexpr Vec3 kBallCentre{0.35f, 0.3f, 0.2f};
constexpr float kBallRadius = 0.3f;

/// What a camera sees of the floor, and of a ball that lies on it where there is one.
std::shared_ptr<const ImageFloat> depthOf(const Camera& camera, bool withBall) {
  auto depth = std::make_shared<ImageFloat>(camera.width, camera.height, kInfinity);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto [origin, direction] =
          camera.sight(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      if (direction.y < 0.0f) depth->at(x, y) = -origin.y / direction.y;
      const Vec3 from = origin - kBallCentre;
      const float b = glm::dot(from, direction), c = glm::dot(from, from) - square(kBallRadius);
      if (withBall && b * b > c) depth->at(x, y) = std::min(depth->at(x, y), -b - std::sqrt(b * b - c));
    }
  }
  return depth;
}

/// A picture of that: grey, nearer is brighter, with lines on the floor.
ViewImage pictureOf(const Camera& camera, const ImageFloat& depth) {
  ViewImage image = makeView(ViewKind::Color, camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto [origin, direction] =
          camera.sight(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Vec3 point = origin + depth.at(x, y) * direction;
      const bool onFloor = point.y < 1e-3f;
      const int field = static_cast<int>(std::floor(point.x * 4.0f) + std::floor(point.z * 4.0f));
      const float grey = onFloor ? (field % 2 == 0 ? 0.10f : 0.14f) : 0.3f + 0.5f * (point.y - kBallCentre.y);
      std::fill_n(&image.values[static_cast<std::size_t>((y * camera.width + x) * 3)], 3, grey);
    }
  }
  return image;
}

OverlayZone zoneAt(float x, float z, float radius, const Color8& color) {
  OverlayZone zone{};
  zone.centre = {x, 0.0f, z};
  zone.axisU = {radius, 0.0f, 0.0f};
  zone.axisV = {0.0f, 0.0f, radius};
  zone.cutLow = -1.0f;
  zone.cutHigh = 1.0f;
  zone.color = color;
  return zone;
}

OverlayMarker markerAt(const Vec3& position, float size, const Color8& color, MarkerShape shape) {
  return {position, size, color, shape, {}, false};
}

/// Everything at once.
OverlayBatch fullBatch() {
  OverlayBatch batch;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) {
      const float x = -0.8f + 0.4f * static_cast<float>(i), z = -0.7f + 0.4f * static_cast<float>(j);
      batch.zones.push_back(zoneAt(x, z, 0.17f, (i + j) % 2 == 0 ? kBlue : kOrange));
      batch.lines.push_back({{x, 0.0f, z}, {x, 0.2f, z}, 1.5f, kWhite, true});
      batch.markers.push_back(markerAt({x, 0.0f, z}, 7.0f, kGreen, static_cast<MarkerShape>((i + j) % 4)));
    }
  }
  return batch;
}

std::shared_ptr<const OverlayBatch> shared(OverlayBatch batch) {
  return std::make_shared<const OverlayBatch>(std::move(batch));
}

class Overlays : public GlTest {
 protected:
  OverlayView viewOf(OverlayBatch batch, bool withBall = false) {
    return {{shared(std::move(batch))},
            depthOf(floorCamera(), withBall),
            floorCamera(),
            Placement::fit(0, 0, kWidth, kHeight, kWidth / 2, kHeight / 2),
            {}};
  }

  /// The overlay over the picture that the view's depth belongs to.
  Image<Color8> drawn(const OverlayView& view, float opacity = 1.0f) {
    const Framebuffer target(gl(), kWidth, kHeight);
    target.clear({30, 30, 33, 255});
    PictureTexture picture(gl());
    picture.upload(pictureOf(view.camera, *view.depth), testTable());
    pictures_.draw(target, picture, {}, view.placement);
    layer_.update(view);
    layer_.composite(target, opacity);
    return target.read();
  }
  void expectGoldenView(const OverlayView& view, const std::string& name, float opacity = 1.0f) {
    OverlayView without = view;
    without.batches.clear();
    expectGoldenOverlay(gl(), drawn(view, opacity), drawn(without), name);
  }

  /// The middle of what the overlay alone draws, in framebuffer pixels.
  Vec2 middleOfLight(const OverlayView& view) {
    layer_.update(view);
    const Framebuffer target(gl(), kWidth, kHeight);
    target.clear({0, 0, 0, 255});
    layer_.composite(target, 1.0f);
    const Image<Color8> image = target.read();
    Vec2 sum(0.0f);
    float weight = 0.0f;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto brightness = static_cast<float>(image.at(x, y).r);
        sum += brightness * (Vec2(x, y) + 0.5f);
        weight += brightness;
      }
    }
    return sum / weight;
  }

  OverlayLayer layer_ = OverlayLayer::create(gl(), {}).value();
  const PictureLayer pictures_ = PictureLayer::create(gl(), {}).value();
};

TEST_F(Overlays, ZonesWholeCutAndRimmed) {
  OverlayBatch batch;
  const auto add = [&batch](int column, int row, const Color8& color) -> OverlayZone& {
    const float x = -0.55f + 0.55f * static_cast<float>(column), z = -0.35f + 0.6f * static_cast<float>(row);
    return batch.zones.emplace_back(zoneAt(x, z, 0.24f, color));
  };
  add(0, 0, kBlue);
  OverlayZone& above = add(1, 0, kOrange);  // cut on one side: the gradient with its sign
  above.cutU = 1.0f, above.cutV = -0.5f, above.cutHigh = 0.3f, above.cutLow = -10.0f;
  OverlayZone& band = add(2, 0, kGreen);  // on both: its absolute value
  band.cutU = 1.0f, band.cutV = 0.6f, band.cutLow = -0.4f, band.cutHigh = 0.4f;
  add(0, 1, kBlue).rim = 0.3f;
  OverlayZone& both = add(1, 1, kOrange);
  both.rim = 0.3f, both.cutV = 1.0f, both.cutHigh = 0.2f, both.cutLow = -10.0f;
  OverlayZone& clear = add(2, 1, kGreen);
  clear.color.a = 110, clear.rim = 0.3f;
  expectGoldenView(viewOf(batch), "overlay_zones");
}

TEST_F(Overlays, LinesWithHeads) {
  OverlayBatch batch;
  for (int i = 0; i < 12; ++i) {
    const float angle = kTwoPi * static_cast<float>(i) / 12.0f;
    const Vec3 direction(std::cos(angle), 0.0f, std::sin(angle));
    batch.lines.push_back({0.2f * direction, 0.7f * direction, 1.0f + 0.25f * static_cast<float>(i),
                           i % 2 == 0 ? kOrange : kBlue, i % 3 != 0});
  }
  batch.lines.push_back({{0.0f, 0.0f, 0.0f}, {0.0f, 0.3f, 0.0f}, 2.0f, kWhite, true});  // upright
  batch.lines.push_back(
      {{0.0f, 0.0f, 0.1f}, {0.01f, 0.0f, 0.1f}, 1.5f, kWhite, true});  // shorter than a head
  batch.lines.push_back({{-0.1f, 0.0f, 0.1f}, {-0.1f, 0.0f, 0.1f}, 4.0f, kWhite, true});  // no length
  batch.lines.push_back(
      {{-0.7f, 0.0f, 0.4f}, {-0.9f, 1.0f, 3.0f}, 2.0f, kGreen, true});  // to behind the camera
  expectGoldenView(viewOf(batch), "overlay_lines");
}

TEST_F(Overlays, MarkersOfEveryShape) {
  OverlayBatch batch;
  constexpr std::array<Color8, 4> kColors = {kOrange, kBlue, kGreen, kWhite};
  for (int shape = 0; shape < 4; ++shape) {
    for (int i = 0; i < 6; ++i) {
      batch.markers.push_back(
          markerAt({-0.65f + 0.26f * static_cast<float>(i), 0.0f, -0.4f + 0.25f * static_cast<float>(shape)},
                   4.0f + 3.0f * static_cast<float>(i), kColors[static_cast<std::size_t>(shape)],
                   static_cast<MarkerShape>(shape)));
    }
  }
  expectGoldenView(viewOf(batch), "overlay_markers");
}

TEST_F(Overlays, AtTwiceTheScale) {
  OverlayView view = viewOf(fullBatch());
  view.pen.uiScale = 2.0f;
  expectGoldenView(view, "overlay_scale_2");
}

TEST_F(Overlays, WhatLiesBehindASurfaceIsDimmed) {
  expectGoldenView(viewOf(fullBatch(), true), "overlay_behind");
}

TEST_F(Overlays, WhatIsSeenInAMirrorIsNotDimmedByIt) {
  OverlayBatch batch;
  batch.markers = {markerAt({0.35f, 0.0f, -0.3f}, 9.0f, kWhite, MarkerShape::Disc)};  // behind the ball
  OverlayView view = viewOf(batch, true);
  const Image<Color8> dimmed = drawn(view);
  view.pen.behind = 1.0f;
  const Image<Color8> whole = drawn(view);
  EXPECT_NE(dimmed, whole);
  batch.markers.front().inMirror = true;
  EXPECT_EQ(drawn(viewOf(batch, true)), whole);
}

TEST_F(Overlays, HalfOpaque) { expectGoldenView(viewOf(fullBatch(), true), "overlay_opacity", 0.5f); }

TEST_F(Overlays, BesideAPanelZoomedIn) {
  OverlayView view = viewOf(fullBatch(), true);
  view.placement = {100, 20, 200, 200, Vec2(-160.0f, -180.0f), 3.7f};
  expectGoldenView(view, "overlay_zoomed");
}

// Where Camera::project says a point is, there its marker is: under any placement, of any projection.
TEST_F(Overlays, AreWhereTheCameraProjectsThem) {
  for (const Placement& placement : {Placement{0, 0, kWidth, kHeight, Vec2(0.0f), 2.0f},
                                     Placement{40, 30, 250, 200, Vec2(-31.5f, 12.25f), 1.7f}}) {
    for (const Camera& camera : {floorCamera(), orthographic(floorCamera())}) {
      for (const Vec3& point : {Vec3(0.0f), Vec3(0.2f, 0.1f, -0.2f), Vec3(-0.1f, 0.0f, 0.1f)}) {
        OverlayBatch batch;
        batch.markers = {markerAt(point, 12.0f, kWhite, MarkerShape::Disc)};
        OverlayView view = viewOf(batch);
        view.camera = camera;
        view.depth = depthOf(camera, false);
        view.placement = placement;
        const Vec2 expected = placement.toFramebuffer(Vec2(camera.project(point).value()));
        EXPECT_LT(glm::distance(middleOfLight(view), expected), 0.05f) << expected.x << ", " << expected.y;
      }
    }
  }
}

// Zones and lines of an orthographic picture go the same way as its markers.
TEST_F(Overlays, OrthographicZonesAndLinesAreWhereTheCameraProjectsThem) {
  const Camera camera = orthographic(floorCamera());
  OverlayBatch zone;
  zone.zones = {zoneAt(0.2f, -0.1f, 0.2f, kWhite)};
  OverlayView view = viewOf(zone);
  view.camera = camera;
  view.depth = depthOf(camera, false);
  // A disc seen by parallel lines is an ellipse about its centre.
  Vec2 expected = view.placement.toFramebuffer(Vec2(camera.project({0.2f, 0.0f, -0.1f}).value()));
  EXPECT_LT(glm::distance(middleOfLight(view), expected), 0.1f);

  OverlayBatch line;
  const Vec3 from(-0.3f, 0.0f, 0.2f), to(0.1f, 0.4f, -0.4f);
  line.lines = {{from, to, 4.0f, kWhite, false}};
  view.batches = {shared(std::move(line))};
  expected = 0.5f * (view.placement.toFramebuffer(Vec2(camera.project(from).value())) +
                     view.placement.toFramebuffer(Vec2(camera.project(to).value())));
  EXPECT_LT(glm::distance(middleOfLight(view), expected), 0.1f);
}

// Records lie on the surface whose depth they are compared with, at any angle.
TEST_F(Overlays, NothingOnTheFloorIsBehindIt) {
  OverlayBatch batch;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      batch.markers.push_back(
          markerAt({-1.0f + 0.05f * static_cast<float>(i), 0.0f, -2.0f + 0.09f * static_cast<float>(j)}, 6.0f,
                   kWhite, MarkerShape::Disc));
    }
  }
  batch.zones.push_back(zoneAt(0.0f, -0.5f, 2.0f, kWhite));
  OverlayView view = viewOf(batch);
  view.camera.position = {0.0f, 0.05f, 1.6f};  // nearly along the floor
  view.camera.forward = {0.0f, 0.0f, -1.0f};
  view.camera.up = {0.0f, 1.0f, 0.0f};
  view.depth = depthOf(view.camera, false);
  const Image<Color8> dimmed = drawn(view);
  view.pen.behind = 1.0f;
  EXPECT_EQ(dimmed, drawn(view));
}

TEST_F(Overlays, WhatIsBehindTheCameraIsNotDrawn) {
  OverlayBatch batch;
  batch.markers = {markerAt({0.0f, 2.4f, 3.2f}, 20.0f, kWhite, MarkerShape::Disc)};
  batch.lines = {{{0.0f, 2.4f, 3.2f}, {0.3f, 2.5f, 3.4f}, 3.0f, kWhite, true}};
  batch.zones = {zoneAt(0.0f, 4.0f, 0.5f, kWhite)};
  EXPECT_EQ(drawn(viewOf(batch)), drawn(viewOf({})));
}

TEST_F(Overlays, NothingOnTheFloorIsBehindItInAnOrthographicPicture) {
  OverlayBatch batch;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const Vec3 point(-1.0f + 0.1f * static_cast<float>(i), 0.0f, -1.2f + 0.12f * static_cast<float>(j));
      batch.markers.push_back(markerAt(point, 6.0f, kWhite, MarkerShape::Disc));
    }
  }
  batch.zones.push_back(zoneAt(0.0f, -0.1f, 0.9f, kWhite));
  OverlayView view = viewOf(batch);
  // From far away, too: where such a camera stands says nothing about what an eye tells apart.
  for (const float away : {0.0f, 100.0f}) {
    view.camera = orthographic(floorCamera());
    view.camera.position -= away * view.camera.forward;
    view.depth = depthOf(view.camera, false);
    view.pen.behind = 0.25f;
    const Image<Color8> dimmed = drawn(view);
    view.pen.behind = 1.0f;
    EXPECT_EQ(dimmed, drawn(view)) << away;
    // And what lies below the floor is.
    OverlayView below = view;
    OverlayBatch marker;
    marker.markers = {markerAt({0.0f, -0.05f, 0.0f}, 12.0f, kWhite, MarkerShape::Disc)};
    below.batches = {shared(std::move(marker))};
    const Image<Color8> bright = drawn(below);
    below.pen.behind = 0.25f;
    EXPECT_NE(bright, drawn(below)) << away;
  }
}

TEST_F(Overlays, WhatIsBehindAnOrthographicCameraIsNotDrawn) {
  OverlayBatch batch;
  const Camera camera = orthographic(floorCamera());
  const Vec3 behind = camera.position - 0.1f * camera.forward;
  batch.markers = {markerAt(behind, 20.0f, kWhite, MarkerShape::Disc)};
  batch.lines = {{behind, behind + 0.3f * camera.right, 3.0f, kWhite, true}};
  batch.zones = {zoneAt(0.0f, 4.0f, 0.5f, kWhite)};
  batch.zones.front().centre = behind;
  batch.zones.front().axisU = 0.1f * camera.right;
  batch.zones.front().axisV = 0.1f * camera.up;
  OverlayView view = viewOf(batch);
  view.camera = camera;
  view.depth = depthOf(camera, false);
  OverlayView empty = viewOf({});
  empty.camera = camera;
  empty.depth = view.depth;
  EXPECT_EQ(drawn(view), drawn(empty));
}

TEST_F(Overlays, StayWithinTheirPicture) {
  OverlayBatch batch;
  batch.zones = {zoneAt(0.0f, 0.0f, 20.0f, kWhite)};  // to behind the camera
  OverlayView view = viewOf(batch);
  view.placement.offset = {100.0f, 60.0f};
  view.placement.zoom = 1.0f;
  layer_.update(view);
  const Framebuffer target(gl(), kWidth, kHeight);
  target.clear({0, 0, 0, 255});
  layer_.composite(target, 1.0f);
  const Image<Color8> image = target.read();
  EXPECT_EQ(image.at(99, 100), (Color8{0, 0, 0, 255}));
  EXPECT_NE(image.at(100, 100), (Color8{0, 0, 0, 255}));
  EXPECT_EQ(image.at(150, 59), (Color8{0, 0, 0, 255}));
  EXPECT_NE(image.at(150, 60), (Color8{0, 0, 0, 255}));
  EXPECT_NE(image.at(259, 179), (Color8{0, 0, 0, 255}));
  EXPECT_EQ(image.at(260, 179), (Color8{0, 0, 0, 255}));
  EXPECT_EQ(image.at(259, 180), (Color8{0, 0, 0, 255}));
}

TEST_F(Overlays, AreDrawnAnewOnlyWhereSomethingChanged) {
  OverlayView view = viewOf(fullBatch(), true);
  EXPECT_TRUE(layer_.update(view));
  EXPECT_FALSE(layer_.update(view));
  view.camera.exposureStops += 1.0;  // of the picture alone
  EXPECT_FALSE(layer_.update(view));

  const auto expectRedrawn = [&](const char* what) {
    EXPECT_TRUE(layer_.update(view)) << what;
    EXPECT_FALSE(layer_.update(view)) << what;
  };
  view.camera.position.x += 0.01f;
  expectRedrawn("camera");
  view.placement.zoom *= 1.01f;
  expectRedrawn("placement");
  view.pen.uiScale = 1.5f;
  expectRedrawn("pen");
  view.depth = depthOf(view.camera, true);
  expectRedrawn("depth");
  view.batches.push_back(shared({}));
  expectRedrawn("another batch");
  view.batches.clear();
  expectRedrawn("no batch");
}

TEST_F(Overlays, TheSecondDrawingIsTheFirst) {
  const OverlayView view = viewOf(fullBatch(), true);
  const Image<Color8> first = drawn(view);
  OverlayView away = view;
  away.camera.position.x += 0.5f;
  away.batches.push_back(shared(fullBatch()));
  drawn(away);
  EXPECT_EQ(drawn(view), first);
}

}  // namespace
}  // namespace lightvane
