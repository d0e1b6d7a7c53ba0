#pragma once

#include "app/messages.h"
#include "app/progress.h"
#include "core/base/error.h"
#include "core/base/load_watch.h"

namespace lightvane {

/// A command loads a scene while this lives: stderr shows how far that is, and the flag of stopOnSignals ends
/// it. One thread's.
class CommandLoad {
 public:
  CommandLoad(const StopFlag& stop, bool quiet)
      : watch_(stop, progress_), display_(progressStyle(quiet), progress_) {}

  LoadWatch& watch() { return watch_; }

 private:
  LoadProgress progress_;
  FlagWatch watch_;
  LoadDisplay display_;
};

/// What a command ends with whose loading came to nothing: the error, or a line and ExitCode::Stopped where a
/// signal has stopped it.
Expected<ExitCode> endWithoutScene(const Error& error, bool quiet);

}  // namespace lightvane
