#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/child_process.h"

namespace lightvane {

/// An X server that nobody sees, with a mouse and a keyboard. Without a window manager: windows have no
/// frame, stand in the upper left corner, and are as large as they ask to be.
class VirtualDesktop {
 public:
  static constexpr int kWidth = 1280;
  static constexpr int kHeight = 800;

  /// Throws where there is no Xvfb or no xdotool.
  VirtualDesktop();

  const std::string& display() const { return display_; }

  /// Runs xdotool to its end and returns what it printed; throws where it fails.
  std::string xdotool(const std::vector<std::string>& words) const;
  /// As xdotool, where failing is an answer, too: nothing.
  std::optional<std::string> tryXdotool(const std::vector<std::string>& words) const;

 private:
  std::unique_ptr<ChildProcess> server_;
  std::string display_;
};

}  // namespace lightvane
