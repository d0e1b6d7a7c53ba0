#pragma once

#include <map>
#include <string>

#include "core/measure/sweep.h"

namespace lightvane {

/// How wide pictures stand in the page, in pixels; it may be narrower itself.
inline constexpr int kThumbnailWidth = 320;

/// A page that shows a sweep: the front of error against CPU time with the rivals' on the same axes, what
/// each parameter does alone, and every point with its picture, its numbers and its command. One file of HTML
/// that needs no other, and no network; pictures in it lead to the points' own files. `metric` is what is
/// shown first: "beauty.relative". `thumbnails`: by the name of a point's picture the address of what stands
/// for it; others are said not to be there. Pure: the same sweep gives the same bytes.
std::string sweepReportHtml(const Sweep& sweep, const std::string& metric,
                            const std::map<std::string, std::string>& thumbnails = {});

}  // namespace lightvane
