#pragma once

#include <span>
#include <string>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// `path` with the ending of a format in place of one that another format has, or behind it.
std::string withExtension(const std::string& path, std::span<const ExportFormat> formats,
                          const std::string& extension);

/// Asks where to write the picture, where it is asked for: format, path, with the overlay or without; and
/// shows the command line that gives the same picture without a window.
void drawExportDialog(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

}  // namespace lightvane
