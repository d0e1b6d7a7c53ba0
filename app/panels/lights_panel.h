#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// Every light: solo, mute, tint and intensity. Edits `workspace.setup.lights`, and says what of the picture
/// follows at once and what does not.
void drawLightsPanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

}  // namespace lightvane
