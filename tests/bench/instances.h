#pragma once

#include <string>

namespace lightvane {

/// What a ray takes in a room full of balls whose triangles are shared, over what it takes where each ball
/// has its own; and the memory of both. Markdown, by the balls' triangles.
std::string instancesTable(int rounds);

}  // namespace lightvane
