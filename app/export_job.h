#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/base/error.h"

namespace lightvane {

/// Files that are written while the window goes on. All methods on one thread.
class ExportJob {
 public:
  explicit ExportJob(std::function<void()> done) : done_(std::move(done)) {}
  /// Waits for the file that is being written: it would be lost.
  ~ExportJob();
  ExportJob(const ExportJob&) = delete;
  ExportJob& operator=(const ExportJob&) = delete;

  bool isBusy() const { return thread_.joinable(); }
  /// Not while it is busy.
  void start(std::filesystem::path path, std::function<Expected<void>()> write);
  /// What became of the file, once, when it is there; with its path.
  struct Outcome {
    std::filesystem::path path;
    Expected<void> done;
  };
  std::optional<Outcome> take();

 private:
  struct Shared;

  std::function<void()> done_;
  std::filesystem::path path_;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace lightvane
