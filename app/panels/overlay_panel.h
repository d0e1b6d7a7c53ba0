#pragma once

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// What is drawn over the picture: each kind of overlay with its size and opacity, what the colour of ILVs
/// says, how many are shown, and the time slider. Edits `workspace.display.overlays`.
void drawOverlayPanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

/// Moves a growth that plays on, by the time since the last frame. To be called in every frame, whether or
/// not the panel is seen; true while it plays.
bool advanceGrowth(GrowthTime& growth, std::uint64_t moments, double secondsPassed);

}  // namespace lightvane
