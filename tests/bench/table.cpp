#include "tests/bench/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/check.h"
#include "tests/bench/embree_peer.h"
#include "tests/bench/measure.h"
#include "tests/bench/picture_error.h"
#include "tests/bench/tracing_stage.h"
#include "tests/bench/workbench.h"

namespace lightvane {
namespace {

void say(const std::string& text) { fmt::print(stderr, "{}\n", text); }

/// A line "key : value" of one of Linux's tables about itself.
std::string systemValue(const char* path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
    return start == std::string::npos ? std::string() : line.substr(start);
  }
  return "unknown";
}

std::string machine(const Samples& unit) {
  constexpr int kLevel = LIGHTVANE_X86_64_LEVEL;
  const std::string instructions = kLevel > 1 ? fmt::format("x86-64-v{}", kLevel) : "x86-64";
  double load = 0.0;
  LV_CHECK(getloadavg(&load, 1) == 1, "the system knows no load");
  return fmt::format(
      "{}, {} cores; {}, {}, {}. The Embree unit is {} s of CPU here. Load of the machine: {:.1f}.\n",
      systemValue("/proc/cpuinfo", "model name"), std::thread::hardware_concurrency(), LIGHTVANE_COMPILER,
      instructions, Tracer::libraryName(), withSpread(unit, 3), load);
}

/// y where a polyline through (x, y), straight in logarithms, has `at`; its ends go on beyond. x falls.
double interpolateLogarithms(const std::vector<double>& x, const std::vector<double>& y, double at) {
  std::size_t i = 1;
  while (i + 1 < x.size() && x[i] > at) ++i;
  const double t = std::log(at / x[i - 1]) / std::log(x[i] / x[i - 1]);
  return y[i - 1] * std::pow(y[i] / y[i - 1], t);
}

/// One scene's methods, in turn with the unit.
class Pictures {
 public:
  Pictures(const BenchScene& scene, const EmbreeUnit& unit, const TableOptions& options)
      : options_(options),
        name_(scene.name),
        sample_(pictureSample(options.size)),
        reference_(
            Reference::ofIndirect(scene, options.size, options.referenceSamples, options.referenceFolder)),
        naive_(options.naiveSamples.size()) {
    const auto pool = std::make_shared<TaskPool>(1);
    const double scale =
        square(static_cast<double>(options.size)) /
        (static_cast<double>(sample_.size()) * sample_.front().width * sample_.front().height);
    for (int round = 0; round < options.rounds; ++round) {
      say(fmt::format("{}: round {} of {}", scene.name, round + 1, options.rounds));
      const auto seed = static_cast<std::uint64_t>(round + 1);
      units_.values.push_back(unit.seconds());
      for (auto& [method, row] : whole_) {
        Parameters parameters = balanced(method);
        parameters.picture.seed = seed;
        Rendering rendering = render(scene, parameters, wholePicture(options.size), pool);
        row.seconds.values.push_back(rendering.cpuSeconds);
        row.error.values.push_back(reference_.relMse(rendering.film.indirect).relMse);
        row.standardError = reference_.relMse(rendering.film.indirect).standardError;
        row.statistics = rendering.statistics;
      }
      for (std::size_t n = 0; n < naive_.size(); ++n) {
        Parameters parameters = balanced(Method::Naive);
        parameters.picture.seed = seed;
        parameters.picture.naiveSamples = options.naiveSamples[n];
        double seconds = 0.0;
        std::vector<ImageRgb>& images = naive_[n].images.emplace_back();
        for (const PictureRegion& region : sample_) {
          Rendering rendering = render(scene, parameters, region, pool);
          seconds += rendering.cpuSeconds;
          images.push_back(std::move(rendering.film.indirect));
        }
        naive_[n].seconds.values.push_back(scale * seconds);
      }
    }
  }

  const Samples& seconds(Method method) const { return whole_.at(method).seconds; }
  const RenderStatistics& statistics(Method method) const { return whole_.at(method).statistics; }
  const Samples& units() const { return units_; }

  std::string rows() const {
    std::string rows;
    for (const auto& [method, row] : whole_) {
      rows += fmt::format("| {} | {} | {:.2f} | {} | {:.2e} ± {:.0e} | {} |\n", name_,
                          choiceName(kMethodNames, method), row.seconds.best(),
                          withSpread(ratio(row.seconds, units_), 2), row.error.median(), row.standardError,
                          row.statistics.ilvRecords);
    }
    for (std::size_t n = 0; n < naive_.size(); ++n) {
      rows += fmt::format("| {} | naive, {} samples | {:.2f} | {} | {:.2e} | |\n", name_,
                          options_.naiveSamples[n], naive_[n].seconds.best(),
                          withSpread(ratio(naive_[n].seconds, units_), 1),
                          reference_.relMseOfUnbiased(naive_[n].images, sample_));
    }
    return rows;
  }

