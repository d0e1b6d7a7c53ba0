#pragma once

#include <string>

#include "core/base/error.h"

namespace lightvane {

/// What a command ends with.
enum class ExitCode {
  Success = 0,
  InternalError = 1,  ///< a broken invariant: a defect of ours
  BadInput = 2,       ///< something the user gave us, or a file that cannot be written
  Stopped =
      130  ///< by Ctrl+C or SIGTERM, after what there was has been written (128 + SIGINT, as shells say it)
};

/// What a command was asked for, to stdout, at once.
Expected<void> printAnswer(const std::string& text);

// All else goes to stderr, a line a call.

/// "lightvane: error: <text>"
void printError(const std::string& text);
/// "lightvane: warning: <text>"
void printWarning(const std::string& text);
/// "lightvane: <text>"
void printNote(const std::string& text);

}  // namespace lightvane
