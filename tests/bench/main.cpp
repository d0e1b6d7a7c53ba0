// lightvane_bench: what Lightvane costs, in CPU time and in ratios measured in one run.
//
//   lightvane_bench                          rows of Google Benchmark; takes its options
//   lightvane_bench --table                  the tables of docs/performance.md, on stdout
//   lightvane_bench --table --quick          likewise, of pictures so small that the numbers mean nothing
//   lightvane_bench --corrections [--quick]  the tables of docs/method.md: what each correction is worth
//   lightvane_bench --preview                how soon the previewer's session answers
//   lightvane_bench --instances              what sharing meshes costs rays, and spares of memory
//   lightvane_bench --large                  a million triangles and 200 lights, of which few are seen
//   lightvane_bench --gathers                what gathers cost, and how sure they are
//   lightvane_bench --targets [--quick]      whole pictures: their error and time against what they should be
//   lightvane_bench --peak-memory SCENE N    the most memory that a picture of N x N pixels takes, in MB

#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "core/base/freed_memory.h"
#include "core/base/tasks.h"
#include "tests/bench/corrections.h"
#include "tests/bench/gathers.h"
#include "tests/bench/instances.h"
#include "tests/bench/large.h"
#include "tests/bench/preview.h"
#include "tests/bench/table.h"
#include "tests/bench/targets.h"

namespace {

/// Rows of a Markdown table, in the one unit in which all of them can be read.
class MarkdownReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const auto each = run.counters.find("each");
      if (each != run.counters.end()) rows_[run.run_name.str()][run.aggregate_name] = each->second.value;
    }
  }
  /// Only now: rows that take turns come in any order.
  void Finalize() override {
    fmt::print("\n### Stages, on `cornell`\n\n| stage | each, µs of CPU |\n|---|--:|\n");
    for (auto& [name, aggregates] : rows_) {
      fmt::print("| {} | {:.3f} ± {:.0f} % |\n", name, 1e6 * aggregates["median"], 100.0 * aggregates["cv"]);
    }
  }

 private:
  std::map<std::string, std::map<std::string, double>> rows_;
};

}  // namespace

int main(int argc, char** argv) {
  lightvane::keepFreedMemory();  // as the program does
  const lightvane::FlushDenormals flush;
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "--peak-memory") {
    fmt::print("{}\n", lightvane::peakMegabytes(words[1], std::stoi(words[2])));
    return 0;
  }
  if (words == std::vector<std::string>{"--table", "--quick"}) {
    fmt::print("{}", lightvane::performanceTable(lightvane::TableOptions::quick()));
    return 0;
  }
  if (words == std::vector<std::string>{"--table"}) {
    fmt::print("{}", lightvane::performanceTable(lightvane::TableOptions()));
    // Nine repetitions of each row, in turn.
    std::vector<std::string> options = {argv[0], "--benchmark_repetitions=9",
                                        "--benchmark_enable_random_interleaving=true",
                                        "--benchmark_min_time=0.05"};
    std::vector<char*> pointers;
    for (std::string& option : options) pointers.push_back(option.data());
    int count = static_cast<int>(pointers.size());
    benchmark::Initialize(&count, pointers.data());
    MarkdownReporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
  }
  if (words == std::vector<std::string>{"--preview"}) {
    fmt::print("{}", lightvane::previewTable(512, 9));
    return 0;
  }
  if (words == std::vector<std::string>{"--instances"}) {
    fmt::print("{}", lightvane::instancesTable(9));
    return 0;
  }
  if (words == std::vector<std::string>{"--targets"}) {
    fmt::print("{}", lightvane::targetsTable(lightvane::TargetOptions()));
    return 0;
  }
  if (words == std::vector<std::string>{"--targets", "--quick"}) {
    fmt::print("{}", lightvane::targetsTable(lightvane::TargetOptions::quick()));
    return 0;
  }
  if (words == std::vector<std::string>{"--gathers"}) {
    fmt::print("{}", lightvane::gathersTable(3, 16));
    return 0;
  }
  if (words == std::vector<std::string>{"--large"}) {
    fmt::print("{}", lightvane::largeTable(3));
    return 0;
  }
  if (words == std::vector<std::string>{"--corrections"}) {
    fmt::print("{}", lightvane::correctionsTable(lightvane::CorrectionOptions()));
    return 0;
  }
  if (words == std::vector<std::string>{"--corrections", "--quick"}) {
    fmt::print("{}", lightvane::correctionsTable(lightvane::CorrectionOptions::quick()));
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
