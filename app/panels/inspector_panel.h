#pragma once

#include <string>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// "24 %": the part of `whole` that `part` is, by luminance; empty where there is no whole.
std::string shareText(const Rgb& part, const Rgb& whole);

/// Why the selected pixel looks as it does, and what is known of the selected vector. Pointing at a row
/// points at its vector (`workspace.selection.hoveredRecord`), a click selects it.
void drawInspectorPanel(Workspace& workspace, const PanelInput& input, PanelState& state,
                        PanelOutput& output);

}  // namespace lightvane
