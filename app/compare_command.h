#pragma once

#include "app/command_line.h"
#include "app/messages.h"

namespace lightvane {

/// Tells by every metric, or those asked for, how far a picture is from another.
Expected<ExitCode> comparePictures(const CompareArguments& arguments);

}  // namespace lightvane
