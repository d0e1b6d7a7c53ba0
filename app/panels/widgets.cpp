#include "app/panels/widgets.h"

#include <algorithm>

#include <fmt/format.h>

namespace lightvane {
namespace {

struct Recording {
  bool on = false;
  std::vector<WidgetPlace> places;
};

Recording& recording() {
  static Recording instance;
  return instance;
}

}  // namespace

bool WidgetPlace::isClippedHorizontally() const {
  // Clip rectangles are rounded to whole pixels.
  constexpr float kRounding = 1.0f;
  return min.x < clipMin.x - kRounding || max.x > clipMax.x + kRounding;
}

bool WidgetPlace::isVisible() const {
  const ImVec2 c = centre();
  return c.x >= clipMin.x && c.x < clipMax.x && c.y >= clipMin.y && c.y < clipMax.y;
}

void Widgets::setRecording(bool on) {
  recording().on = on;
  recording().places.clear();
}

bool Widgets::isRecording() { return recording().on; }

void Widgets::beginFrame() { recording().places.clear(); }

void Widgets::record(std::string_view name, const ImVec2& min, const ImVec2& max, std::string_view text) {
  if (!recording().on) return;
  const ImDrawList* list = ImGui::GetWindowDrawList();
  recording().places.push_back(
      {std::string(name), min, max, list->GetClipRectMin(), list->GetClipRectMax(), std::string(text)});
}

void Widgets::recordItem(std::string_view name, std::string_view text) {
  if (recording().on) record(name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), text);
}

void Widgets::recordOnScreen(std::string_view name, const ImVec2& min, const ImVec2& max,
                             std::string_view text) {
  if (!recording().on) return;
  recording().places.push_back(
      {std::string(name), min, max, {0.0f, 0.0f}, ImGui::GetIO().DisplaySize, std::string(text)});
}

void Widgets::recordWindow(std::string_view name, std::string_view text) {
  if (!recording().on) return;
  const ImVec2 at = ImGui::GetWindowPos();
  const ImVec2 size = ImGui::GetWindowSize();
  recordOnScreen(name, at, {at.x + size.x, at.y + size.y}, text);
}

std::optional<WidgetPlace> Widgets::find(std::string_view name) {
  const std::vector<WidgetPlace>& places = recording().places;
  const auto found = std::find_if(places.begin(), places.end(),
                                  [&](const WidgetPlace& place) { return place.name == name; });
  return found == places.end() ? std::nullopt : std::optional(*found);
}

const std::vector<WidgetPlace>& Widgets::all() { return recording().places; }

std::string widgetsAsText() {
  std::string text;
  for (const WidgetPlace& place : Widgets::all()) {
    if (!place.isVisible()) continue;
    text += fmt::format("{} {:.0f} {:.0f} {:.0f} {:.0f}", place.name, place.min.x, place.min.y, place.max.x,
                        place.max.y);
    if (!place.text.empty()) text += " " + place.text;
    // A message of several lines is one here.
    std::replace(text.end() - static_cast<std::ptrdiff_t>(place.text.size()), text.end(), '\n', ' ');
    text += '\n';
  }
  return text;
}

}  // namespace lightvane
