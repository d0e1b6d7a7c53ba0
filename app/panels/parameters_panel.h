#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// Every parameter, read off the list of fields: groups that fold, with a filter, presets and rules; each
/// with the cost of a change, what the scene and the defaults say, and a way back to it. Edits
/// `workspace.setup.parameters`. Each control is recorded under its key.
void drawParametersPanel(Workspace& workspace, const PanelInput& input, PanelState& state,
                         PanelOutput& output);

}  // namespace lightvane
