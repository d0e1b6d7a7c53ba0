// A picture is made by passes: each is whole or was not there, a stopped rendering goes on as if it had not
// been stopped, and vectors that exist are not computed again.

#include <atomic>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

const Way kWays[] = {
    {"vectors", "cornell-mirror.toml", {{"ilv.rows", "8"}, {"ilv.columns", "16"}, {"ilv.seed", "20"}}},
    {"vectors_dlv",
     "cornell-glossy.toml",
     {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "200"}, {"ilv.seed", "20"}}},
    {"vectors_paper",
     "cornell-mirror.toml",
     {{"preset", "draft"}, {"method.rules", "paper"}, {"dlv.mode", "always"}, {"dlv.seed", "200"}}},
    {"vectors_adaptive",
     "cornell-mirror.toml",
     {{"preset", "draft"}, {"ilv.seed", "20"}, {"film.samples", "4"}, {"film.contrast", "0.1"}}},
    {"path", "cornell-mirror.toml", {{"method.name", "path"}, {"path.samples", "40"}}},
    {"naive", "cornell-mirror.toml", {{"method.name", "naive"}, {"naive.samples", "32"}}},
    {"direct", "cornell-mirror.toml", {{"method.name", "direct"}}},
};

class Passes : public testing::TestWithParam<Way> {
 protected:
  static SceneDescription scene(int size = 40) { return shippedScene(GetParam().scene, size, size); }
  static Parameters parameters() { return parametersWith(GetParam().settings); }
};

/// Runs a pass that is stopped after `delay`; false where it was whole before.
bool runStopped(Renderer& renderer, std::chrono::microseconds delay) {
  StopFlag stop = delay.count() == 0;
  std::thread stopper([&] {
    std::this_thread::sleep_for(delay);
    stop = true;
  });
  const bool whole = renderer.runPass(stop);
  stopper.join();
  return !whole;
}

TEST_P(Passes, StoppedInTheMiddleLeaveTheLastWholeOne) {
  const Stage stage(scene());
  const StopFlag never = false;
  const std::unique_ptr<Renderer> renderer = makeRenderer(stage.context(parameters()));
  const Picture undisturbed = picture(stage, parameters());
  int stopped = 0;
  while (!renderer->done()) {
    const Film before = renderer->film();
    EXPECT_EQ(badPixel(before), "") << renderer->progress().stage;
    const RenderStatistics statistics = renderer->statistics();
    bool isWhole = false;
    for (const int delay : {0, 200, 1500}) {
      if (!runStopped(*renderer, std::chrono::microseconds(delay))) {
        isWhole = true;
        break;
      }
      ++stopped;
      EXPECT_EQ(difference(before, renderer->film()), "") << renderer->progress().stage;
      EXPECT_EQ(renderer->statistics().passes, statistics.passes);
      EXPECT_EQ(renderer->statistics().ilvRecords, statistics.ilvRecords);
      EXPECT_EQ(renderer->statistics().dlvRecords, statistics.dlvRecords);
      EXPECT_EQ(renderer->statistics().fullIndirect, statistics.fullIndirect);
      EXPECT_EQ(renderer->statistics().fullDirect, statistics.fullDirect);
    }
    if (!isWhole) {
      ASSERT_TRUE(renderer->runPass(never));
    }
  }
  EXPECT_GT(stopped, 0);
  EXPECT_EQ(difference(undisturbed.film, renderer->film()), "");
  EXPECT_EQ(undisturbed.statistics.fullIndirect, renderer->statistics().fullIndirect);
  EXPECT_EQ(undisturbed.statistics.fullDirect, renderer->statistics().fullDirect);
}

