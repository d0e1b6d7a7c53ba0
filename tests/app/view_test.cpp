// Cameras as what differs from those of a scene.

#include "app/view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane {
namespace {

/// A pinhole, two lenses and an orthographic camera, at places of their own.
std::vector<CameraDescription> kinds() {
  std::vector<CameraDescription> cameras(4);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].name = std::string(1, static_cast<char>('a' + i));
    cameras[i].position = {0.1 * static_cast<double>(i), 0.3, -0.9};
    cameras[i].target = {0.3, 0.3, 0.1};
  }
  cameras[1].lensRadius = 0.05;
  cameras[2].lensRadius = 0.02;
  cameras[2].focusDistance = 0.7;
  cameras[3].projection = Projection::Orthographic;
  cameras[3].orthographicHeight = 0.6;
  return cameras;
}

// What the window's command line says of a camera makes that very camera, whatever the scene's own is.
TEST(ChangesTo, MakeAnyCameraOfAnyOther) {
  SceneDescription description = render_test::shippedScene("cornell.toml", 16, 16);
  for (const CameraDescription& from : kinds()) {
    description.cameras = {from};
    const auto scene = Scene::compile(description).value();
    for (const CameraDescription& camera : kinds()) {
      RenderArguments arguments;
      arguments.cameraChanges = changesTo(camera, from);
      const auto view = chooseView(description, *scene, arguments);
      ASSERT_TRUE(view) << view.error().message();
      EXPECT_EQ(view->camera, compileCamera(scene->normalisation, camera, "test").value())
          << from.name << " to " << camera.name;
    }
  }
}

TEST(IsSameView, IsAboutWhatIsSeen) {
  for (const CameraDescription& a : kinds()) {
    for (const CameraDescription& b : kinds()) EXPECT_EQ(isSameView(a, b), a.name == b.name);
    CameraDescription larger = a;
    larger.name = "larger";
    larger.width = 1024;
    larger.exposureStops = 2.0;
    EXPECT_TRUE(isSameView(a, larger));
  }
}

}  // namespace
}  // namespace lightvane
