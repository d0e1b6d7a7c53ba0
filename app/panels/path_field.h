#pragma once

#include <functional>
#include <string>

#include "app/panels/panel_io.h"

namespace lightvane {

struct PathFocus {
  bool takes = false;  ///< the field takes the keyboard
  /// Whenever it gets it, so that typing replaces what is there. What is wrong is to be mended instead.
  bool selectsAll = true;
};

/// A text field for a path, in which Tab goes as far as all files agree that begin with what was typed. True
/// when Enter was pressed.
bool pathField(const char* name, std::string& path, PathFocus focus,
               const std::function<PathCompletion(const std::string&)>& complete);

}  // namespace lightvane
