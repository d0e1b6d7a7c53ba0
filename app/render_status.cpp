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

RenderStatus renderStatus(const RenderFrame& frame, double workedSeconds) {
  // Before this part, what is left cannot be told from what was done.
  constexpr double kLeastFraction = 0.02;
  const RenderStatistics& statistics = frame.statistics;
  const bool isFirstLook = frame.reduction > 1;
  RenderStatus status;
  status.pass = statistics.passes;
  status.stage = isFirstLook ? "first look" : frame.progress.stage;
  status.fraction = frame.complete ? 1.0 : isFirstLook ? 0.0 : frame.progress.fraction;
  status.ilvRecords = frame.snapshot ? frame.snapshot->indirect.size() : statistics.ilvRecords;
  status.dlvRecords = frame.snapshot ? frame.snapshot->directCount() : statistics.dlvRecords;
  status.hitRate = frame.progress.hitRate;
  status.faultySamples = statistics.faults.count;
  status.unanswered = statistics.unanswered;
  status.complete = frame.complete;
  if (workedSeconds > 0.0) {
    status.raysPerSecond = static_cast<double>(statistics.rays.total()) / workedSeconds;
    if (!status.complete && status.fraction > kLeastFraction)
      status.secondsLeft = workedSeconds * (1.0 - status.fraction) / status.fraction;
  }
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
