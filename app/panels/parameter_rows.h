#pragma once

#include <string_view>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// A line for each field of a group of parameters that the filter leaves: the control that fits its type, the
/// cost of a change, and a way back. Recorded under the field's key; beside it "key.cost", "key.unit" of
/// lengths, and "key.reset".
void drawParameterRows(std::string_view group, Workspace& workspace, const PanelInput& input,
                       PanelState& state, PanelOutput& output);

}  // namespace lightvane
