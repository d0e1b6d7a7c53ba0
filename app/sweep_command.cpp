#include "app/sweep_command.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "app/command_load.h"
#include "app/stop.h"
#include "app/sweep_work.h"
#include "app/text_table.h"
#include "core/inspect/units.h"

namespace lightvane {
namespace {

using Clock = std::chrono::steady_clock;

/// A choice of a method without vectors that is put on the same axes.
struct Rival {
  const char* method;
  const char* key;  ///< of what its cost grows with; null: it has one picture
  std::vector<const char*> values;
};
const std::vector<Rival>& rivals() {
  static const std::vector<Rival> all = {{"direct", nullptr, {}},
                                         {"path", "path.samples", {"4", "16", "64", "256"}},
                                         {"naive", "naive.samples", {"8", "32", "128"}}};
  return all;
}

/// The front, for a terminal.
std::string frontText(const Sweep& sweep) {
  std::vector<std::vector<std::string>> rows = {{"CPU time", "error", "ILVs", "DLVs", "point"}};
  for (const std::size_t i : paretoFront(sweep, kFirstMetric)) {
    const SweepPoint& point = sweep.points[i];
    const Spread error = metricSpread(point, kFirstMetric).value_or(Spread{});
    rows.push_back({fmt::format("{} s", numberText(cpuSpread(point).mean)),
                    numberText(100.0 * error.mean) + " %" +
                        (point.runs.size() > 1 ? " ± " + numberText(100.0 * error.standardDeviation, 2) : ""),
                    std::to_string(point.runs.front().ilvRecords),
                    std::to_string(point.runs.front().dlvRecords), point.name()});
  }
  return "No point is both faster and nearer to the reference than one of these (CPU time, relative error of "
         "the "
         "picture, over all seeds):\n\n" +
         alignedTable(rows);
}

Expected<void> addPoint(SweepWork& work, const std::string& method, const SweepSettings& settings) {
  const auto parameters = work.parametersOf(method, settings, "--vary {}={}");
  if (!parameters) return tl::unexpected(parameters.error());
  work.add({method, settings, *parameters, {}, {}});
  return {};
}

Expected<void> plan(SweepWork& work) {
  const SweepArguments& arguments = work.arguments();
  const auto shared = work.sharedParameters();
  if (!shared) return tl::unexpected(shared.error());
  const std::vector<SweepSettings> chosen =
      arguments.random   ? sweepRandom(arguments.varied, *arguments.random, shared->picture.seed)
      : arguments.around ? sweepAround(arguments.varied)
                         : sweepGrid(arguments.varied);
  for (const SweepSettings& settings : chosen) {
    if (auto added = addPoint(work, "vectors", settings); !added) return added;
  }
  for (const Rival& rival : rivals()) {
    if (std::find(arguments.rivals.begin(), arguments.rivals.end(), rival.method) == arguments.rivals.end())
      continue;
    std::vector<SweepSettings> settings;
    for (const char* value : rival.values) settings.push_back({{rival.key, value}});
    if (rival.key == nullptr) settings.emplace_back();
    for (const SweepSettings& one : settings) {
      if (auto added = addPoint(work, rival.method, one); !added) return added;
    }
  }
  return {};
}

/// Finds all that can be wrong before the work begins.
Expected<void> prepareSweep(SweepWork& work, const StopFlag& stop) {
  CommandLoad loading(stop, work.arguments().view.quiet);
  if (auto loaded = work.load(loading.watch()); !loaded) return loaded;
  if (auto planned = plan(work); !planned) return planned;
  return work.begin(loading.watch());
}

/// True where all runs are done. Seed by seed over all points: what else the machine does meets them all
/// alike.
Expected<bool> runAll(SweepWork& work) {
  SweepProgress progress;
  const SweepWork* const all[] = {&work};
  for (int seed = 0; seed < work.arguments().seeds; ++seed) {
    auto done = work.runSeed(seed, all, progress);
    if (!done || !*done) return done;
  }
  return true;
}

}  // namespace

Expected<ExitCode> runSweep(const SweepArguments& arguments) {
  const StopFlag& stop = stopOnSignals();
  SweepWork work(arguments, stop, std::make_shared<TaskPool>(arguments.view.threads));
  const auto prepared = untilStopped([&] { return prepareSweep(work, stop); });
  if (!prepared) return endWithoutScene(prepared.error(), arguments.view.quiet);
  std::optional<TimeLimit> limit;
  limitTime(limit, Clock::now(), arguments.view.timeLimitSeconds);
  const auto done = runAll(work);
  // What is finished is shown, whatever ended the work.
  const Sweep sweep = work.collected();
  if (auto written = work.writeReport(sweep); !written) return tl::unexpected(written.error());
  if (!done) return tl::unexpected(done.error());
  std::size_t runs = 0;
  for (const SweepPoint& point : sweep.points) runs += point.runs.size();
  if (runs > 0) {
    if (auto printed = printAnswer(frontText(sweep)); !printed) return tl::unexpected(printed.error());
  }
  if (!arguments.view.quiet) {
    printNote(fmt::format("{}{} rendering{} in {}: open index.html there", *done ? "" : "stopped: ", runs,
                          runs == 1 ? "" : "s", arguments.folder.string()));
    if (!*done) printNote("the same command goes on from here");
  }
  return stopSignalled() && !*done ? ExitCode::Stopped : ExitCode::Success;
}

}  // namespace lightvane
