#include "app/panels/open_dialog.h"

#include <string>

#include <fmt/format.h>

#include "app/panels/controls.h"
#include "app/panels/floating_window.h"
#include "app/panels/path_field.h"
#include "app/panels/widgets.h"

namespace lightvane {
namespace {

void request(const std::string& path, PanelState& state, PanelOutput& output) {
  output.open = OpenFileRequest{withoutTilde(path)};
  state.openDialog.open = false;
}

/// Opens what was typed, or says why not.
void tryToOpen(const PathCompletion& found, PanelState& state, PanelOutput& output) {
  OpenDialogState& own = state.openDialog;
  if (own.text.empty()) {
    own.error = "Type a path, or choose a file below.";
  } else if (!found.isFile) {
    own.error = fmt::format("There is no file '{}'.", own.text);
    own.takeFocus = true;
  } else {
    request(own.text, state, output);
  }
}

/// Lines to choose from; the number of the one that was clicked.
template <class Paths>
std::optional<std::size_t> drawPaths(const ControlStyle& style, const char* prefix, const Paths& paths) {
  std::optional<std::size_t> clicked;
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(paths.size()), ImGui::GetFrameHeightWithSpacing());
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const std::string path = std::string(paths[index]);
      const std::size_t slash = path.find_last_of('/', path.size() < 2 ? 0 : path.size() - 2);
      const bool split = slash != std::string::npos;
      if (buttonLine(style, {.name = fmt::format("{}.{}", prefix, i),
                             .label = split ? path.substr(slash + 1) : path,
                             .value = split ? path.substr(0, slash + 1) : std::string()})) {
        clicked = index;
      }
      tooltip(style, fmt::format("{}.{}", prefix, i), "", path);
    }
  }
  return clicked;
}

}  // namespace

void drawOpenDialog(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  OpenDialogState& own = state.openDialog;
  if (!own.open) return;
  const ControlStyle style{paletteOf(workspace.display.theme), state.controls};
  FloatingWindow window("Open", "open", {38.0f, 24.0f}, style.palette, own.open, own.takeFocus);
  const bool takeFocus = own.takeFocus;
  own.takeFocus = false;
  const std::string before = own.text;
  const bool entered = pathField("open.path", own.text, {takeFocus, own.error.empty()}, input.completePath);
  if (own.text != before) own.error.clear();
  const PathCompletion found = input.completePath ? input.completePath(own.text) : PathCompletion{};
  if (!own.error.empty()) {
    markedText(style.palette.error, own.error);
    Widgets::recordItem("open.error", own.error);
  }
  const bool clicked = ImGui::Button("Open##open.do");
  Widgets::recordItem("open.do");
  if (entered || clicked) tryToOpen(found, state, output);

  ImGui::BeginChild("##files");
  if (own.text.empty() && !input.recentFiles.empty()) {
    heading(style.palette, "Recent files");
    std::vector<std::string> recent;
    for (const std::filesystem::path& path : input.recentFiles) recent.push_back(path.string());
    if (const auto chosen = drawPaths(style, "open.recent", recent)) request(recent[*chosen], state, output);
  } else {
    const auto chosen = drawPaths(style, "open.found", found.paths);
    if (chosen && found.paths[*chosen].ends_with('/')) {
      own.text = found.paths[*chosen];
      own.takeFocus = true;
    } else if (chosen) {
      request(found.paths[*chosen], state, output);
    }
  }
  ImGui::EndChild();
}

}  // namespace lightvane
