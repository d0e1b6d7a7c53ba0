#pragma once

#include <string>

struct CommandOutcome {
  int exitCode;
  std::string output;  ///< what it printed on stdout
};

/// Runs a line of shell and waits for its end. Exit code 127 where there is no shell.
CommandOutcome runCommand(const std::string& line);
