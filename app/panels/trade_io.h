#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/measure/sweep.h"
#include "core/render/parameters.h"

namespace lightvane {

// What the Trade panel asks to be measured, and what it is told of that.

/// The seeds of a plan: more take hours and say little more.
inline constexpr int kMostTradeSeeds = 100;
/// Points of a plan; more than a plot can tell apart.
inline constexpr std::size_t kMostTradePoints = 400;
inline constexpr std::size_t kMostTradeParameters = 3;
/// Of the reference, where nothing else is asked for. What it adds is taken off errors that are means of
/// squares, so that these tell points apart whose errors are far smaller.
inline constexpr float kTradeNoise = 0.05f;

/// A measurement of the picture as it is set now, with other values of some parameters.
struct TradePlan {
  std::vector<VariedParameter> varied;
  int seeds = 1;      ///< of each point, from the picture's on
  int reduction = 1;  ///< one pixel for so many of the picture, across and down; of a file, its size says
  std::filesystem::path reference;      ///< an EXR of this view; empty: paths are traced first
  double referenceNoise = kTradeNoise;  ///< of traced paths, at most: as `lightvane reference --target`
};

/// A measurement as far as it is.
struct TradeStatus {
  bool isRunning = false;
  bool isTracing = false;  ///< the reference, which could serve as it is
  bool isWaiting = false;  ///< for the picture of the window, which comes first
  std::string stage;       ///< "7 of 75: ilv.rows=8, seed 2"; what ended it; empty before the first
  double fraction = 0.0;   ///< of the stage: the reference, then the points
  std::optional<double> secondsLeft;  ///< of the stage, estimated from what it worked so far
  std::string error;                  ///< why there is nothing to measure
  std::string stale;                  ///< why the points are not of what is shown; empty where they are
  std::string reference;              ///< what errors are against: "path traced, 256 paths, noise 0.98 %"
  /// The points in the order in which they were begun; null before the first. Another object where anything
  /// in it changed.
  std::shared_ptr<const Sweep> sweep;
  std::vector<Parameters> parameters;  ///< of each point, with the first seed
  std::optional<std::size_t> shown;    ///< the point whose picture others are compared with
};

}  // namespace lightvane