  /// How often the vectors' time naive takes to their error.
  std::string equalError() const {
    std::vector<double> errors;
    std::vector<double> samples;
    for (std::size_t n = 0; n < naive_.size(); ++n) {
      errors.push_back(reference_.relMseOfUnbiased(naive_[n].images, sample_));
      samples.push_back(options_.naiveSamples[n]);
    }
    const WholeRow& vectors = whole_.at(Method::Vectors);
    const double error = vectors.error.median();
    Samples speedUp;
    for (std::size_t round = 0; round < vectors.seconds.values.size(); ++round) {
      std::vector<double> seconds;
      for (const NaiveRow& row : naive_) seconds.push_back(row.seconds.values[round]);
      speedUp.values.push_back(interpolateLogarithms(errors, seconds, error) / vectors.seconds.values[round]);
    }
    const double needed = interpolateLogarithms(errors, samples, error);
    return fmt::format("| {} | {:.0f}{} | {} |\n", name_, needed,
                       needed > samples.back() ? " (extrapolated)" : "", withSpread(speedUp, 1));
  }

  double referenceNoise() const { return reference_.noise(); }

 private:
  struct WholeRow {
    Samples seconds;
    Samples error;
    double standardError = 0.0;
    RenderStatistics statistics;
  };
  struct NaiveRow {
    Samples seconds;  ///< scaled to the whole picture
    std::vector<std::vector<ImageRgb>> images;
  };

  const TableOptions& options_;
  std::string name_;
  std::vector<PictureRegion> sample_;
  Reference reference_;
  Samples units_;
  std::map<Method, WholeRow> whole_ = {{Method::Vectors, {}}, {Method::Direct, {}}};
  std::vector<NaiveRow> naive_;
};

std::string threadsRow(const BenchScene& scene, const TableOptions& options) {
  say(fmt::format("{}: one and two threads", scene.name));
  const auto on = [&](int threads) {
    return [&, threads] {
      // A pool at a time: the smallest one alive limits all of oneTBB.
      return render(scene, balanced(Method::Vectors), wholePicture(options.size),
                    std::make_shared<TaskPool>(threads))
          .wallSeconds;
    };
  };
  const std::function<double()> things[] = {on(1), on(2)};
  const std::vector<Samples> wall = inTurn(options.rounds, things);
  return fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {} |\n", scene.name, wall[0].best(), wall[1].best(),
                     wall[0].best() / wall[1].best(), withSpread(ratio(wall[0], wall[1]), 2));
}

std::string tracingRow(const RayKind& kind) {
  const auto rate = [](const Samples& seconds) { return 1e-6 / seconds.median(); };
  return fmt::format("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {} | {} |\n", kind.name, rate(kind.ours),
                     rate(kind.one), rate(kind.eight), rate(kind.sixteen),
                     withSpread(ratio(kind.one, kind.ours), 2), withSpread(kind.rateRatio(), 2));
}

/// Where a rendering's time goes, as far as counted rays times their measured rates tell.
std::string tracingShare(const TracingStage& stage, const Pictures& pictures) {
  const RayCounts& rays = pictures.statistics(Method::Vectors).rays;
  // The rival `direct` sends the same shadow rays from visible points, and no others.
  const std::uint64_t pointShadows = pictures.statistics(Method::Direct).rays.shadow;
  struct Part {
    const char* name;
    std::uint64_t count;
    const RayKind& kind;
  };
  const Part parts[] = {{"camera", rays.camera, stage.gather},
                        {"first rays of gathers", rays.gather, stage.gather},
                        {"bounces", rays.bounce, stage.bounce},
                        {"shadow rays of visible points", pointShadows, stage.pointShadow},
                        {"shadow rays of bounces", rays.shadow - pointShadows, stage.bounceShadow},
                        {"visibility of vectors", rays.visibility, stage.pointShadow}};
  const double whole = pictures.seconds(Method::Vectors).median();
  std::string rows;
  double sum = 0.0;
  std::uint64_t count = 0;
  for (const Part& part : parts) {
    const double seconds = static_cast<double>(part.count) * part.kind.ours.median();
    rows += fmt::format("| {} | {:.2f} | {:.3f} | {:.0f} % |\n", part.name,
                        1e-6 * static_cast<double>(part.count), seconds, 100.0 * seconds / whole);
    sum += seconds;
    count += part.count;
  }
  return rows + fmt::format("| all rays | {:.2f} | {:.3f} | {:.0f} % |\n", 1e-6 * static_cast<double>(count),
                            sum, 100.0 * sum / whole);
}