TEST_P(Passes, GoOnFromACheckpoint) {
  const Stage stage(scene());
  const StopFlag never = false;
  const StopFlag now = true;
  const Picture undisturbed = picture(stage, parameters());
  std::unique_ptr<Renderer> renderer = makeRenderer(stage.context(parameters()));
  // Before every pass: stopped within it, put away, taken up by another renderer, which is stopped at once,
  // put away again, and taken up by a third.
  for (int pass = 0; pass < 3 && !renderer->done(); ++pass) {
    runStopped(*renderer, std::chrono::microseconds(700));
    for (int again = 0; again < 2; ++again) {
      const Checkpoint checkpoint = renderer->checkpoint();
      renderer = makeRenderer(stage.context(parameters()));
      renderer->restore(checkpoint);
      if (again == 0) {
        EXPECT_FALSE(renderer->runPass(now));
      }
    }
    for (int run = 0; run <= pass && !renderer->done(); ++run) ASSERT_TRUE(renderer->runPass(never));
  }
  finish(*renderer);
  EXPECT_EQ(difference(undisturbed.film, renderer->film()), "");
}

// Asked for in the middle of the work; 50 ms is what the session promises on an idle machine.
TEST_P(Passes, StopSoon) {
  Parameters costly = parameters();
  costly.transport.lightSamples = 1024;
  costly.picture.filmSamples = 16;
  costly.picture.naiveSamples = 512;
  const Stage stage(scene(128));
  const std::unique_ptr<Renderer> renderer = makeRenderer(stage.context(costly));
  for (const int milliseconds : {3, 30, 100}) {
    StopFlag stop = false;
    std::chrono::steady_clock::time_point asked;
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      asked = std::chrono::steady_clock::now();
      stop = true;
    });
    while (!stop && !renderer->done()) renderer->runPass(stop);
    const auto ended = std::chrono::steady_clock::now();
    stopper.join();
    const double late = std::chrono::duration<double>(ended - asked).count();
    EXPECT_LT(late, budget(1, 10) * 0.5)
        << "asked after " << milliseconds << " ms, " << renderer->progress().stage;
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, Passes, testing::ValuesIn(kWays),
                         [](const testing::TestParamInfo<Way>& way) { return std::string(way.param.name); });

// ---- vectors ----

class VectorPasses : public Passes {
 protected:
  static Parameters parameters(int firstStride = 16) {
    Parameters parameters = Passes::parameters();
    parameters.picture.firstStride = firstStride;
    return parameters;
  }
};

// After the first pass that looks at light, no pixel is dark where the finished picture has light.
TEST_P(VectorPasses, LeaveNoHoles) {
  const Stage stage(scene());
  const StopFlag never = false;
  for (const int firstStride : {16, 12, 7}) {
    const Film finished = picture(stage, parameters(firstStride)).film;
    const std::unique_ptr<Renderer> renderer = makeRenderer(stage.context(parameters(firstStride)));
    ASSERT_TRUE(renderer->runPass(never));  // visible points, without light
    while (!renderer->done()) {
      ASSERT_TRUE(renderer->runPass(never));
      const Film film = renderer->film();
      int holes = 0;
      for (std::size_t i = 0; i < film.depth().size(); ++i) {
        holes += !isBlack(finished.beauty(i)) && isBlack(film.beauty(i));
        holes += !isBlack(finished.indirect[i]) && isBlack(film.indirect[i]);
      }
      EXPECT_EQ(holes, 0) << renderer->progress().stage << " of first stride " << firstStride;
    }
  }
}

const auto kVectorWays = testing::Values(kWays[0], kWays[1], kWays[2]);
INSTANTIATE_TEST_SUITE_P(Ways, VectorPasses, kVectorWays,
                         [](const testing::TestParamInfo<Way>& way) { return std::string(way.param.name); });

// ---- caches that are there already ----

class WarmCache : public Passes {};

TEST_P(WarmCache, OfTheSameViewComputesNothing) {
  const Stage stage(scene());
  const Picture first = picture(stage, parameters());
  const Picture second = picture(stage, parameters(), {.warm = first.snapshot});
  EXPECT_EQ(second.statistics.fullIndirect, 0u)
      << "beside the " << first.statistics.ilvRecords << " there are";
  EXPECT_EQ(second.statistics.ilvRecords, first.statistics.ilvRecords);
  // The dispersion test is not monotone: with more neighbours a point may find them too different, and adds
  // its own.
  EXPECT_LE(second.statistics.dlvRecords, first.statistics.dlvRecords + first.statistics.dlvRecords / 50);
  EXPECT_EQ(second.statistics.unanswered, 0u);
}

