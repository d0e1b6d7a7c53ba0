#include "app/render_status.h"

#include <fstream>

#include <unistd.h>

#include "core/inspect/record_names.h"
#include "core/inspect/units.h"

namespace lightvane {

std::uint64_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t memoryBytes() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

RenderStatus renderStatus(const RenderStatistics& statistics, const RenderProgress& progress,
                          double workedSeconds) {
  // Before this part, what is left cannot be told from what was done.
  constexpr double kLeastFraction = 0.02;
  RenderStatus status;
  status.pass = statistics.passes;
  status.stage = progress.stage;
  status.fraction = progress.fraction;
  status.ilvRecords = statistics.ilvRecords;
  status.dlvRecords = statistics.dlvRecords;
  status.hitRate = progress.hitRate;
  status.faultySamples = statistics.faults.count;
  status.unanswered = statistics.unanswered;
  if (workedSeconds > 0.0) {
    status.raysPerSecond = static_cast<double>(statistics.rays.total()) / workedSeconds;
    if (status.fraction > kLeastFraction && status.fraction < 1.0)
      status.secondsLeft = workedSeconds * (1.0 - status.fraction) / status.fraction;
  }
  return status;
}

RenderStatus renderStatus(const RenderFrame& frame, double workedSeconds) {
  RenderProgress progress = frame.progress;
  if (frame.reduction > 1) {
    progress.stage = "first look";
    progress.fraction = 0.0;
  }
  if (frame.complete) progress.fraction = 1.0;
  RenderStatus status = renderStatus(frame.statistics, progress, workedSeconds);
  // The passes of a first look are none of the picture's.
  if (frame.reduction > 1) status.pass = 0;
  if (frame.snapshot) {
    status.ilvRecords = frame.snapshot->indirect.size();
    status.dlvRecords = frame.snapshot->directCount();
  }
  status.complete = frame.complete;
  return status;
}

SceneSummary summaryOf(const Document& document, const Parameters& parameters) {
  const Scene& scene = *document.scene;
  SceneSummary summary;
  summary.path = document.path;
  summary.unit = lengthUnit(scene);
  summary.metresPerUnit = scene.metresPerUnit;
  summary.diagonalMetres = static_cast<double>(scene.diagonal) * scene.metresPerNormalisedUnit();
  const std::vector<bool> hasVectors = lightsWithVectors(scene, parameters);
  for (std::size_t light = 0; light < scene.lights.size(); ++light)
    summary.lights.push_back({lightName(scene, static_cast<std::uint32_t>(light)), hasVectors[light]});
  summary.cameras = scene.cameraNames;
  summary.needs = scene.needs;
  summary.start = document.start;
  return summary;
}

}  // namespace lightvane
