#pragma once

#include <string>

#include "core/measure/sweep.h"

namespace lightvane {

/// A page that shows a sweep: the front of error against CPU time with the rivals' on the same axes, what
/// each parameter does alone, and every point with its picture, its numbers and its command. One file of HTML
/// that needs no other but the points' pictures, and no network. `metric` is what is shown first:
/// "beauty.relative". Pure: the same sweep gives the same bytes.
std::string sweepReportHtml(const Sweep& sweep, const std::string& metric);

}  // namespace lightvane
