#pragma once

#include <string>

namespace lightvane {

/// How long scenes of one room to many take to load, and their picture, which shows one room, to render:
/// Markdown. Each room has a lamp and a ball of 5000 triangles. The scenes are files of a folder that is made
/// for them and removed.
std::string largeTable(int rounds);

}  // namespace lightvane
