#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {

/// A place on a page, in pixels from its upper left corner.
struct PagePlace {
  double x = 0.0, y = 0.0;
};

/// Chromium without a window, driven over a socket by its own protocol
/// (https://chromedevtools.github.io/devtools-protocol). It has a home of its own, which goes with this
/// object, and no network: no name is found. Whatever does not come about in time throws, with what the
/// browser said. One at a time, and no other child of this process beside it when it goes.
class Browser {
 public:
  Browser();
  /// Nothing that it started is left.
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Shows a page that is as high as pages get, so that nothing is out of sight, and returns when it and all
  /// its pictures are there or have failed.
  void open(const std::filesystem::path& page, std::chrono::milliseconds patience = kPatience);
  /// What a JavaScript expression is, and what it promises once that is there.
  nlohmann::json evaluate(const std::string& expression);
  void moveTo(PagePlace place);
  void click(PagePlace place);

  /// Errors of scripts and of loading since the page was opened, as the console has them.
  const std::vector<std::string>& errors() const { return errors_; }
  /// Addresses that were asked for since then, the page's own first.
  const std::vector<std::string>& requests() const { return requests_; }

 private:
  using Json = nlohmann::json;
  // Ends what hangs: far beyond what any step takes on a busy machine.
  static constexpr std::chrono::milliseconds kPatience = std::chrono::seconds(60);

  void start();
  void attach();
  void end();
  Json call(const std::string& method, const Json& parameters);
  Json receive();
  void note(const Json& event);
  Json valueOf(const std::string& expression);
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void failAtItsEnd() const;
  void mouse(const char* type, PagePlace place, int buttons);

  TemporaryFolder home_;
  std::unique_ptr<ChildProcess> process_;
  int socket_ = -1;
  std::string received_;
  std::string session_;
  int calls_ = 0;
  bool isLoaded_ = false;
  std::chrono::steady_clock::time_point deadline_;
  std::vector<std::string> errors_, requests_;
};

/// Processes whose parent this one is, ended ones that nobody waited for too.
std::vector<pid_t> childProcesses();

}  // namespace lightvane
