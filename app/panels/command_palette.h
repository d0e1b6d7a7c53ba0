#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// What the palette can do: an action, or going to a parameter.
struct PaletteEntry {
  std::variant<ActionId, std::string> target;  ///< the latter is a parameter's key
  std::string text;  ///< as listed: "View: Where computed", "ilv.n_min  Fewest ILVs"
};

/// Every action and every parameter that the typed letters fit, the best first; all of them where nothing was
/// typed.
std::vector<PaletteEntry> findPaletteEntries(std::string_view typed);

/// The palette, where it is open: letters, the best entries, Up and Down and Enter or a click.
void drawCommandPalette(Workspace& workspace, const PanelInput& input, PanelState& state,
                        PanelOutput& output);

}  // namespace lightvane
