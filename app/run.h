#pragma once

#include <span>
#include <string>

#include "app/messages.h"

namespace lightvane {

/// The whole program after its name: reads the words, does what they say, prints errors. Throws nothing.
ExitCode runCommandLine(std::span<const std::string> words);

}  // namespace lightvane
