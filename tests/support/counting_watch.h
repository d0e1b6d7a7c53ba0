#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/load_watch.h"

namespace lightvane::test {

/// Stops a loading after so many looks, and keeps all that it is told.
class CountingWatch final : public LoadWatch {
 public:
  struct Told {
    std::string stage;
    std::optional<double> fraction;
  };

  explicit CountingWatch(std::size_t allowed = std::numeric_limits<std::size_t>::max() - 1)
      : allowed_(allowed) {}

  bool isStopped() override { return ++looks_ > allowed_; }

  std::size_t looks() const { return looks_; }
  const std::vector<Told>& told() const { return told_; }
  /// The stages in their order, one that is gone back to once more.
  std::vector<std::string> stages() const {
    std::vector<std::string> stages;
    for (const Told& each : told_) {
      if (stages.empty() || stages.back() != each.stage) stages.push_back(each.stage);
    }
    return stages;
  }

 private:
  void tell(const std::string& stage, std::optional<double> fraction) override {
    told_.push_back({stage, fraction});
  }

  const std::size_t allowed_;
  std::atomic<std::size_t> looks_ = 0;
  std::vector<Told> told_;
};

/// Fractions lie in [0, 1] and rise within each stage, from where it was left if it was.
inline void expectRisingFractions(const CountingWatch& watch) {
  for (std::size_t i = 0; i < watch.told().size(); ++i) {
    const auto& [stage, fraction] = watch.told()[i];
    if (!fraction) continue;
    EXPECT_GE(*fraction, 0.0) << stage;
    EXPECT_LE(*fraction, 1.0) << stage;
    for (std::size_t before = i; before-- > 0;) {
      if (watch.told()[before].stage != stage) continue;
      // Without a fraction, a stage of the same name begins.
      EXPECT_GE(*fraction, watch.told()[before].fraction.value_or(0.0)) << stage;
      break;
    }
  }
}

}  // namespace lightvane::test