/// Runs this program again for nothing but the picture: getrusage's ru_maxrss would count what this process
/// holds, because it survives exec.
double peakMegabytesOfAProcess(const std::string& sceneName, int size) {
  std::array<char, 4096> path{};
  const ssize_t length = readlink("/proc/self/exe", path.data(), path.size() - 1);
  LV_CHECK(length > 0, "no /proc/self/exe");
  const std::string command = fmt::format("'{}' --peak-memory {} {}", path.data(), sceneName, size);
  FILE* process = popen(command.c_str(), "r");
  LV_CHECK(process != nullptr, "cannot run {}", command);
  double megabytes = 0.0;
  const int read = std::fscanf(process, "%lf", &megabytes);
  const int status = pclose(process);
  LV_CHECK(read == 1 && status == 0, "{} ended with {}", command, status);
  return megabytes;
}

}  // namespace

TableOptions TableOptions::quick() {
  TableOptions options;
  options.size = 64;
  options.rounds = 2;  // a variance takes two
  options.referenceSamples = 16;
  options.floorPoints = 20;
  options.tracedRays = 5'000;
  options.naiveSamples = {8, 32};
  return options;
}

double peakMegabytes(const std::string& sceneName, int size) {
  const BenchScene scene(sceneName);
  render(scene, balanced(Method::Vectors), wholePicture(size), std::make_shared<TaskPool>());
  return std::stod(systemValue("/proc/self/status", "VmHWM")) * 1024e-6;  // given in kB of 1024
}

std::string performanceTable(const TableOptions& options) {
  const BenchScene cornell("cornell");
  const BenchScene mirror("cornell-mirror");
  const EmbreeUnit unit;
  const Pictures cornellPictures(cornell, unit, options);
  const Pictures mirrorPictures(mirror, unit, options);
  std::string text = "\n" + machine(cornellPictures.units());

  text += fmt::format(
      "\n### Whole pictures, {} x {}, one thread\n\n"
      "| scene | method | CPU, s | units | relMSE of the indirect layer | ILVs "
      "|\n|---|---|--:|--:|--:|--:|\n",
      options.size, options.size);
  text += cornellPictures.rows() + mirrorPictures.rows();
  text += fmt::format(
      "\nThe references have {} paths a pixel in each half. The noise of a half, which the product of both "
      "leaves out, is a relMSE of {:.1e} and {:.1e}.\n",
      options.referenceSamples, cornellPictures.referenceNoise(), mirrorPictures.referenceNoise());

  text +=
      "\n### To equal error\n\n| scene | samples that `naive` needs | `naive`'s CPU over `vectors`' "
      "|\n|---|--:|--:|\n";
  text += cornellPictures.equalError() + mirrorPictures.equalError();

  text +=
      "\n### Two threads\n\n| scene | one: wall, s | two: wall, s | ratio of the best | ratios of the rounds "
      "|\n|---|--:|--:|--:|--:|\n";
  text += threadsRow(cornell, options) + threadsRow(mirror, options);

  say("tracing");
  const TracingStage stage(cornell, unit, options.floorPoints, options.tracedRays, options.rounds + 4);
  text +=
      "\n### Rays, millions a second of CPU\n\n"
      "| rays | core/trace | Embree, 1 | Embree, 8 | Embree, 16 | rate over Embree, 1 | rate over the "
      "fastest |\n"
      "|---|--:|--:|--:|--:|--:|--:|\n";
  for (const RayKind* kind : {&stage.gather, &stage.bounce, &stage.pointShadow, &stage.bounceShadow})
    text += tracingRow(*kind);

  text +=
      "\n### Tracing in a balanced rendering of `cornell`\n\n| rays | millions | CPU, s | of the rendering "
      "|\n|---|--:|--:|--:|\n";
  text += tracingShare(stage, cornellPictures);

  say("memory");
  text += "\n### Peak memory\n\n| scene | MB |\n|---|--:|\n";
  for (const BenchScene* scene : {&cornell, &mirror})
    text += fmt::format("| {} | {:.0f} |\n", scene->name, peakMegabytesOfAProcess(scene->name, options.size));
  return text;
}

}  // namespace lightvane
