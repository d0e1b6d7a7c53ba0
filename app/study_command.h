#pragma once

#include "app/command_line.h"
#include "app/messages.h"

namespace lightvane {

/// Measures what a study (app/studies.h) asks for on several scenes: renders references where there are
/// none, then the study's points, and prints what they say. Each scene, or each of its lights, has a folder
/// as runSweep writes it. Ctrl+C ends it with what is done; the same command goes on from there.
Expected<ExitCode> runStudy(const StudyArguments& arguments);

}  // namespace lightvane
