#pragma once

#include "app/panels/layout.h"
#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// Draws all panels, between ImGui::NewFrame and ImGui::Render. Edits the workspace, and says in `output`
/// what the window's loop is to do. Returns where everything is: the picture's place is for the loop to draw
/// in, with whatever it wants, before ImGui's own.
///
/// A frame of the loop:
///
///   applyTheme, loadFonts               (where theme, UI scale or monitor changed)
///   ImGui::NewFrame
///   PanelOutput output;
///   for each key pressed: if (action = keys.actionFor(chord), and !io.WantTextInput or whileTyping)
///     applyAction(*action, workspace, input, state, output);
///   layout = drawPanels(workspace, input, state, output);
///   carry out output; history.update(workspace.setup, output.gesture or an orbit is under way, its name);
///   send what of the workspace differs to the session; draw the picture in layout.picture
PanelLayout drawPanels(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

/// The scale of everything that ImGui draws: the monitor's times the user's.
inline float totalScale(const Display& display, float monitorScale) { return display.uiScale * monitorScale; }

}  // namespace lightvane
