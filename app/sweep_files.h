#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/measure/sweep.h"

namespace lightvane {

/// A run as it is kept: which point it is of, and what all of it belongs to.
struct KeptRun {
  /// Scene, view, parameters, seed, reference, masks, threads and version: runs of one key are the same run.
  std::string key;
  std::string method;
  SweepSettings settings;
  std::string command;
  std::string picture, errorMap;
  SweepRun run;
};

/// The finished runs of a folder, a line of JSON each. A run is on the disk before the next begins, and a
/// line that a crash has cut is passed over: none is lost, and none is computed twice.
class RunLog {
 public:
  /// Reads what there is. An error where the file cannot be read or is of another kind.
  static Expected<RunLog> open(const std::filesystem::path& file);

  const std::vector<KeptRun>& runs() const { return runs_; }
  const KeptRun* find(const std::string& key) const;
  /// Adds it to the file, and waits until the disk has it.
  Expected<void> add(const KeptRun& run);

 private:
  void keep(KeptRun run);

  std::filesystem::path file_;
  std::vector<KeptRun> runs_;
  std::map<std::string, std::size_t> places_;  ///< in runs_, by key
};

/// A line a run: method, settings, seed, times, counts, metrics.
std::string sweepCsv(const Sweep& sweep);
/// All of it, for programs.
std::string sweepJson(const Sweep& sweep);

}  // namespace lightvane
