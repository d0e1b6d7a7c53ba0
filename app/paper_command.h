#pragma once

#include "app/command_line.h"
#include "app/messages.h"

namespace lightvane {

/// Renders the scenes of the paper's figures by each of its methods (section 6), writes the pictures and
/// prints a table: its figures beside ours. Ctrl+C ends it with the rows that there are.
Expected<ExitCode> renderPaper(const PaperArguments& arguments);

}  // namespace lightvane
