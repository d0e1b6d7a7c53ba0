#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/temporary_folder.h"

namespace lightvane {

/// What a run of the program came to.
struct Outcome {
  int exitCode = -1;  ///< 128 + signal where a signal ended it
  std::string out;
  std::string err;
};

/// The lightvane executable, as a user runs it: with words, in a folder of its own that is removed at the
/// end.
class Program {
 public:
  Program() = default;
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  const std::filesystem::path& folder() const { return folder_.path(); }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
  std::string read(const std::string& name) const;
  void write(const std::string& name, const std::string& content) const { folder_.write(name, content); }
  /// Names of all files in the folder but the captured output, sorted.
  std::vector<std::string> files() const { return folder_.files(); }

  /// Runs it to its end.
  Outcome run(const std::vector<std::string>& words);

  /// Starts it and returns at once; one at a time.
  void start(const std::vector<std::string>& words);
  /// Waits until stderr has `text`, or the program ends, or too long.
  bool waitForError(const std::string& text);
  void signal(int number) const;
  /// Waits for the end of what start() started.
  Outcome finish();

 private:
  TemporaryFolder folder_;
  TemporaryFolder captured_;
  pid_t process_ = -1;
};

/// A scene that ships with Lightvane.
std::string shippedScene(const std::string& name);

}  // namespace lightvane
