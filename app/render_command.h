#pragma once

#include "app/command_line.h"
#include "app/messages.h"

namespace lightvane {

/// Renders as the arguments say and writes all files. Everything that can be wrong with the arguments is
/// found before work begins. Stopped otherwise is what the exit code says; what is wrong with the input is an
/// error.
Expected<ExitCode> renderPicture(const RenderArguments& arguments);

}  // namespace lightvane
