#pragma once

#include <optional>
#include <string>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// Whether an action can be taken as things are, and whether what it switches is on.
struct ActionStatus {
  std::string whyNot;           ///< empty where it can be
  std::optional<bool> checked;  ///< of switches

  bool isEnabled() const { return whyNot.empty(); }
};
ActionStatus actionStatus(ActionId id, const Workspace& workspace, const PanelInput& input,
                          const PanelState& state);

/// Carries out an action that only changes values; hands one that is the window's to `output`. Does nothing
/// where actionStatus says why not. What keys, menus and the palette all call.
void applyAction(ActionId id, Workspace& workspace, const PanelInput& input, PanelState& state,
                 PanelOutput& output);

/// Closes what is open, the topmost first; where nothing is, clears the selection, then ends a comparison.
/// What Esc does.
void closeTopmost(Workspace& workspace, PanelState& state);

}  // namespace lightvane
