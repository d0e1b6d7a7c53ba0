#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace lightvane {

/// A program that runs beside the test, and that ends with it whatever happens.
class ChildProcess {
 public:
  struct Start {
    std::vector<std::string> words;                  ///< the program is found as a shell finds it
    std::map<std::string, std::string> environment;  ///< in place of the test's; an empty one is left out
    std::filesystem::path folder = ".";
    std::filesystem::path out = "/dev/null";
    std::filesystem::path err = "/dev/null";
    int inherited = -1;  ///< a file that stays open
  };
  explicit ChildProcess(const Start& start);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t id() const { return id_; }
  bool isRunning();
  /// 128 + signal where a signal ended it; nothing where it still runs after that time.
  std::optional<int> waitForExit(std::chrono::milliseconds atMost);
  /// Of all its threads, since it began.
  double processorSeconds() const;
  /// Of its first thread, likewise.
  double firstThreadSeconds() const;

 private:
  pid_t id_ = -1;
  std::optional<int> exitCode_;
};

}  // namespace lightvane
