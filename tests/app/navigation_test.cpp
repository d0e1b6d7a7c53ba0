// The mouse over the picture: what each drag moves, and that there and back is nothing.

#include "app/navigation.h"

#include <gtest/gtest.h>

namespace lightvane {
namespace {

Navigation::View someView() {
  Navigation::View view;
  view.camera.position = {0, 0, 2};
  view.camera.width = 400;
  view.camera.height = 300;
  view.camera.tanHalfFovY = 0.5f;
  view.area = {{100, 50}, {900, 650}};
  view.picture = placePicture({}, view.area, 400, 300);
  return view;
}

PictureMouse at(float x, float y) {
  PictureMouse mouse;
  mouse.position = {x, y};
  mouse.overPicture = true;
  return mouse;
}

/// Presses at the middle of the picture, drags by `moved`, and returns what the last frame of the drag says.
PictureMotion drag(Navigation& navigation, PictureMouse mouse, int button, const Vec2& moved) {
  const Navigation::View view = someView();
  mouse.down[button] = true;
  navigation.update(mouse, view);
  mouse.position += moved;
  return navigation.update(mouse, view);
}

TEST(Navigation, FitFillsItsPlace) {
  const Placement fit = someView().picture;
  EXPECT_FLOAT_EQ(fit.zoom, 2.0f);
  EXPECT_EQ(fit.toPicture({500, 350}), Vec2(200, 150)) << "the middle of both";
}

TEST(Navigation, PlacementsAreReadBackFromWhatTheyShow) {
  const ScreenRect area{{100, 50}, {901, 650}};
  for (const PicturePlacement& placement :
       {PicturePlacement{false, 1.0f, {0, 0}}, PicturePlacement{false, 3.5f, {-40, 12}}}) {
    const PicturePlacement back = placementOf(placePicture(placement, area, 401, 300), area, 401, 300);
    EXPECT_FALSE(back.fit);
    EXPECT_EQ(back.zoom, placement.zoom);
    // Offsets are whole pixels.
    EXPECT_NEAR(back.pan.x, placement.pan.x, 0.75f);
    EXPECT_NEAR(back.pan.y, placement.pan.y, 0.75f);
  }
}

TEST(Navigation, AClickIsNoDrag) {
  Navigation navigation;
  const Navigation::View view = someView();
  PictureMouse mouse = at(300, 300);
  mouse.down[0] = true;
  navigation.update(mouse, view);
  mouse.position.x += 2.0f;
  EXPECT_FALSE(navigation.update(mouse, view).camera) << "a hand is not steady";
  mouse.down[0] = false;
  const PictureMotion motion = navigation.update(mouse, view);
  ASSERT_TRUE(motion.clicked);
  EXPECT_EQ(*motion.clicked, Vec2(300, 300));
}

TEST(Navigation, EachButtonMovesItsOwn) {
  Navigation orbit, look, picture, pan, dolly;
  EXPECT_STREQ(drag(orbit, at(500, 350), 0, {50, 0}).label, "Orbit");
  EXPECT_STREQ(drag(look, at(500, 350), 1, {50, 0}).label, "Look around");
  EXPECT_TRUE(drag(picture, at(500, 350), 2, {50, 0}).placement);
  PictureMouse mouse = at(500, 350);
  mouse.shift = true;
  EXPECT_STREQ(drag(pan, mouse, 0, {50, 0}).label, "Pan");
  mouse = at(500, 350);
  mouse.ctrl = true;
  EXPECT_STREQ(drag(dolly, mouse, 0, {0, 50}).label, "Dolly");
}

TEST(Navigation, ADragThereAndBackIsNothing) {
  for (int button = 0; button < 2; ++button) {
    Navigation navigation;
    const Navigation::View view = someView();
    PictureMouse mouse = at(500, 350);
    mouse.down[button] = true;
    navigation.update(mouse, view);
    mouse.position += Vec2(120, -70);
    EXPECT_NE(navigation.update(mouse, view).camera.value().position +
                  navigation.update(mouse, view).camera.value().forward,
              view.camera.position + view.camera.forward);
    mouse.position = {500, 350};
    const Camera back = navigation.update(mouse, view).camera.value();
    EXPECT_NEAR(glm::length(back.position - view.camera.position), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(back.forward - view.camera.forward), 0.0f, 1e-6f);
  }
}

TEST(Navigation, AWheelZoomsAboutTheMouse) {
  Navigation navigation;
  const Navigation::View view = someView();
  PictureMouse mouse = at(321, 432);
  mouse.wheel = 2.0f;
  const PictureMotion motion = navigation.update(mouse, view);
  ASSERT_TRUE(motion.placement);
  const Placement zoomed = placePicture(*motion.placement, view.area, 400, 300);
  EXPECT_GT(zoomed.zoom, view.picture.zoom);
  const Vec2 before = view.picture.toPicture(mouse.position);
  const Vec2 after = zoomed.toPicture(mouse.position);
  EXPECT_NEAR(glm::length(after - before), 0.0f, 1.0f / zoomed.zoom);
}

TEST(Navigation, PanelsKeepTheirMouse) {
  Navigation navigation;
  PictureMouse mouse = at(500, 350);
  mouse.overPicture = false;
  const PictureMotion motion = drag(navigation, mouse, 0, {80, 0});
  EXPECT_FALSE(motion.camera || motion.placement || motion.clicked || motion.held);
}

TEST(Navigation, TheWipesLineIsDragged) {
  Navigation navigation;
  Navigation::View view = someView();
  view.wipe = 0.5f;
  PictureMouse mouse = at(501, 300);
  mouse.down[0] = true;
  navigation.update(mouse, view);
  mouse.position.x = 700;
  EXPECT_NEAR(navigation.update(mouse, view).wipe.value(), 0.75f, 1e-6f);
}

TEST(Navigation, CtrlAndShiftDrawARectangle) {
  Navigation navigation;
  const Navigation::View view = someView();
  PictureMouse mouse = at(500, 350);
  mouse.ctrl = mouse.shift = true;
  mouse.down[0] = true;
  navigation.update(mouse, view);
  mouse.position = {420, 400};
  const PictureMotion drawing = navigation.update(mouse, view);
  ASSERT_TRUE(drawing.rectangle);
  EXPECT_FALSE(drawing.chosen || drawing.camera || drawing.held);
  EXPECT_EQ(drawing.rectangle->min.x, 420);
  EXPECT_EQ(drawing.rectangle->max.y, 400);
  mouse.down[0] = false;
  const PictureMotion drawn = navigation.update(mouse, view);
  ASSERT_TRUE(drawn.chosen);
  EXPECT_EQ(drawn.chosen->max.x, 500);
  EXPECT_FALSE(navigation.update(mouse, view).chosen) << "once";
}

}  // namespace
}  // namespace lightvane
