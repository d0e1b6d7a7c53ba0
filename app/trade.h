#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/background_threads.h"
#include "app/document.h"
#include "app/panels/trade_io.h"
#include "core/image/image.h"
#include "core/render/renderer.h"

namespace lightvane {

/// What a measurement is of, beside the plan: the window's picture as it was when it began.
struct TradeSubject {
  std::shared_ptr<const Document> document;
  Camera camera;  ///< with the size of the whole picture
  Parameters parameters;
  LightMix lights;
};

/// Measures what other parameters cost and bring, as `lightvane sweep --threads 1` does, but in a thread of
/// the lowest priority beside a window. All methods on one thread; only the destructor waits, for as long as
/// a measurement takes to stop: within 50 ms, or until a picture's metrics are computed.
class TradeMeasurement {
 public:
  /// `wake` is called on the measurement's thread whenever there is something new to show.
  explicit TradeMeasurement(std::function<void()> wake);
  ~TradeMeasurement();
  TradeMeasurement(const TradeMeasurement&) = delete;
  TradeMeasurement& operator=(const TradeMeasurement&) = delete;

  /// Begins anew; what was measured before is gone, but for paths that serve as the reference again.
  void start(const TradePlan& plan, const TradeSubject& subject);
  /// Paths that are traced serve as they are.
  void useReference();
  /// What was measured stays.
  void stop();
  /// Stops, and forgets all points; paths stay for the next measurement.
  void clear();
  /// While it yields, no pass begins.
  void setYields(bool yields);

  /// All but `shown`. `now` is what the window shows: points of something else are stale.
  TradeStatus status(const std::optional<TradeSubject>& now) const;
  /// Of the point's first seed, in the scene's units; null where there is none.
  std::shared_ptr<const ImageRgb> picture(std::size_t point) const;
  /// By how much pictures are smaller than the window's.
  int reduction() const;

 private:
  struct Shared;
  struct TracedReference;
  class Work;

  std::function<void()> wake_;
  std::optional<TradeSubject> subject_;
  std::shared_ptr<Shared> shared_;  ///< null before the first measurement
  bool yields_ = false;
  BackgroundThreads threads_;  // last: they use the others
};

}  // namespace lightvane
