#include "app/gl/draw_lists.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include "tests/gl/golden.h"
#include "tests/gl/memory_gl.h"

namespace lightvane {
namespace {

/// ImGui without a window.
class DrawListsTest : public GlTest {
 protected:
  DrawListsTest() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DeltaTime = 1.0f / 60.0f;
    io.DisplaySize = {240.0f, 160.0f};
  }
  ~DrawListsTest() override { ImGui::DestroyContext(); }

  /// The second frame of `content`: ImGui measures windows in their first.
  template <class Content>
  Image<Color8> drawn(const Content& content, float scale) {
    DrawLists lists = DrawLists::create(gl(), {}).value();
    lists.uploadFonts();
    ImGui::GetIO().DisplayFramebufferScale = {scale, scale};
    const Framebuffer target(gl(), static_cast<int>(240.0f * scale), static_cast<int>(160.0f * scale));
    for (int frame = 0; frame < 2; ++frame) {
      ImGui::NewFrame();
      content();
      ImGui::Render();
      target.clear({60, 70, 80, 255});
      lists.draw(target, *ImGui::GetDrawData());
    }
    return target.read();
  }
};

void window() {
  ImGui::SetNextWindowPos({12.0f, 10.0f});
  ImGui::SetNextWindowSize({200.0f, 130.0f});
  ImGui::Begin("Light vectors");
  float value = 0.4f;
  bool on = true;
  ImGui::Text("12,000 records");
  ImGui::SliderFloat("S_E", &value, 0.0f, 1.0f);
  ImGui::Checkbox("Validity zones", &on);
  ImGui::ProgressBar(0.6f);
  for (int line = 0; line < 20; ++line) ImGui::Text("cut off by the window's edge %d", line);
  ImGui::End();
}

TEST_F(DrawListsTest, AWindow) { expectGolden(gl(), drawn(window, 1.0f), "draw_lists"); }

TEST_F(DrawListsTest, AWindowOnAFineScreen) { expectGolden(gl(), drawn(window, 2.0f), "draw_lists_scale_2"); }

TEST_F(DrawListsTest, AnImageOfOurs) {
  const Framebuffer image(gl(), 2, 2);
  image.clear({200, 100, 50, 255});
  const GLuint id = image.texture().id();
  const Image<Color8> result = drawn(
      [id] {
        ImGui::GetBackgroundDrawList()->AddImage((ImTextureID)(std::uintptr_t)id, {10.0f, 10.0f},
                                                 {20.0f, 30.0f});
      },
      1.0f);
  EXPECT_EQ(result.at(9, 15), (Color8{60, 70, 80, 255}));
  EXPECT_EQ(result.at(10, 15), (Color8{200, 100, 50, 255}));
  EXPECT_EQ(result.at(19, 29), (Color8{200, 100, 50, 255}));
  EXPECT_EQ(result.at(19, 30), (Color8{60, 70, 80, 255}));
}

// More corners than 16 bits count: ImGui cuts such a list into commands that begin at later vertices.
TEST_F(DrawListsTest, AListOfManyVertices) {
  const Image<Color8> result = drawn(
      [] {
        ImDrawList& list = *ImGui::GetBackgroundDrawList();
        for (int i = 0; i < 30000; ++i)
          list.AddRectFilled({0.0f, 0.0f}, {1.0f, 1.0f}, IM_COL32(0, 0, 0, 255));
        list.AddRectFilled({100.0f, 50.0f}, {110.0f, 60.0f}, IM_COL32(10, 200, 30, 255));
      },
      1.0f);
  EXPECT_EQ(result.at(105, 55), (Color8{10, 200, 30, 255}));
  EXPECT_EQ(result.at(5, 5), (Color8{60, 70, 80, 255}));
}

TEST_F(DrawListsTest, TheSecondDrawingIsTheFirst) { EXPECT_EQ(drawn(window, 1.0f), drawn(window, 1.0f)); }

}  // namespace
}  // namespace lightvane
