#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// All keys, read off the table of actions and the keys in force, and what the mouse does; with a filter.
void drawHelpWindow(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

}  // namespace lightvane
