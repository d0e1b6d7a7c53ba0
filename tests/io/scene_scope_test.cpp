#include <functional>

#include <gtest/gtest.h>

#include "tests/io/io_support.h"

namespace lightvane {
namespace {

struct Change {
  const char* name;
  bool changesLight;
  std::function<void(SceneDescription&)> apply;
};
void PrintTo(const Change& change, std::ostream* out) { *out << change.name; }

class SceneScope : public testing::TestWithParam<Change> {};

TEST_P(SceneScope, OfLightLeavesCamerasOut) {
  const SceneDescription& before = test::cornellScene().description;
  SceneDescription after = before;
  GetParam().apply(after);
  EXPECT_EQ(sceneHash(after, HashScope::Lighting) != sceneHash(before, HashScope::Lighting),
            GetParam().changesLight);
}

using S = SceneDescription;
INSTANTIATE_TEST_SUITE_P(
    Changes, SceneScope,
    testing::Values(Change{"CameraPlace", false, [](S& s) { s.cameras[0].position.x += 1; }},
                    Change{"CameraSize", false, [](S& s) { s.cameras[0].width = 48; }},
                    Change{"CameraCount", false, [](S& s) { s.cameras.emplace_back(); }},
                    Change{"Units", true, [](S& s) { s.units = "foot"; }},
                    Change{"Material", true, [](S& s) { s.materials[0].diffuse.r *= 0.5f; }},
                    Change{"Shape", true, [](S& s) { s.shapes.pop_back(); }},
                    Change{"Light", true, [](S& s) { s.lights.emplace_back(); }}),
    [](const testing::TestParamInfo<Change>& change) { return change.param.name; });

TEST(SceneScopes, DifferFromEachOther) {
  const SceneDescription& scene = test::cornellScene().description;
  EXPECT_NE(sceneHash(scene, HashScope::Lighting), sceneHash(scene, HashScope::Picture));
  EXPECT_EQ(sceneHash(scene), sceneHash(scene, HashScope::Picture));
}

}  // namespace
}  // namespace lightvane
