#pragma once

#include <functional>
#include <string>

#include "app/panels/panel_io.h"

namespace lightvane {

/// A text field for a path, in which Tab goes as far as all files agree that begin with what was typed. True
/// when Enter was pressed.
bool pathField(const char* name, std::string& path, bool takeFocus,
               const std::function<PathCompletion(const std::string&)>& complete);

}  // namespace lightvane
