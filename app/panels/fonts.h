#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <imgui.h>

namespace lightvane {

/// Where distributions put DejaVu Sans.
std::span<const std::filesystem::path> fontCandidates();

/// Clears the atlas and adds the first of the fonts that is there and is one, at the size that reads well at
/// `scale`; ImGui's embedded font where there is none, since ImGui itself would end the program. Returns a
/// notice for the user in that case, which says what to install, and nothing otherwise.
std::string loadFonts(ImFontAtlas& atlas, float scale,
                      std::span<const std::filesystem::path> candidates = fontCandidates());

}  // namespace lightvane