TEST_P(WarmCache, OfAMovedCameraComputesLess) {
  const Stage stage(scene());
  const Picture first = picture(stage, parameters());
  SceneDescription moved = scene();
  moved.cameras.front().position += Vec3d(0.03, 0.02, 0.05);
  const Stage other(moved);
  const Picture cold = picture(other, parameters());
  const Picture warm = picture(other, parameters(), {.warm = first.snapshot});
  EXPECT_LT(warm.statistics.fullIndirect, cold.statistics.fullIndirect / 2);
  // The paper's radii, whole mean distances, reach everything that the moved camera sees.
  if (parameters().vectors.rules != Rules::Paper) {
    EXPECT_GT(warm.statistics.fullIndirect, 0u);
  }
  EXPECT_EQ(badPixel(warm.film), "");
}

TEST_P(WarmCache, LockedComputesNothingAndCountsWhatItCannotAnswer) {
  const Stage stage(scene());
  const Picture first = picture(stage, parameters());
  const Picture locked = picture(stage, parameters(), {.warm = first.snapshot, .locked = true});
  EXPECT_EQ(locked.statistics.fullIndirect, 0u);
  EXPECT_EQ(locked.statistics.ilvRecords, first.statistics.ilvRecords);
  EXPECT_EQ(locked.statistics.dlvRecords, first.statistics.dlvRecords);
  EXPECT_EQ(locked.statistics.rays.gather, 0u);
  EXPECT_EQ(locked.statistics.unanswered, 0u);
  EXPECT_EQ(badPixel(locked.film), "");

  auto nothing = std::make_shared<Snapshot>();
  nothing->direct.resize(stage.scene->lights.size());
  const Picture empty = picture(stage, parameters(), {.warm = nothing, .locked = true});
  EXPECT_EQ(empty.statistics.ilvRecords, 0u);
  EXPECT_GT(empty.statistics.unanswered, 1000u);
  EXPECT_EQ(badPixel(empty.film), "");
}

INSTANTIATE_TEST_SUITE_P(Ways, WarmCache, kVectorWays,
                         [](const testing::TestParamInfo<Way>& way) { return std::string(way.param.name); });

// In the final picture every answer is from vectors that a reader of the snapshot finds there.
TEST(CacheInput, LockedShowsWhatTheFinishedPictureShowed) {
  const Stage stage(shippedScene("cornell-mirror.toml", 100, 100));
  for (const char* mode : {"never", "always"}) {
    const Parameters parameters = parametersWith({{"preset", "draft"}, {"dlv.mode", mode}});
    const Picture first = picture(stage, parameters);
    const Picture locked = picture(stage, parameters, {.warm = first.snapshot, .locked = true});
    EXPECT_EQ(locked.film.direct, first.film.direct) << mode;
    EXPECT_EQ(locked.film.indirect, first.film.indirect) << mode;
    EXPECT_EQ(locked.film.specular, first.film.specular) << mode;
  }
}

// What a warm cache answered at once is answered again where new vectors reach, and only there.
class WarmPicture : public testing::TestWithParam<const char*> {};

TEST_P(WarmPicture, IsOfAllItsVectors) {
  const Parameters parameters = parametersWith({{"preset", "draft"}, {"dlv.mode", GetParam()}});
  for (const char* scene : {"cornell-mirror.toml", "cornell-glossy.toml"}) {
    SceneDescription description = shippedScene(scene, 100, 100);
    const Picture first = picture(Stage(description), parameters);
    description.cameras.front().position += Vec3d(0.03, 0.02, 0.05);
    const Stage moved(description);
    const Picture warm = picture(moved, parameters, {.warm = first.snapshot});
    EXPECT_GT(warm.statistics.fullIndirect, 0u) << scene;
    const Picture again = picture(moved, parameters, {.warm = warm.snapshot, .locked = true});
    EXPECT_EQ(again.film.direct, warm.film.direct) << scene;
    EXPECT_EQ(again.film.indirect, warm.film.indirect) << scene;
    EXPECT_EQ(again.film.specular, warm.film.specular) << scene;
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, WarmPicture, testing::Values("never", "always"),
                         [](const auto& mode) { return std::string(mode.param); });

}  // namespace
}  // namespace lightvane::render_test
