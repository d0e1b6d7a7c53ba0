#include "app/statistics_file.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "app/error_report.h"
#include "app/version.h"

namespace lightvane {
namespace {

using Json = nlohmann::ordered_json;

/// The value of every parameter, typed as JSON types it; choices and lengths as text.
struct JsonWriter {
  Json object = Json::object();

  template <class T>
  void operator()(const T& value, const Field& field, const Range<T>&) {
    if constexpr (std::is_arithmetic_v<T>) {
      object[field.key] = value;
    } else {
      object[field.key] = parameter_text::format(value);
    }
  }
  void operator()(const bool& value, const Field& field) { object[field.key] = value; }
  template <class E, std::size_t N>
  void operator()(const E& value, const Field& field, const std::array<Choice<E>, N>& choices) {
    object[field.key] = choiceName(choices, value);
  }
};

}  // namespace

void measureProcess(RunFacts& facts) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  facts.cpuSeconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  facts.peakMemoryBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

double processCpuSeconds() {
  RunFacts facts;
  measureProcess(facts);
  return facts.cpuSeconds;
}

double threadCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::string statisticsJson(const RenderStatistics& statistics, const RunFacts& facts,
                           const Parameters& parameters) {
  JsonWriter all;
  visitParameters(parameters, all);
  const RayCounts& rays = statistics.rays;
  Json json = {
      {"version", versionText()},
      {"scene_hash", facts.sceneHash},
      {"method", all.object["method.name"]},
      {"threads", facts.threads},
      {"passes", statistics.passes},
      {"stopped_early", facts.stoppedEarly},
      {"wall_seconds", facts.wallSeconds},
      {"cpu_seconds", facts.cpuSeconds},
      {"peak_memory_bytes", facts.peakMemoryBytes},
      {"rays",
       {{"camera", rays.camera},
        {"gather", rays.gather},
        {"bounce", rays.bounce},
        {"shadow", rays.shadow},
        {"visibility", rays.visibility},
        {"total", rays.total()}}},
      {"ilv_records", statistics.ilvRecords},
      {"dlv_records", statistics.dlvRecords},
      {"full_indirect", statistics.fullIndirect},
      {"interpolated_indirect", statistics.interpolatedIndirect},
      {"full_direct", statistics.fullDirect},
      {"interpolated_direct", statistics.interpolatedDirect},
      {"unanswered", statistics.unanswered},
      {"refined_pixels", statistics.refinedPixels},
      {"non_finite_samples", statistics.faults.count},
      {"parameters", all.object},
  };
  if (facts.errorSources != nullptr) json["error_sources"] = errorSourceJson(*facts.errorSources);
  if (facts.estimatedError) json["estimated_error"] = *facts.estimatedError;
  if (facts.samplingError) json["estimated_sampling_error"] = *facts.samplingError;
  return json.dump(2) + "\n";
}

}  // namespace lightvane
