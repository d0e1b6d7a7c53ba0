#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/window/virtual_desktop.h"

namespace lightvane {

/// A place in the window, in pixels from its upper left corner.
struct Spot {
  int x = 0, y = 0;
};

/// A named widget as the window drew it last.
struct SeenWidget {
  std::string name;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::string text;

  Spot centre() const { return {(x0 + x1) / 2, (y0 + y1) / 2}; }
};

/// The lightvane program in its real window, driven by mouse and keyboard as a user does. It runs in a folder
/// of its own, which is also its home. Whatever does not come about in time throws, with what was seen
/// instead.
class Application {
 public:
  explicit Application(const VirtualDesktop& desktop);
  /// Where the test failed, says how to do it by hand, and keeps the folder.
  ~Application();
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;

  const std::filesystem::path& folder() const { return folder_.path(); }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  /// Starts it and returns when the window was drawn for the first time.
  void start(const std::vector<std::string>& words);

  // What the window shows.
  std::vector<SeenWidget> widgets() const;
  std::optional<SeenWidget> find(const std::string& name) const;
  std::string textOf(const std::string& name) const;  ///< empty where it cannot be seen
  SeenWidget waitForWidget(const std::string& name) const;
  /// Until the text of a widget is one that is wanted.
  std::string waitForText(const std::string& name,
                          const std::function<bool(const std::string&)>& isWanted) const;
  /// Until the picture is as good as it gets.
  void waitUntilComplete() const;
  void waitUntil(const std::string& what, const std::function<bool()>& isSo) const;

  // Mouse and keyboard. Each waits until the window has drawn a frame that knows of it.
  void moveTo(Spot spot) const;
  void click(Spot spot) const;
  void click(const std::string& widget) const { click(waitForWidget(widget).centre()); }
  void drag(Spot from, Spot to) const;
  /// "ctrl+e", "Escape": keys by xdotool's names.
  void press(const std::string& chord) const;
  /// Replaces what stands in a text field.
  void fillIn(const std::string& widget, const std::string& text) const;
  void resize(int width, int height) const;
  /// A file dropped in the middle of the window.
  void drop(const std::filesystem::path& file) const;
  std::string title() const;

  bool isRunning() const { return process_->isRunning(); }
  double processorSeconds() const { return process_->processorSeconds(); }
  /// CPU time that the window's own thread takes for a frame, the mean over so long, and longer where frames
  /// were few, and how many there were.
  struct FrameCost {
    int frames = 0;
    double milliseconds = 0.0;
  };
  FrameCost measureFrames(std::chrono::milliseconds duration) const;
  /// Ctrl+Q; how long the end took. Expects exit code 0 and no word on stderr.
  std::chrono::duration<double> quit();

  /// Exports by Ctrl+E and the dialog what the window shows, once the command line that the dialog tells is
  /// wanted; returns when the file is there.
  void exportTo(const std::string& name, const std::function<bool(const std::string&)>& isWanted) const;

 private:
  std::string errors() const;
  void waitForFrames(int count) const;
  std::int64_t frameStamp() const;

  const VirtualDesktop& desktop_;
  TemporaryFolder folder_;
  std::filesystem::path private_;
  std::vector<std::string> words_;
  std::unique_ptr<ChildProcess> process_;
  std::string window_;
};

}  // namespace lightvane
