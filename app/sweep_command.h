#pragma once

#include "app/command_line.h"
#include "app/messages.h"

namespace lightvane {

/// Renders a view with many choices of parameters and by the methods without vectors, holds each picture
/// against a reference, and writes a folder: runs.jsonl, which keeps what is done, runs.csv, sweep.json,
/// index.html and the pictures. Ctrl+C ends it with what is done; the same command goes on from there.
Expected<ExitCode> runSweep(const SweepArguments& arguments);

}  // namespace lightvane
