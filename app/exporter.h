#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/background_job.h"
#include "app/canvas.h"
#include "app/panels/panel_io.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// Kinds of files that can be written: pictures first, then vectors and the session.
const std::vector<ExportFormat>& exportFormats();

/// What the canvas is to draw at its own size for a file.
struct Capture {
  CanvasContent content;
  int width = 0;
  int height = 0;
};

/// Writes files while the window goes on, one at a time. All methods on one thread.
class Exporter {
 public:
  explicit Exporter(std::function<void()> done) : job_(std::move(done)) {}

  bool isBusy() const { return capture_.has_value() || job_.isBusy(); }

  /// A file that another one needs: it is written first.
  struct Beside {
    std::filesystem::path path;
    std::function<Expected<void>()> write;  ///< on the job's thread
  };

  /// Writes whatever it is; not while it is busy. The destructor waits for it: it would be lost.
  void write(const std::filesystem::path& path, std::function<Expected<void>()> work,
             std::optional<Beside> beside = {});

  /// A picture of what the screen shows, once it is drawn: `wanted` says what, and `finish` takes it.
  void capture(Capture capture, const std::filesystem::path& path,
               std::map<std::string, std::string> metadata, std::optional<Beside> beside);
  const Capture* wanted() const { return capture_ ? &capture_->capture : nullptr; }
  void finish(const Image<Color8>& pixels);

  /// What became of a file.
  struct Written {
    std::filesystem::path path;
    std::filesystem::path beside;  ///< or empty
    Expected<void> done;
  };
  /// Once, when it is there.
  std::optional<Written> take() { return job_.take(); }

 private:
  struct WantedCapture {
    Capture capture;
    std::filesystem::path path;
    std::map<std::string, std::string> metadata;
    std::optional<Beside> beside;
  };

  std::optional<WantedCapture> capture_;
  BackgroundJob<Written> job_;
};

}  // namespace lightvane
