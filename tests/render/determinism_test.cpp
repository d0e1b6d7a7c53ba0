// Same scene, parameters and seed: same bytes, for any number of threads.

#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

/// Every body waits until all workers hold one: this ends only if there are as many as asked for.
std::size_t distinctWorkers(TaskPool& pool) {
  std::atomic<int> arrived = 0;
  std::mutex mutex;
  std::set<std::thread::id> ids;
  pool.forEach(static_cast<std::size_t>(pool.threadCount()), [&](std::size_t, int) {
    {
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    }
    ++arrived;
    while (arrived < pool.threadCount()) std::this_thread::yield();
  });
  return ids.size();
}

/// The way's scene; seen by way of a lens where the way's name says so.
Stage stageOf(const Way& way, int size, int threads) {
  SceneDescription description = shippedScene(way.scene, size, size);
  if (std::string(way.name).ends_with("_lens")) description.cameras.front().lensRadius = 0.05;
  return Stage(description, threads);
}

class Determinism : public testing::TestWithParam<Way> {
 protected:
  static Film render(int threads, std::uint64_t seed) {
    const int size = budget(40, 34);  // more than one tile either way
    const Stage stage = stageOf(GetParam(), size, threads);
    EXPECT_EQ(distinctWorkers(*stage.pool), static_cast<std::size_t>(threads));
    Parameters parameters = parametersWith(GetParam().settings);
    parameters.picture.seed = seed;
    return picture(stage, parameters).film;
  }
};

TEST_P(Determinism, SameBytesForAnyNumberOfThreads) {
  const Film one = render(1, 1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(difference(one, render(threads, 1)), "") << threads;
}

TEST_P(Determinism, SameBytesOnASecondRun) { EXPECT_EQ(difference(render(2, 1), render(2, 1)), ""); }

TEST_P(Determinism, AnotherSeedIsAnotherPicture) { EXPECT_NE(difference(render(2, 1), render(2, 2)), ""); }

INSTANTIATE_TEST_SUITE_P(
    Ways, Determinism,
    testing::Values(
        Way{"vectors", "cornell-mirror.toml", {{"preset", "draft"}}},
        Way{"vectors_glossy", "cornell-glossy.toml", {{"preset", "draft"}, {"film.samples", "2"}}},
        Way{"vectors_dlv",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}, {"ilv.seed", "40"}}},
        Way{"vectors_paper",
            "cornell-mirror.toml",
            {{"preset", "draft"}, {"method.rules", "paper"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}}},
        Way{"vectors_printed",
            "cornell-mirror.toml",
            {{"preset", "draft"}, {"method.rules", "printed"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}}},
        Way{"vectors_lens", "cornell-mirror.toml", {{"preset", "draft"}, {"film.samples", "4"}}},
        Way{"vectors_adaptive",
            "cornell-mirror.toml",
            {{"preset", "draft"}, {"film.samples", "4"}, {"film.contrast", "0.1"}}},
        Way{"path_lens",
            "cornell-mirror.toml",
            {{"method.name", "path"}, {"path.samples", "8"}, {"film.samples", "8"}}},
        Way{"path", "cornell-mirror.toml", {{"method.name", "path"}, {"path.samples", "20"}}},
        Way{"naive", "cornell-mirror.toml", {{"method.name", "naive"}, {"naive.samples", "32"}}},
        Way{"direct", "cornell-mirror.toml", {{"method.name", "direct"}}}),
    [](const testing::TestParamInfo<Way>& way) { return way.param.name; });

}  // namespace
}  // namespace lightvane::render_test
