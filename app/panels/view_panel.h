#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// Which view is shown and how its numbers become colours, and what it is compared with. Edits
/// `workspace.display`; restarts nothing.
void drawViewPanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

}  // namespace lightvane
