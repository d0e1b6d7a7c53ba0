#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// Asks for a file to open, where it is asked for: a path with completion, and the recent files.
void drawOpenDialog(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

}  // namespace lightvane
