#pragma once

#include <vector>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"

namespace lightvane {

/// Numbers at which a scale is marked: round ones within [low, high], about `most` of them; powers of ten on
/// a logarithmic scale.
std::vector<double> scaleTicks(const ViewScale& scale, int most);

/// What the colours of the view and the overlay mean, in the lower left corner of the picture: a bar with its
/// numbers and unit, swatches, and notes.
void drawLegend(const Workspace& workspace, const PanelInput& input, const ImVec2& pictureMin,
                const ImVec2& pictureMax);

/// The value under the cursor, beside it.
void drawCursorTooltip(const Workspace& workspace, const PanelInput& input);

}  // namespace lightvane
