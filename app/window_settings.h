#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/background_job.h"
#include "app/panels/workspace.h"
#include "core/base/error.h"

namespace lightvane {

/// What of the window is a matter of taste, and is kept from start to start.
struct WindowSettings {
  float leftWidth = Display{}.leftWidth;
  float rightWidth = Display{}.rightWidth;
  Theme theme = Display{}.theme;
  float uiScale = Display{}.uiScale;
  bool reloads = Display{}.reloads;

  bool operator==(const WindowSettings&) const = default;
};

WindowSettings windowSettings(const Display& display);
void applySettings(const WindowSettings& settings, Display& display);

/// The file of these settings (docs/manual.md, Files): read when this is made, written in the background
/// where something else is to be kept, at most once a second and at the end. All methods on one thread.
///
/// A file in which something is wrong is never written: whoever changed it by hand mends it, or another
/// version of Lightvane reads it.
class WindowSettingsFile {
 public:
  /// An empty path: nothing is read or kept.
  explicit WindowSettingsFile(std::filesystem::path file);
  /// Writes what is left to be written.
  ~WindowSettingsFile();
  WindowSettingsFile(const WindowSettingsFile&) = delete;
  WindowSettingsFile& operator=(const WindowSettingsFile&) = delete;

  const WindowSettings& settings() const { return settings_; }
  /// Keeps what differs between the two, as somebody has just changed it; the rest stays as it is.
  void keep(const WindowSettings& before, const WindowSettings& after);
  /// Writes where it is time to. `seconds` on a clock that does not go back.
  void update(double seconds);
  /// Something is still to be written.
  bool isBehind() const { return !isLeftAlone_ && settings_ != written_; }
  /// What is wrong with the file, or why it could not be written: once.
  std::optional<std::string> takeProblem();

 private:
  void read();

  std::filesystem::path file_;
  bool isLeftAlone_ = false;
  WindowSettings settings_;
  WindowSettings written_;  ///< what the file says, once what is under way is done
  std::optional<std::string> problem_;
  double writtenAt_;
  BackgroundJob<Expected<void>> job_;
};

}  // namespace lightvane
