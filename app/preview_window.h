#pragma once

#include <filesystem>

#include "app/messages.h"
#include "core/base/error.h"

namespace lightvane {

/// Opens the previewer's window on a scene and runs until it is closed. Errors say what to do where no window
/// can be had; nothing is loaded then.
Expected<ExitCode> runPreviewWindow(const std::filesystem::path& scene);

}  // namespace lightvane
