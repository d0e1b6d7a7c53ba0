#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/tasks.h"

namespace lightvane {

/// Thrown where a LoadWatch is looked at and says stop. It is no std::exception, so that nothing on the way
/// takes it for a fault or for a warning: whoever began the work catches it, by untilStopped.
struct LoadStopped {};

/// Who waits for a scene to be loaded: wants to know how far that is, and may want it to end. What takes one
/// looks at it every few milliseconds of work at most, and throws LoadStopped where it says stop; what was
/// half made is then gone. One watch belongs to one thread, but for what says otherwise.
class LoadWatch {
 public:
  LoadWatch() = default;
  virtual ~LoadWatch() = default;
  LoadWatch(const LoadWatch&) = delete;
  LoadWatch& operator=(const LoadWatch&) = delete;

  /// Never stops anything and is told nothing; each thread has one.
  static LoadWatch& none();

  /// Whether the work is to end: once true, always true. Any thread.
  virtual bool isStopped() = 0;

  /// Throws LoadStopped where the work is to end.
  void look() {
    if (isStopped()) throw LoadStopped();
  }
  /// As look, and tells how much is done of the part under way, in [0, 1].
  void look(double fraction) {
    look();
    tellFraction(fraction);
  }
  /// To be called for each small piece of work, up to some microseconds: looks for the first of many.
  void piece(std::size_t i) {
    if (i % kPiecesPerLook == 0) look();
  }
  /// As piece, of `count` that are all of the part under way.
  void piece(std::size_t i, std::size_t count) {
    if (i % kPiecesPerLook == 0) look(static_cast<double>(i) / static_cast<double>(count));
  }

  /// How much is done of the part under way, for those who must not throw. Any thread, one at a time.
  void tellFraction(double fraction);
  /// What follows is this part of the stage: its fractions lie between these two.
  void part(double from, double to);

 protected:
  /// What is done now ("reading rock.obj"), and how much of it; nothing where that is not known. Within a
  /// stage the fractions rise. Called as tellFraction is.
  virtual void tell(const std::string& stage, std::optional<double> fraction) = 0;

 private:
  friend class LoadStage;

  // A piece takes from 10 ns (a number of a buffer) to 2 us (a face of an OBJ file): 2 ms at most.
  static constexpr std::size_t kPiecesPerLook = 1024;

  struct Stage {
    std::string text;
    std::optional<double> fraction;
    double from = 0.0, to = 1.0;  ///< of the part under way
  };
  Stage stage_;
};

/// What a thread does while this lives. Then it does again what it did before, where that has a name.
class LoadStage {
 public:
  LoadStage(LoadWatch& watch, std::string text);
  ~LoadStage();
  LoadStage(const LoadStage&) = delete;
  LoadStage& operator=(const LoadStage&) = delete;

 private:
  LoadWatch& watch_;
  LoadWatch::Stage outer_;
};

/// How far a loading is, kept for another thread to read. Any thread.
class LoadProgress {
 public:
  struct State {
    std::string stage;               ///< "reading rock.obj"; empty before the first
    std::optional<double> fraction;  ///< of the stage, in [0, 1]; nothing where it is not known
  };

  State state() const;
  void set(const std::string& stage, std::optional<double> fraction);

 private:
  mutable std::mutex mutex_;
  State state_;
};

/// "reading rock.obj, 42 %"
std::string progressText(const LoadProgress::State& state);

/// Stops when a flag is set. The flag and the progress must outlive it.
class FlagWatch final : public LoadWatch {
 public:
  FlagWatch(const StopFlag& stop, LoadProgress& progress) : stop_(stop), progress_(progress) {}
  bool isStopped() override { return stop_.load(std::memory_order_relaxed); }

 private:
  void tell(const std::string& stage, std::optional<double> fraction) override {
    progress_.set(stage, fraction);
  }

  const StopFlag& stop_;
  LoadProgress& progress_;
};

/// What `work` returns, an Expected; where it was stopped, an error with Error::isStop.
template <class Work>
auto untilStopped(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const LoadStopped&) {
    return tl::unexpected(stopError());
  }
}

}  // namespace lightvane
