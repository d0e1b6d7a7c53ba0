#pragma once

#include <string>
#include <vector>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// One entry of the status bar.
struct StatusItem {
  std::string name;  ///< recorded with "status." before it
  std::string text;
  std::string help;
  Severity severity = Severity::Note;
};

/// What the bar says, the most important first: where there is no room for all, the last ones are left out.
std::vector<StatusItem> statusItems(const RenderStatus& status, bool hasScene, bool cacheLocked);

/// The bar at the bottom, in the window that is being drawn: progress, and what statusItems says.
void drawStatusBar(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

}  // namespace lightvane
