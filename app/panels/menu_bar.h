#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// The menus at the top, read off the table of actions. Items are recorded under their actions' names with
/// "menu." before them, menus under "menu." and their titles.
void drawMenuBar(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

}  // namespace lightvane
