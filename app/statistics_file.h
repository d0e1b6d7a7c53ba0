#pragma once

#include <optional>
#include <string>

#include "core/inspect/error_sources.h"
#include "core/render/renderer.h"

namespace lightvane {

/// What --stats writes beside the renderer's own counts.
struct RunFacts {
  double wallSeconds = 0.0;  ///< from the start of the command to the last picture written
  double cpuSeconds = 0.0;   ///< of all threads, user and system
  std::uint64_t peakMemoryBytes = 0;
  int threads = 0;
  bool stoppedEarly = false;
  std::string sceneHash;
  std::optional<double> estimatedError;        ///< TargetError::error, where a target was set
  std::optional<double> samplingError;         ///< samplingErrorOf, likewise
  const ErrorSources* errorSources = nullptr;  ///< where they were asked for and found
};

/// Processor time and peak memory of this process so far, as the system counts them.
void measureProcess(RunFacts& facts);
/// Of these the processor time, of all threads.
double processCpuSeconds();
/// CPU time of the calling thread so far.
double threadCpuSeconds();

/// The content of a --stats file: one JSON object (docs/lightvane.md lists its keys).
std::string statisticsJson(const RenderStatistics& statistics, const RunFacts& facts,
                           const Parameters& parameters);

}  // namespace lightvane
