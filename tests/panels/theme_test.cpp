#include "app/panels/theme.h"

#include <array>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/fonts.h"
#include "core/base/color.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

double luminanceOf(ImU32 color) {
  const ImVec4 c = toVec4(color);
  return static_cast<double>(luminance(Rgb(decodeSrgb(c.x), decodeSrgb(c.y), decodeSrgb(c.z))));
}

/// WCAG 2.1's contrast ratio.
double contrast(ImU32 a, ImU32 b) {
  const double la = luminanceOf(a);
  const double lb = luminanceOf(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

class Themes : public testing::TestWithParam<Theme> {};

TEST_P(Themes, TextIsReadOnAllThatItStandsOn) {
  const Palette& p = paletteOf(GetParam());
  for (const ImU32 ground : {p.panel, p.popup, p.frame, p.frameHovered, p.frameActive, p.fill}) {
    EXPECT_GE(contrast(p.text, ground), 4.5) << std::hex << ground;
  }
  for (const ImU32 ground : {p.panel, p.popup, p.frame, p.frameHovered, p.fill}) {
    EXPECT_GE(contrast(p.dim, ground), 4.5) << std::hex << ground;
  }
  for (const ImU32 ground : {p.panel, p.popup}) {
    for (const ImU32 color : {p.accent, p.warning, p.error}) {
      EXPECT_GE(contrast(color, ground), 4.5) << std::hex << color << " on " << ground;
    }
    // Marks, not text: 3 is asked for (1.4.11).
    for (const ImU32 color : p.cost) EXPECT_GE(contrast(color, ground), 3.0) << std::hex << color;
  }
  EXPECT_GE(contrast(p.onAccent, p.accent), 4.5);
}

INSTANTIATE_TEST_SUITE_P(Both, Themes, testing::Values(Theme::Dark, Theme::Bright));

TEST(Fonts, WithoutTheFontTheEmbeddedOneIsUsedAndANoticeSaysWhatToInstall) {
  ImFontAtlas atlas;
  const std::array<std::filesystem::path, 1> nowhere{"/nowhere/at/all.ttf"};
  EXPECT_THAT(loadFonts(atlas, 1.0f, nowhere), testing::HasSubstr("fonts-dejavu-core"));
  EXPECT_EQ(atlas.Fonts.Size, 1);
}

TEST(Fonts, AFileThatIsNoFontIsPassedOver) {
  const TemporaryFolder folder;
  for (const char* content : {"", "x", "<html>not found</html>"}) {
    ImFontAtlas atlas;
    const std::array<std::filesystem::path, 2> candidates{folder.write("no_font.ttf", content),
                                                          folder.path()};
    EXPECT_NE(loadFonts(atlas, 2.0f, candidates), "");
    EXPECT_EQ(atlas.Fonts.Size, 1);
  }
}

TEST(Fonts, TheFirstFontThatIsThereIsUsed) {
  std::error_code error;
  bool any = false;
  for (const std::filesystem::path& path : fontCandidates())
    any |= std::filesystem::is_regular_file(path, error);
  if (!any) GTEST_SKIP() << "DejaVu Sans is not installed";
  ImFontAtlas atlas;
  EXPECT_EQ(loadFonts(atlas, 2.0f), "");
  EXPECT_EQ(atlas.Fonts.Size, 1);
}

}  // namespace
}  // namespace lightvane
