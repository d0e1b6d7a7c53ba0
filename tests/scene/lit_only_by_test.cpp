#include "core/scene/lit_only_by.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/light_facts.h"
#include "core/scene/load_scene.h"

namespace lightvane {
namespace {

// Two shapes share a glowing material and are two lights; two others are one; and there is a sun.
constexpr const char* kScene = R"(
version = 1
[camera]
position = [0, 0, 5]
target = [0, 0, 0]
[material.glow]
emission = [4, 4, 4]
[material.panel]
diffuse = [0.5, 0.5, 0.5]
emission = [1, 1, 1]
[material.grey]
diffuse = [0.5, 0.5, 0.5]

[[shape]]
type = "sphere"
name = "left"
material = "glow"
center = [-1, 0, 0]
radius = 0.2
[[shape]]
type = "sphere"
name = "right"
material = "glow"
center = [1, 0, 0]
radius = 0.2
[[shape]]
type = "sphere"
material = "panel"
light = "panels"
center = [0, 2, 0]
radius = 0.1
[[shape]]
type = "sphere"
material = "panel"
light = "panels"
center = [0.5, 2, 0]
radius = 0.1
[[shape]]
type = "sphere"
material = "grey"
center = [0, -1, 0]
radius = 0.5

[[light]]
type = "directional"
name = "sun"
direction = [0, -1, 0]
irradiance = [1, 1, 1]
)";

class LitOnlyBy : public testing::Test {
 protected:
  void SetUp() override {
    auto description = parseSceneToml(kScene, "scene.toml");
    ASSERT_TRUE(description) << description.error().message();
    description_ = *std::move(description);
    const auto scene = Scene::compile(description_);
    ASSERT_TRUE(scene) << scene.error().message();
    scene_ = *scene;
    ASSERT_THAT(scene_->lightNames, testing::ElementsAre("left", "right", "panels", "sun"));
  }
  std::shared_ptr<const Scene> litBy(std::optional<std::uint32_t> light) const {
    const auto lit = Scene::compile(litOnlyBy(description_, *scene_, light));
    EXPECT_TRUE(lit);
    return lit.value_or(nullptr);
  }

  SceneDescription description_;
  std::shared_ptr<const Scene> scene_;
};

TEST_F(LitOnlyBy, KeepsOneLightAndEveryShape) {
  for (std::uint32_t light = 0; light < scene_->lights.size(); ++light) {
    const auto lit = litBy(light);
    ASSERT_THAT(lit->lightNames, testing::ElementsAre(scene_->lightNames[light]));
    EXPECT_STREQ(lightKind(lit->lights.front()), lightKind(scene_->lights[light]));
    // Watts, in the units of two scenes that may be normalised differently.
    const auto watts = [](const Scene& scene, std::uint32_t of) {
      return static_cast<double>(lightPower(scene.lights[of], 0.5f * scene.diagonal)) *
             scene.normalisation.radianceScale() * scene.metresPerNormalisedUnit() *
             scene.metresPerNormalisedUnit();
    };
    EXPECT_NEAR(watts(*lit, 0), watts(*scene_, light), 1e-5 * watts(*scene_, light));
    EXPECT_EQ(lit->spheres.size(), scene_->spheres.size());
    EXPECT_NE(lit->hash, scene_->hash);
    std::size_t emitting = 0;
    for (const Surface& surface : lit->surfaces) {
      EXPECT_EQ(surface.light == kNone, isBlack(lit->materials[surface.material].emission));
      emitting += surface.light == kNone ? 0 : 1;
    }
    EXPECT_EQ(emitting, light == 2 ? 2U : light == 3 ? 0U : 1U) << scene_->lightNames[light];
  }
}

TEST_F(LitOnlyBy, OfNoLightIsDark) {
  const auto dark = litBy({});
  EXPECT_TRUE(dark->lights.empty());
  for (const Surface& surface : dark->surfaces)
    EXPECT_TRUE(isBlack(dark->materials[surface.material].emission));
  EXPECT_EQ(dark->spheres.size(), scene_->spheres.size());
}

TEST_F(LitOnlyBy, ChangesNothingWhereItIsTheOnlyOne) {
  const SceneDescription one = litOnlyBy(description_, *scene_, 0);
  const auto compiled = Scene::compile(one);
  ASSERT_TRUE(compiled);
  EXPECT_EQ(sceneHash(litOnlyBy(one, **compiled, 0)), sceneHash(one));
}

}  // namespace
}  // namespace lightvane
