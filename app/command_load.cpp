#include "app/command_load.h"

namespace lightvane {

Expected<ExitCode> endWithoutScene(const Error& error, bool quiet) {
  if (!error.isStop) return tl::unexpected(error);
  if (!quiet) printNote("stopped while the scene was loaded: nothing is written");
  return ExitCode::Stopped;
}

}  // namespace lightvane
