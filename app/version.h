#pragma once

namespace lightvane {

/// "0.1.0": the version in the top CMakeLists.txt.
const char* versionText();

}  // namespace lightvane
