#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/background_job.h"
#include "app/rival_picture.h"
#include "core/base/error.h"
#include "core/render/session.h"

namespace lightvane {

/// The picture that others are measured against: path traced in the background for as long as one likes, or
/// read from a file. On one thread.
class Reference {
 public:
  /// Paths for every pixel after which it rests: what is left of the noise then is below what a screen shows.
  static constexpr int kMostSamples = 1 << 14;

  explicit Reference(std::function<void()> wake);

  /// Traces the picture that this request asks for, from its first sample; what there was before is gone.
  void trace(const SessionRequest& picture);
  /// Ends what is traced, whose scene is gone. A picture from a file stays.
  void forgetTraced();
  /// Holds on, or goes on.
  void setPaused(bool paused) { paused_ = paused; }
  /// Reads a picture in the scene's units. What there was before stays until it is there.
  void open(const std::filesystem::path& path);

  /// Takes what has become ready; why a picture could not be had, once. `yields`: the previewer's own picture
  /// is being made, and comes first. `now` in seconds, of any clock.
  std::optional<std::string> update(bool yields, double now);

  /// Null where there is none yet.
  RivalPicture* picture() const { return picture_.get(); }
  /// Paths are being traced, or wait for the previewer's own picture.
  bool isTracing() const { return tracing_ && !paused_; }
  bool isPaused() const { return tracing_ && paused_; }
  /// Whether it is, or will be, the picture that the request asks for; of a file only its size is known.
  bool shows(const SessionRequest& picture) const;
  /// Of a picture from a file; empty for others.
  const std::filesystem::path& path() const { return path_; }
  /// "path traced, 128 samples, noise 2.1 %", "room.exr"; empty where there is none.
  std::string text() const;

 private:
  struct FilePicture {
    std::filesystem::path path;
    Expected<LayeredImage> picture;
  };

  void sendRequest(const SessionRequest& wanted, bool yields);
  void takeFrame(double now);

  std::function<void()> wake_;
  std::unique_ptr<RivalPicture> picture_;
  std::filesystem::path path_;            ///< of a file
  std::optional<SessionRequest> wanted_;  ///< of what is traced
  std::optional<SessionRequest> sent_;
  std::uint64_t number_ = 0;  ///< the session's, of the first request for what is traced
  bool tracing_ = false;      ///< it was begun and has not come to its last sample
  bool paused_ = false;
  double taken_ = 0.0;                  ///< when
  std::optional<double> noise_;         ///< of a traced picture, pictureNoise
  BackgroundJob<double> noiseOfFrame_;  ///< takes longer than a frame of the window's may
  BackgroundJob<FilePicture> file_;
  std::unique_ptr<Session> session_;  ///< from the first picture that is traced
  BackgroundThreads ending_;          ///< sessions that nobody needs any more, until their passes have ended
};

}  // namespace lightvane
