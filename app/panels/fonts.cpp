#include "app/panels/fonts.h"

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/base/file.h"

namespace lightvane {
namespace {

constexpr float kPixels = 15.0f;
// The embedded font is a bitmap of 13 pixels: whole multiples stay sharp.
constexpr float kEmbeddedPixels = 13.0f;

/// A TrueType or OpenType file by its first four bytes: ImGui asserts on anything else.
bool isFont(std::string_view content) {
  using namespace std::string_view_literals;
  const std::string_view tag = content.substr(0, 4);
  return tag == "\0\1\0\0"sv || tag == "true"sv || tag == "OTTO"sv;
}

}  // namespace

std::span<const std::filesystem::path> fontCandidates() {
  static const std::array<std::filesystem::path, 4> candidates{
      "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",    // Debian, Ubuntu
      "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",  // Fedora
      "/usr/share/fonts/TTF/DejaVuSans.ttf",                // Arch
      "/usr/local/share/fonts/DejaVuSans.ttf"};
  return candidates;
}

std::string loadFonts(ImFontAtlas& atlas, float scale, std::span<const std::filesystem::path> candidates) {
  atlas.Clear();
  // Latin with its extensions, Greek and Cyrillic: names of files and lights. Raised digits, minus and
  // infinity: numbers of plots. Pairs of first and last, ended by a zero; kept as long as the atlas.
  static constexpr ImWchar kRanges[] = {0x20,   0x24f,  0x370,  0x52f,  0x2010, 0x2027, 0x2070, 0x207f,
                                        0x2190, 0x2193, 0x2212, 0x2212, 0x221e, 0x221e, 0};
  for (const std::filesystem::path& path : candidates) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) continue;
    const Expected<std::string> content = readFile(path);
    if (!content || !isFont(*content)) continue;
    // The atlas frees what it is given with its own allocator.
    void* owned = ImGui::MemAlloc(content->size());
    std::memcpy(owned, content->data(), content->size());
    atlas.AddFontFromMemoryTTF(owned, static_cast<int>(content->size()), std::round(kPixels * scale), nullptr,
                               kRanges);
    return {};
  }
  ImFontConfig config;
  config.SizePixels = kEmbeddedPixels * std::max(1.0f, std::round(scale));
  atlas.AddFontDefault(&config);
  return "the font DejaVu Sans was not found, a built-in one is used (install fonts-dejavu-core)";
}

}  // namespace lightvane
