#include "app/panels/floating_window.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/panels/widgets.h"

namespace lightvane {

FloatingWindow::FloatingWindow(const char* title, const char* name, const ImVec2& size,
                               const Palette& palette, bool& open, bool focus) {
  const float em = ImGui::GetFontSize();
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float margin = em;
  const ImVec2 largest{screen.x - 2.0f * margin, screen.y - 2.0f * margin};
  const float width = std::min(size.x * em, largest.x);
  const float height = std::min(size.y * em, largest.y);
  ImGui::SetNextWindowSizeConstraints({width, height}, {width, height > 0.0f ? height : largest.y});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  if (focus) ImGui::SetNextWindowFocus();
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette.popup);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ImGui::GetStyle().PopupRounding);
  const ImGuiWindowFlags automatic = height > 0.0f ? 0 : ImGuiWindowFlags_AlwaysAutoResize;
  ImGui::Begin(fmt::format("{}##{}", title, name).c_str(), &open,
               automatic | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(2);
  ImGui::PopStyleColor();
  Widgets::recordWindow(fmt::format("window.{}", name));
}

FloatingWindow::~FloatingWindow() { ImGui::End(); }

}  // namespace lightvane
