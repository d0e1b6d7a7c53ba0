#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// How long a notice stays on the picture before only the list has it, in seconds.
double toastSeconds(Severity severity);

/// The newest notices in the lower right corner of the picture, each until it is clicked or its time is over;
/// and the list of all, where it is open.
void drawNotices(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output,
                 const ImVec2& pictureMin, const ImVec2& pictureMax);

}  // namespace lightvane
