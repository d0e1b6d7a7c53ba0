#include "app/panels/notices.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/panels/controls.h"
#include "app/panels/floating_window.h"
#include "app/panels/widgets.h"

namespace lightvane {
namespace {

constexpr int kMostToasts = 4;

ImU32 colorOf(Severity severity, const Palette& palette) {
  return severity == Severity::Error     ? palette.error
         : severity == Severity::Warning ? palette.warning
                                         : palette.accent;
}

/// One notice over the picture; the height that it took.
float drawToast(const Palette& palette, const Notice& notice, const ImVec2& corner, float width,
                PanelOutput& output) {
  ImGui::SetNextWindowPos(corner, ImGuiCond_Always, {1.0f, 0.0f});
  ImGui::SetNextWindowSize({width, 0.0f});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette.popup);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
  ImGui::Begin(fmt::format("##toast{}", notice.id).c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_AlwaysAutoResize);
  markedText(colorOf(notice.severity, palette), notice.text);
  const float height = ImGui::GetWindowHeight();
  Widgets::recordWindow(fmt::format("toast.{}", notice.id), notice.text);
  if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) output.dismissedNotices.push_back(notice.id);
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  return height;
}

void drawToasts(const Palette& palette, const PanelInput& input, PanelOutput& output, const ImVec2& min,
                const ImVec2& max) {
  const float em = ImGui::GetFontSize();
  const float width = std::min(26.0f * em, max.x - min.x - em);
  ImVec2 corner{max.x - 0.5f * em, min.y + 0.5f * em};
  int shown = 0;
  for (auto notice = input.notices.rbegin(); notice != input.notices.rend() && shown < kMostToasts;
       ++notice) {
    if (notice->ageSeconds >= toastSeconds(notice->severity)) continue;
    corner.y += drawToast(palette, *notice, corner, width, output) + 0.4f * em;
    output.animates = true;  // so that it goes when its time is over
    ++shown;
  }
}

void drawList(const Palette& palette, const PanelInput& input, PanelState& state, PanelOutput& output) {
  FloatingWindow window("Messages", "notices", {40.0f, 24.0f}, palette, state.notices.listOpen, false);
  if (input.notices.empty()) return noteText(palette, "There are none.");
  const auto button = [](const char* label, const char* name) {
    const bool clicked = ImGui::Button(label);
    Widgets::recordItem(name);
    return clicked;
  };
  if (button("Copy", "notices.copy")) {
    std::string all;
    for (const Notice& notice : input.notices) all += notice.text + "\n";
    output.clipboard = all;
  }
  ImGui::SameLine();
  if (button("Clear", "notices.clear")) {
    for (const Notice& notice : input.notices) output.dismissedNotices.push_back(notice.id);
  }
  ImGui::BeginChild("##list");
  for (std::size_t i = input.notices.size(); i-- > 0;) {  // the newest first
    markedText(colorOf(input.notices[i].severity, palette), input.notices[i].text);
    ImGui::Spacing();
  }
  ImGui::EndChild();
}

}  // namespace

double toastSeconds(Severity severity) {
  // Time to read two lines; errors, which somebody has to mend, three times as long.
  return severity == Severity::Error ? 18.0 : 6.0;
}

void drawNotices(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output,
                 const ImVec2& pictureMin, const ImVec2& pictureMax) {
  const Palette& palette = paletteOf(workspace.display.theme);
  drawToasts(palette, input, output, pictureMin, pictureMax);
  if (state.notices.listOpen) drawList(palette, input, state, output);
}

}  // namespace lightvane
