#include "app/panels/export_dialog.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "app/panels/controls.h"
#include "app/panels/floating_window.h"
#include "app/panels/path_field.h"
#include "app/panels/widgets.h"
#include "core/base/text.h"

namespace lightvane {
namespace {

/// The scene's name and the first format, where nothing was typed yet.
std::string proposedPath(const PanelInput& input) {
  const std::string stem =
      input.scene && !input.scene->path.empty() ? input.scene->path.stem().string() : "picture";
  return stem + (input.exportFormats.empty() ? "" : input.exportFormats.front().extension);
}

/// The format that a path's ending asks for.
std::optional<std::size_t> formatOf(const std::string& path, std::span<const ExportFormat> formats) {
  for (std::size_t i = 0; i < formats.size(); ++i) {
    if (lowered(path).ends_with(formats[i].extension)) return i;
  }
  return std::nullopt;
}

void drawFormat(const ControlStyle& style, std::span<const ExportFormat> formats, ExportDialogState& own) {
  std::vector<const char*> names;
  for (const ExportFormat& format : formats) names.push_back(format.description.c_str());
  if (const auto typed = formatOf(own.path, formats)) own.format = *typed;
  const auto chosen = choiceLine(style, {.name = "export.format", .label = "Format"}, names, own.format);
  if (!chosen) return;
  own.format = *chosen;
  own.path = withExtension(own.path, formats, formats[*chosen].extension);
}

/// Asks for the picture to be written, or says why not.
void tryToExport(const PanelInput& input, ExportDialogState& own, PanelOutput& output) {
  if (const auto format = formatOf(own.path, input.exportFormats)) {
    output.exported =
        ExportRequest{withoutTilde(own.path), own.withOverlay && input.exportFormats[*format].takesOverlay};
    own.open = false;
    return;
  }
  std::vector<std::string> endings;
  for (const ExportFormat& format : input.exportFormats) endings.push_back(format.extension);
  own.error = fmt::format("The file's name must end in {}.", listWords(endings));
  own.takeFocus = true;
}

/// Which files an export would write over; empty where there are none. `cache` is what it writes beside the
/// picture, and may be empty.
std::string replaceWarning(const PanelInput& input, const ExportDialogState& own,
                           const std::filesystem::path& cache) {
  if (!input.completePath) return {};
  const bool isThere = input.completePath(own.path).isFile;
  const bool hasCache = !cache.empty() && input.completePath(cache.string()).isFile;
  const std::string vectors = cache.filename().string();
  if (isThere && hasCache)
    return fmt::format("This file and its vectors, {}, are there already and will be replaced.", vectors);
  if (isThere) return "This file is there already and will be replaced.";
  return hasCache ? fmt::format("Its vectors, {}, are there already and will be replaced.", vectors) : "";
}

void drawCommand(const ControlStyle& style, const Workspace& workspace, const PanelInput& input,
                 const ExportDialogState& own, const ExportCommand& command, PanelOutput& output) {
  if (!input.exportCommand) return;
  heading(style.palette, "The same picture without the window");
  noteText(style.palette, command.line);
  Widgets::recordItem("export.command", command.line);
  const auto warn = [&](const char* name, const std::string& text) {
    markedText(style.palette.warning, text);
    Widgets::recordItem(name, text);
  };
  if (!command.note.empty()) warn("export.note", command.note);
  if (!command.cache.empty()) {
    warn("export.cache",
         fmt::format("It needs {}: this picture also has vectors of other views or parameters. Export writes "
                     "them beside it; until then the command finds none, or those of another picture.",
                     command.cache.filename().string()));
    if (workspace.display.view == PictureView::WhereComputed) {
      noteText(style.palette,
               "Where computed: the line begins with these vectors, and shows them as computed earlier.");
    }
  }
  const auto format = formatOf(own.path, input.exportFormats);
  if (format && input.exportFormats[*format].takesOverlay && own.withOverlay)
    noteText(style.palette, "What is drawn over the picture is drawn by the window alone.");
  if (ImGui::Button("Copy command line##export.copy")) output.clipboard = command.line;
  Widgets::recordItem("export.copy");
}

}  // namespace

std::string withExtension(const std::string& path, std::span<const ExportFormat> formats,
                          const std::string& extension) {
  const auto old = formatOf(path, formats);
  return path.substr(0, path.size() - (old ? formats[*old].extension.size() : 0)) + extension;
}

void drawExportDialog(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  ExportDialogState& own = state.exportDialog;
  if (!own.open) return;
  const ControlStyle style{paletteOf(workspace.display.theme), state.controls};
  FloatingWindow window("Export", "export", {38.0f, 0.0f}, style.palette, own.open, own.takeFocus);
  if (own.path.empty()) own.path = proposedPath(input);
  drawFormat(style, input.exportFormats, own);

  const bool takeFocus = own.takeFocus;
  own.takeFocus = false;
  const std::string before = own.path;
  const bool entered = pathField("export.path", own.path, {takeFocus, own.error.empty()}, input.completePath);
  if (own.path != before) own.error.clear();
  const ExportCommand command =
      input.exportCommand ? input.exportCommand(withoutTilde(own.path)) : ExportCommand{};
  if (!own.error.empty()) {
    markedText(style.palette.error, own.error);
  } else if (const std::string warning = replaceWarning(input, own, command.cache); !warning.empty()) {
    markedText(style.palette.warning, warning);
    Widgets::recordItem("export.replaces", warning);
  }

  const bool takesOverlay =
      own.format < input.exportFormats.size() && input.exportFormats[own.format].takesOverlay;
  if (takesOverlay) {
    toggleLine(style, {.name = "export.overlay", .label = "With what is drawn over the picture"},
               own.withOverlay);
  }
  const bool clicked = ImGui::Button("Export##export.do");
  Widgets::recordItem("export.do");
  if (entered || clicked) tryToExport(input, own, output);
  drawCommand(style, workspace, input, own, command, output);
}

}  // namespace lightvane
