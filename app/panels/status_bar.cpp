#include "app/panels/status_bar.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/panels/apply_action.h"
#include "app/panels/controls.h"
#include "app/panels/widgets.h"
#include "core/base/number_text.h"

namespace lightvane {
namespace {

std::string stateText(const RenderStatus& status) {
  if (status.complete) return fmt::format("Complete, {} passes", status.pass);
  std::string text = status.stopped  ? "Stopped"
                     : status.paused ? "Paused"
                                     : fmt::format("Pass {}", status.pass + 1);
  if (!status.stage.empty()) text += ", " + status.stage;
  return text + fmt::format(", {:.0f} %", 100.0 * status.fraction);
}

ImU32 colorOf(Severity severity, const Palette& palette) {
  return severity == Severity::Error     ? palette.error
         : severity == Severity::Warning ? palette.warning
                                         : palette.text;
}

/// How far the rendering is, along the upper edge of the whole bar.
void drawProgress(const Palette& palette, const RenderStatus& status) {
  const ImVec2 at = ImGui::GetWindowPos();
  const float thickness = std::max(1.0f, std::round(0.14f * ImGui::GetFontSize()));
  const float width = ImGui::GetWindowWidth();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto part = status.complete ? 0.0f : static_cast<float>(std::clamp(status.fraction, 0.0, 1.0));
  const ImU32 color = status.paused || status.stopped ? palette.dim : palette.accent;
  // Over the window's padding, too.
  list.PushClipRect(at, {at.x + width, at.y + thickness});
  list.AddRectFilled(at, {at.x + width, at.y + thickness}, palette.border);
  list.AddRectFilled(at, {at.x + part * width, at.y + thickness}, color);
  list.PopClipRect();
}

}  // namespace

std::vector<StatusItem> statusItems(const RenderStatus& status, bool hasScene, bool cacheLocked) {
  std::vector<StatusItem> items;
  if (!status.loading.empty())
    items.push_back(
        {"loading", status.loading, "A scene is being read. Stop leaves what is shown.", Severity::Note});
  if (!hasScene) {
    if (items.empty())
      items.push_back({"state", "No scene: open one, or drop a file here", "", Severity::Note});
    return items;
  }
  items.push_back({"state", stateText(status),
                   "The pass under way, its stage, and how much of the work is done.", Severity::Note});
  if (status.faultySamples > 0) {
    items.push_back({"faults", fmt::format("{} bad samples", countText(status.faultySamples)),
                     "Samples that were not finite or negative; they were left out." +
                         (status.faultHint.empty() ? "" : " Make one again: " + status.faultHint),
                     Severity::Warning});
  }
  if (!status.reference.empty()) {
    items.push_back({"reference", "reference: " + status.reference,
                     "Traced in the background, while the picture itself rests.", Severity::Note});
  }
  if (cacheLocked) {
    items.push_back({"locked",
                     status.unanswered > 0
                         ? fmt::format("locked, {} points unanswered", countText(status.unanswered))
                         : "locked",
                     "The cache is locked: no new vector is computed.", Severity::Warning});
  }
  if (status.secondsLeft && !status.complete && !status.paused && !status.stopped) {
    items.push_back(
        {"left", "about " + durationText(*status.secondsLeft) + " left", "Estimated.", Severity::Note});
  }
  const auto add = [&](const char* name, std::string text, const char* help) {
    items.push_back({name, std::move(text), help, Severity::Note});
  };
  add("records", fmt::format("{} ILVs, {} DLVs", countText(status.ilvRecords), countText(status.dlvRecords)),
      "Light vectors in the cache.");
  add("hit_rate", fmt::format("{:.0f} % interpolated", 100.0 * status.hitRate),
      "Of what the points ask for (indirect light, and that of each light with DLVs), the part that vectors "
      "answered.");
  if (status.raysPerSecond > 0.0) {
    add("rays", shortCount(status.raysPerSecond) + " rays/s", "Rays traced in a second, of all kinds.");
  }
  if (status.memoryBytes > 0) {
    add("memory", byteText(status.memoryBytes), "Memory of the program.");
  }
  return items;
}

void drawStatusBar(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  const ControlStyle style{paletteOf(workspace.display.theme), state.controls};
  const std::vector<StatusItem> items =
      statusItems(input.status, input.scene.has_value(), workspace.setup.cacheLocked);
  drawProgress(style.palette, input.status);
  const float em = ImGui::GetFontSize();
  const float top = ImGui::GetCursorPosY();
  float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;

  // Messages that were not put away, on the right, whatever else there is room for.
  if (!input.notices.empty()) {
    const std::size_t count = input.notices.size();
    const std::string text = fmt::format("{} message{}", count, count == 1 ? "" : "s");
    right -= ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SameLine(right);
    const bool isError = std::any_of(input.notices.begin(), input.notices.end(),
                                     [](const Notice& notice) { return notice.severity == Severity::Error; });
    ImGui::PushStyleColor(ImGuiCol_Text, colorOf(isError ? Severity::Error : Severity::Note, style.palette));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    Widgets::recordItem("status.notices", text);
    if (ImGui::IsItemClicked()) applyAction(ActionId::Notices, workspace, input, state, output);
    tooltip(style, "status.notices", "", "Lists warnings and errors.");
    right -= em;
  }

  float x = ImGui::GetStyle().WindowPadding.x;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const StatusItem& item = items[i];
    // The first says what happens, in full where there is room and in part where not.
    const std::string text = i == 0 ? fitted(item.text, right - x) : item.text;
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (x + width > right) break;
    ImGui::SetCursorPos({x, top});
    ImGui::PushStyleColor(ImGuiCol_Text, colorOf(item.severity, style.palette));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    const std::string name = "status." + item.name;
    Widgets::recordItem(name, item.text);
    if (!item.help.empty()) tooltip(style, name, "", item.help);
    x += width + 1.2f * em;
  }
}

}  // namespace lightvane
