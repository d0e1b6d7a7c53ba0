#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/render/pinned_vectors.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// Everything that a session is to show. A value: the latest request wins, and the session does the least
/// that leads from what it has to what is wanted.
struct SessionRequest {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Tracer> tracer;  ///< of `scene`
  Camera camera;                         ///< with the size of the picture
  Parameters parameters;
  LightMix lights = {};
  bool locked = false;  ///< interpolate only
  bool paused = false;  ///< a coarse picture of what is known, and no more work
  int threads = 0;      ///< 0: as many as the machine has cores
  /// Vectors to begin with, from a file. Taken when it changes, in place of those that the session has.
  std::shared_ptr<const Snapshot> cache;
  std::uint64_t restarts = 0;  ///< where it changes, the session forgets its vectors
  /// Vectors that are put back where a change or a restart would drop them; null where there are none. To
  /// delete one it must be let go here too.
  std::shared_ptr<const PinnedVectors> pinned;
  /// Of vectors, visible points and film, counted by core/render/memory.h; 0: none. A picture that would take
  /// more is refused before it begins (SessionStatus::error); vectors that would go beyond end the rendering
  /// at its last whole pass (SessionStatus::stopped). The same request always ends at the same pass.
  std::size_t memoryLimitBytes = 0;

  bool operator==(const SessionRequest&) const = default;
};

/// What a session does at the moment.
struct SessionStatus {
  bool working = false;
  std::string error;    ///< why the last request ended without a picture; empty otherwise
  std::string stopped;  ///< why its picture will not become complete; empty otherwise
  // Of the rendering after its last pass, which frames need not show yet:
  std::uint64_t request = 0;
  RenderStatistics statistics;
  RenderProgress progress;
};

/// Renders in a thread of its own what it is asked for, and publishes frames. Vectors outlive requests as
/// long as they are true: a moved camera or a changed threshold is answered from them before a new one is
/// computed.
///
/// Threads: construction, destruction and all methods by any one thread; `published` is called on the
/// session's own thread, after each publication and whenever the status changes, and must not wait. Nothing
/// here waits for the renderer, but for the destructor, which waits for up to 50 ms.
///
/// Frames may be held for as long as one likes. They are freed on the session's thread, whoever lets go of
/// them last.
class Session {
 public:
  explicit Session(std::function<void()> published = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Asks for something else. Returns the request's number, for RenderFrame::request.
  std::uint64_t request(SessionRequest request);
  /// The newest frame; null before the first.
  std::shared_ptr<const RenderFrame> frame() const;
  SessionStatus status() const;

 private:
  /// Vectors and points of the last rendering with light vectors, for the next.
  struct Kept {
    Parameters parameters;
    Camera camera;
    LightMix lights;
    std::shared_ptr<const Snapshot> vectors;
    KnownView view;
  };
  struct Bin;

  void run();
  void begin(const SessionRequest& next);
  void keep();
  bool goesOn(const SessionRequest& next, const SessionRequest& before) const;
  CacheInput cacheFor(const SessionRequest& next, const SessionRequest* before);
  void publishPreview();
  void runPass();
  void publish(RenderFrame frame);
  bool hasWork() const;
  bool refuseForMemory(const SessionRequest& next);
  void fail(const std::string& what);

  std::function<void()> published_;
  std::shared_ptr<Bin> bin_;
  StopFlag interrupt_{false};  ///< something else is wanted
  StopFlag ending_{false};

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Under the mutex:
  std::optional<SessionRequest> pending_;
  std::uint64_t pendingNumber_ = 0;
  std::shared_ptr<const RenderFrame> frame_;
  SessionStatus status_;

  // Of the session's thread:
  std::optional<SessionRequest> current_;
  std::uint64_t currentNumber_ = 0;
  bool isShown_ = false;  ///< the frame is one of the current rendering
  std::uint64_t frameNumber_ = 0;
  std::shared_ptr<TaskPool> pool_;
  RenderContext context_;
  CacheInput cache_;
  std::unique_ptr<Renderer> renderer_;
  std::optional<Kept> kept_;
  int showFrom_ = 0;          ///< frames whose spacing is larger show less than the preview did
  bool unpublished_ = false;  ///< passes ended that no frame shows
  bool isNewScene_ = false;   ///< memory of the one before may be given back
  std::int64_t lastPublished_ = 0;

  std::thread thread_;
};

}  // namespace lightvane
