#pragma once

#include <filesystem>
#include <string>

namespace lightvane {

/// Drops a file on a window, as a file manager does: the XDND protocol, version 5, from a window of its own.
/// `window` is the X server's number for it, as a decimal text; the place is in pixels of the screen. Throws
/// where the window does not take it within some seconds.
void dropFile(const std::string& display, const std::string& window, const std::filesystem::path& file, int x,
              int y);

}  // namespace lightvane
