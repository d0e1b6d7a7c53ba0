// What a rendering is said to take, against what the allocator hands out.

#include "core/render/memory.h"

#include <cstdlib>

#include <gtest/gtest.h>
#include <malloc.h>

#include "core/render/session.h"
#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

std::size_t allocatedBytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// What a whole rendering and its frame hold when it is complete.
std::size_t heldBytes(const Stage& stage, const Parameters& parameters) {
  const std::size_t before = allocatedBytes();
  const RenderContext context = stage.context(parameters);
  const std::unique_ptr<Renderer> renderer = makeRenderer(context);
  const StopFlag never{false};
  std::size_t most = 0;
  std::optional<RenderFrame> shown;
  while (!renderer->done()) {
    EXPECT_TRUE(renderer->runPass(never));
    // As the session does: a frame is made while the one before is shown.
    RenderFrame next = makeFrame(context, *renderer);
    most = std::max(most, allocatedBytes() - before);
    shown = std::move(next);
  }
  return most;
}

TEST(Memory, IsAboutWhatARenderingHolds) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers have allocators of their own";
#endif
  for (const char* scene : {"cornell.toml", "cornell-mirror.toml"}) {
    const Stage stage(shippedScene(scene, 256, 256));
    for (const char* method : {"vectors", "path", "direct"}) {
      for (const char* samples : {"1", "4"}) {
        if (std::string_view(method) == "path" && samples[0] == '4') continue;
        const Parameters parameters = parametersWith(
            {{"method.name", method}, {"path.samples", "2"}, {"film.samples", samples}, {"preset", "draft"}});
        const auto held = static_cast<double>(heldBytes(stage, parameters));
        const RenderContext context = stage.context(parameters);
        const auto said =
            static_cast<double>(estimatedPictureBytes(*stage.scene, parameters, context.region));
        const double ratio = said / held;
        if (std::getenv("LIGHTVANE_PRINT_ESTIMATES") != nullptr)
          fmt::print("{} {} {}: {:.2f}\n", scene, method, samples, ratio);
        EXPECT_GT(ratio, 0.5) << scene << ", " << method << ", " << samples << ": " << said << " of " << held;
        EXPECT_LT(ratio, 2.0) << scene << ", " << method << ", " << samples << ": " << said << " of " << held;
      }
    }
  }
}

TEST(Memory, IsWhatItsDescriptionSays) {
  const Stage stage(shippedScene("cornell.toml", 8, 8));
  const auto of = [&](const char* method) {
    return pictureMemory(*stage.scene, parametersWith({{"method.name", method}}));
  };
  EXPECT_EQ(of("vectors").perPixel, 192U);
  EXPECT_EQ(of("vectors").perPoint, 268U + 42U * stage.scene->lights.size());
  EXPECT_EQ(of("path").perPixel, 432U);
  EXPECT_EQ(of("path").perPoint, 0U);
  EXPECT_EQ(of("naive").perPixel, 192U);
  EXPECT_EQ(of("direct").perPoint, 157U);
}

TEST(Memory, GrowsWithThePictureAndItsSamples) {
  const Stage stage(shippedScene("cornell.toml", 64, 64));
  const auto bytes = [&](int width, const Settings& settings) {
    return estimatedPictureBytes(*stage.scene, parametersWith(settings), {width, 64, 0, 0, width, 64});
  };
  EXPECT_EQ(bytes(128, {}), 2 * bytes(64, {}));
  EXPECT_GT(bytes(64, {{"film.samples", "4"}}), 2 * bytes(64, {}));
}

}  // namespace
}  // namespace lightvane::render_test
