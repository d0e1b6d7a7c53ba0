#include "tests/bench/preview.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "core/render/session.h"
#include "tests/bench/measure.h"
#include "tests/bench/workbench.h"

namespace lightvane {
namespace {

using Clock = std::chrono::steady_clock;

/// What one request took, in milliseconds.
struct Answer {
  double firstWall = 0.0;
  double completeWall = 0.0;
  double cpu = 0.0;
  std::uint64_t newIndirect = 0;
  std::uint64_t newDirect = 0;  ///< DLVs, and direct light that was sampled in their place
};

double median(std::vector<Answer> answers, double Answer::*value) {
  std::sort(answers.begin(), answers.end(),
            [&](const Answer& a, const Answer& b) { return a.*value < b.*value; });
  return answers[answers.size() / 2].*value;
}

class Stopwatch {
 public:
  Answer ask(const SessionRequest& request) {
    const double cpu = processCpuSeconds();
    const Clock::time_point start = Clock::now();
    const auto since = [&] {
      return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    };
    Answer answer;
    std::unique_lock lock(mutex_);
    const std::uint64_t number = session_.request(request);
    wake_.wait(lock, [&] {
      const auto frame = session_.frame();
      if (!frame || frame->request != number) return false;
      if (answer.firstWall == 0.0) answer.firstWall = since();
      answer.newIndirect = frame->statistics.fullIndirect;
      answer.newDirect = frame->statistics.fullDirect;
      return frame->complete;
    });
    answer.completeWall = since();
    answer.cpu = 1e3 * (processCpuSeconds() - cpu);
    return answer;
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  Session session_{[this] {
    const std::lock_guard lock(mutex_);
    wake_.notify_all();
  }};
};

}  // namespace

std::string previewTable(int size, int rounds) {
  std::string table = fmt::format(
      "### The previewer's session, {0} x {0} pixels\n\n"
      "| scene | request | first picture, ms | complete, ms | CPU, ms | full indirect | full direct "
      "|\n|---|---|--:|--:|--:|--:|--:|\n",
      size);
  struct Case {
    const char* scene;
    const char* text;
    DlvMode mode;
  };
  // The last is what ./run opens.
  for (const Case& each : {Case{"cornell", "cornell", DlvMode::Auto},
                           Case{"cornell-mirror", "cornell-mirror, `dlv.mode` auto", DlvMode::Auto},
                           Case{"cornell-mirror", "cornell-mirror, `dlv.mode` always", DlvMode::Always}}) {
    const BenchScene scene(each.scene);
    std::vector<Answer> opened, loosened, moved;
    for (int round = 0; round < rounds; ++round) {
      Stopwatch stopwatch;
      SessionRequest request;
      request.scene = scene.scene;
      request.tracer = scene.tracer;
      request.camera = scene.camera;
      request.camera.width = request.camera.height = size;
      request.parameters.vectors.dlv.mode = each.mode;
      opened.push_back(stopwatch.ask(request));
      SessionRequest looser = request;
      looser.parameters.vectors.ilv.radiusScale = 0.5;
      loosened.push_back(stopwatch.ask(looser));
      stopwatch.ask(request);
      request.camera.position += 0.01f * scene.scene->diagonal * request.camera.right;
      moved.push_back(stopwatch.ask(request));
    }
    const auto row = [&](const char* what, const std::vector<Answer>& answers) {
      table +=
          fmt::format("| {} | {} | {:.0f} | {:.0f} | {:.0f} | {} | {} |\n", each.text, what,
                      median(answers, &Answer::firstWall), median(answers, &Answer::completeWall),
                      median(answers, &Answer::cpu), answers.front().newIndirect, answers.front().newDirect);
    };
    row("a scene, from nothing", opened);
    row("`ilv.radius_scale` 0.4 to 0.5", loosened);
    row("a view moved by 1 % of the scene's size", moved);
  }
  return table;
}

}  // namespace lightvane
