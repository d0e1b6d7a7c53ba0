#pragma once

#include <string>

#include "app/command_line.h"

namespace lightvane {

/// The list of parameters, as text or as the whole of docs/parameters.md. An unknown key is an error that
/// names the nearest.
Expected<std::string> describeParameterList(const ParametersArguments& arguments);

}  // namespace lightvane
