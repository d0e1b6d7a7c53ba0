#pragma once

#include <string>

#include "app/panels/panel_io.h"
#include "app/panels/panel_state.h"
#include "core/base/error.h"
#include "core/measure/sweep_pick.h"

namespace lightvane {

/// What error and time other values of some parameters come to: what is to be measured, the points as they
/// come, which of them keeps within a limit, and the one that was clicked.
void drawTradePanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output);

/// The plan that was typed, where each of its points is one of values that `parameters` may have. Errors are
/// sentences for the panel.
Expected<TradePlan> tradePlan(const TradePanelState& typed, const Parameters& parameters);

/// What a picked point measured, and how sure it is: sentences. `limit` as it is read, with its unit;
/// `referenceNoise` is Sweep's.
std::string tradePickText(const SweepPick& pick, const ReportMetric& metric, bool limitsTime,
                          const std::string& limit, const std::optional<double>& referenceNoise);

/// "1.23 ± 0.04 %", by the deviation among the runs; the mean alone of one run.
std::string tradeErrorText(const ReportMetric& metric, const Spread& error, std::size_t runs);
/// "1.21 ± 0.02 s"
std::string tradeTimeText(const Spread& cpu, std::size_t runs);

}  // namespace lightvane
