// The session: latest wish wins, nothing true is computed twice, and every picture can be made again.

#include "core/render/session.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/render/memory.h"
#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

using namespace std::chrono_literals;

/// A session, and a wait for what it publishes.
class Watched {
 public:
  /// The complete frame of this request; null where there is none within a minute.
  std::shared_ptr<const RenderFrame> complete(std::uint64_t request) {
    return waitFor([&](const RenderFrame& frame) { return frame.request == request && frame.complete; });
  }
  std::shared_ptr<const RenderFrame> first(std::uint64_t request) {
    return waitFor([&](const RenderFrame& frame) { return frame.request == request; });
  }
  /// Whether within a minute the work ends with a reason why it is not complete.
  bool endsEarly() {
    std::unique_lock lock(mutex_);
    return published_.wait_for(lock, 60s, [&] {
      const SessionStatus status = session.status();
      return !status.working && !(status.error + status.stopped).empty();
    });
  }
  template <class Wanted>
  std::shared_ptr<const RenderFrame> waitFor(const Wanted& wanted) {
    std::unique_lock lock(mutex_);
    std::shared_ptr<const RenderFrame> found;
    published_.wait_for(lock, 60s, [&] {
      const auto frame = session.frame();
      if (frame && wanted(*frame)) found = frame;
      return found != nullptr;
    });
    return found;
  }

 private:
  std::mutex mutex_;
  std::condition_variable published_;

 public:
  Session session{[this] {
    const std::lock_guard lock(mutex_);
    published_.notify_all();
  }};
};

SessionRequest requestFor(const Stage& stage, const Parameters& parameters) {
  SessionRequest request;
  request.scene = stage.scene;
  request.tracer = stage.tracer;
  request.camera = stage.camera;
  request.parameters = parameters;
  request.threads = 2;
  return request;
}

/// The frame's picture made once more, by a renderer of its own.
Film again(const RenderFrame& frame) {
  const RenderContext context{frame.scene,  frame.tracer,     frame.camera,
                              frame.region, frame.parameters, std::make_shared<TaskPool>(1),
                              frame.lights};
  const std::unique_ptr<Renderer> renderer = makeRenderer(context, {frame.warm, frame.locked});
  finish(*renderer);
  return renderer->film();
}

/// Bit by bit. What was computed for it may differ: the one knew what the other found.
bool haveTheSameLight(const Film& a, const Film& b) {
  return std::ranges::equal(a.direct, b.direct) && std::ranges::equal(a.indirect, b.indirect) &&
         std::ranges::equal(a.specular, b.specular);
}

Camera stepAside(Camera camera, float amount) {
  camera.position += amount * camera.right;
  return camera;
}

TEST(Session, EndsWithTheRenderersOwnPicture) {
  const Stage stage(shippedScene("cornell-mirror.toml", 40, 40));
  for (const char* method : {"vectors", "path", "direct", "naive"}) {
    const Parameters parameters =
        parametersWith({{"method.name", method}, {"path.samples", "5"}, {"naive.samples", "8"}});
    Watched watched;
    const auto frame = watched.complete(watched.session.request(requestFor(stage, parameters)));
    ASSERT_TRUE(frame) << method;
    EXPECT_EQ(difference(*frame->film, picture(stage, parameters).film), "") << method;
    EXPECT_EQ(frame->reduction, 1);
  }
}

TEST(Session, LargePicturesAreFirstShownCoarse) {
  const Stage stage(shippedScene("cornell.toml", 300, 200));
  Watched watched;
  const std::uint64_t request = watched.session.request(requestFor(stage, {}));
  const auto frame = watched.first(request);
  ASSERT_TRUE(frame);
  EXPECT_GT(frame->reduction, 1);
  EXPECT_FALSE(frame->complete);
  EXPECT_EQ(frame->film->width, (300 + frame->reduction - 1) / frame->reduction);
  EXPECT_GT(mean(frame->film->direct), 0.0);
}

TEST(Session, AThresholdIsAnsweredFromTheVectorsThatExist) {
  const Stage stage(shippedScene("cornell.toml", 64, 64));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  const auto before = watched.complete(watched.session.request(request));
  ASSERT_TRUE(before);
  setParameters(request.parameters, {{"ilv.n_min", "1"}, {"ilv.n_max", "8"}});
  const auto after = watched.complete(watched.session.request(request));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->statistics.fullIndirect, 0U) << "vectors computed for a loosened threshold";
  EXPECT_EQ(after->snapshot->indirect.size(), before->snapshot->indirect.size());
  EXPECT_EQ(after->points, before->points) << "the same points";
  EXPECT_EQ(after->statistics.rays.camera + after->statistics.rays.shadow, 0U);
  EXPECT_EQ(difference(*after->film, again(*after)), "");
}

TEST(Session, WiderRadiiReachPointsThatTheirTreesDidNot) {
  const Stage stage(shippedScene("cornell.toml", 64, 64));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  ASSERT_TRUE(watched.complete(watched.session.request(request)));
  setParameters(request.parameters, {{"ilv.radius_scale", "1.2"}, {"ilv.radius_max", "0"}});
  const auto after = watched.complete(watched.session.request(request));
  ASSERT_TRUE(after);
  EXPECT_EQ(difference(*after->film, again(*after)), "");
  std::uint64_t used = 0;
  for (std::size_t i = 0; i < after->film->ilvCount.size(); ++i)
    used += static_cast<std::uint64_t>(after->film->ilvCount[i]);
  EXPECT_GT(used, 4U * after->film->ilvCount.size());
}

TEST(Session, AMovedCameraKeepsTheVectors) {
  const Stage stage(shippedScene("cornell.toml", 64, 64));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  const auto before = watched.complete(watched.session.request(request));
  request.camera = stepAside(request.camera, 0.02f);
  const auto after = watched.complete(watched.session.request(request));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->warm, before->snapshot);
  EXPECT_LT(after->statistics.fullIndirect, before->statistics.fullIndirect / 2);
  EXPECT_EQ(difference(*after->film, again(*after)), "");
}

TEST(Session, ARestartIsAsIfItWereTheFirst) {
  const Stage stage(shippedScene("cornell-glossy.toml", 48, 48));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  const auto first = watched.complete(watched.session.request(request));
  request.camera = stepAside(request.camera, 0.05f);
  ASSERT_TRUE(watched.complete(watched.session.request(request)));
  request.camera = stage.camera;
  ++request.restarts;
  const auto last = watched.complete(watched.session.request(request));
  ASSERT_TRUE(first && last);
  EXPECT_FALSE(last->warm);
  EXPECT_EQ(difference(*first->film, *last->film), "");
}

/// A stage with direct vectors, and a session that has its picture complete.
class DirectVectorsSession : public testing::Test {
 protected:
  const Stage stage{shippedScene("cornell-mirror.toml", 96, 96)};
  Watched watched;
  SessionRequest request = requestFor(stage, parametersWith({{"dlv.mode", "always"}, {"passes.thin", "2"}}));
  std::shared_ptr<const RenderFrame> before = ask();

  std::shared_ptr<const RenderFrame> ask() {
    auto frame = watched.complete(watched.session.request(request));
    if (!frame) throw std::runtime_error("no picture within a minute");
    return frame;
  }
  std::shared_ptr<const RenderFrame> askWith(const Settings& changes) {
    setParameters(request.parameters, changes);
    return ask();
  }
};

TEST_F(DirectVectorsSession, AThresholdOfIndirectVectorsAsksForNoDirectOnes) {
  const auto loosened = askWith({{"ilv.n_min", "1"}});
  EXPECT_EQ(loosened->statistics.fullDirect, 0U);
  EXPECT_EQ(loosened->snapshot->directCount(), before->snapshot->directCount());
  EXPECT_EQ(difference(*loosened->film, again(*loosened)), "");
  const auto undone = askWith({{"ilv.n_min", "4"}});
  EXPECT_EQ(undone->statistics.fullDirect, 0U);
  EXPECT_TRUE(haveTheSameLight(*undone->film, *before->film)) << "undone, and not as it was";
  EXPECT_EQ(difference(*undone->film, again(*undone)), "");
}

// Answers that are kept from before do not count in a pass that looked at few points.
TEST_F(DirectVectorsSession, TheHitRateIsAPartInEveryPass) {
  setParameters(request.parameters, {{"ilv.rows", "10"}});
  const std::uint64_t number = watched.session.request(request);
  double least = 1e9, most = 0.0;
  int passes = 0;
  for (SessionStatus status; status.working || status.request < number;) {
    status = watched.session.status();
    if (status.request != number || status.statistics.passes == passes) continue;
    passes = status.statistics.passes;
    least = std::min(least, status.progress.hitRate);
    most = std::max(most, status.progress.hitRate);
  }
  EXPECT_GE(least, 0.0);
  EXPECT_GT(most, 0.0);
  EXPECT_LE(most, 1.0);
}

TEST_F(DirectVectorsSession, ARenderingFromTheVectorsOfItsOwnViewAddsNone) {
  SessionRequest other = request;
  other.cache = before->snapshot;
  Watched fresh;
  const auto after = fresh.complete(fresh.session.request(other));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->snapshot->directCount(), before->snapshot->directCount());
  EXPECT_TRUE(haveTheSameLight(*after->film, *before->film));
}

TEST_F(DirectVectorsSession, OtherRulesOrAnotherViewAskAgain) {
  const auto stricter = askWith({{"dlv.dispersion", "0.05"}});
  EXPECT_GT(stricter->statistics.fullDirect, 0U);
  EXPECT_EQ(difference(*stricter->film, again(*stricter)), "");
  request.camera = stepAside(request.camera, 0.05f);
  const auto moved = ask();
  EXPECT_GT(moved->snapshot->directCount(), stricter->snapshot->directCount());
  EXPECT_EQ(difference(*moved->film, again(*moved)), "");
}

TEST_F(DirectVectorsSession, AnswersOfRulesThatWereNotKeptAreForgotten) {
  // Broken off after its first frame: some points were answered by rules that are undone.
  setParameters(request.parameters, {{"dlv.dispersion", "0.5"}});
  ASSERT_TRUE(watched.first(watched.session.request(request)));
  const auto undone = askWith({{"dlv.dispersion", "0.1"}});
  EXPECT_EQ(difference(*undone->film, again(*undone)), "");
}

TEST_F(DirectVectorsSession, VectorsGrowNoDenserThanMissesAreThinned) {
  for (int step = 0; step < 4; ++step) {
    request.camera = stepAside(request.camera, step % 2 == 0 ? 0.004f : -0.003f);
    before = ask();
  }
  const auto thin = static_cast<float>(request.parameters.picture.thin);
  std::size_t held = 0;
  for (const RecordSet<DirectLightVector>& vectors : before->snapshot->direct) {
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      const DirectLightVector& a = vectors[i];
      if (a.birth.pass == 0) continue;  // of the seed, which lies where it falls
      for (std::size_t k = 0; k < i; ++k) {
        const VectorPoint& b = vectors[k].point;
        if (b.key != a.point.key || glm::dot(b.normal, a.point.normal) < 0.96f) continue;
        ASSERT_GE(glm::length(b.position - a.point.position), 0.999f * thin * a.point.footprint)
            << "vectors " << k << " and " << i << " of " << vectors.size();
        ++held;
      }
    }
  }
  EXPECT_GT(held, 10000U);
}

TEST(Session, OtherMethodsLeaveTheVectorsAlone) {
  const Stage stage(shippedScene("cornell.toml", 48, 48));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  const auto before = watched.complete(watched.session.request(request));
  setParameters(request.parameters, {{"method.name", "path"}, {"path.samples", "2"}});
  ASSERT_TRUE(watched.complete(watched.session.request(request)));
  setParameters(request.parameters, {{"method.name", "vectors"}});
  const auto after = watched.complete(watched.session.request(request));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->statistics.fullIndirect, 0U);
  for (std::size_t i = 0; i < before->film->direct.size(); ++i)
    ASSERT_EQ(before->film->beauty(i), after->film->beauty(i)) << "pixel " << i;
}

TEST(Session, ALockedCacheGrowsNoMore) {
  const Stage stage(shippedScene("cornell.toml", 48, 48));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  const auto before = watched.complete(watched.session.request(request));
  request.locked = true;
  request.camera = stepAside(request.camera, 0.1f);
  const auto after = watched.complete(watched.session.request(request));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->snapshot->indirect.size(), before->snapshot->indirect.size());
  EXPECT_EQ(difference(*after->film, again(*after)), "");
}

// Two lamps: what one gives is a picture of its own.
const char* const kTwoLamps = R"(version = 1
[camera]
position = [0.5, 0.5, 2.2]
target = [0.5, 0.5, 0.5]
resolution = [48, 48]
[material.white]
diffuse = [0.7, 0.7, 0.7]
[material.left]
emission = [4, 3, 2]
[material.right]
emission = [1, 2, 4]
[[shape]]
type = "box"
material = "white"
min = [0, 0, 0]
max = [1, 0.05, 1]
[[shape]]
type = "box"
material = "white"
min = [0, 0, 0]
max = [1, 1, 0.05]
[[shape]]
type = "sphere"
material = "left"
center = [0.2, 0.7, 0.4]
radius = 0.1
[[shape]]
type = "sphere"
material = "right"
center = [0.8, 0.7, 0.4]
radius = 0.1
)";

TEST(Session, LightsAreDimmedWithoutANewRay) {
  const Stage stage(sceneFromText(kTwoLamps));
  for (const char* mode : {"never", "always"}) {
    Watched watched;
    SessionRequest request = requestFor(stage, parametersWith({{"dlv.mode", mode}}));
    const auto before = watched.complete(watched.session.request(request));
    request.lights.direct = {Rgb(0.0f), Rgb(2.0f, 1.0f, 0.5f)};
    const auto after = watched.complete(watched.session.request(request));
    ASSERT_TRUE(before && after);
    EXPECT_EQ(after->statistics.rays.gather, 0U) << mode;
    // Points that no DLV serves are sampled by each last pass.
    if (std::string_view(mode) == "never") {
      EXPECT_EQ(after->statistics.rays.shadow, 0U);
    }
    EXPECT_EQ(difference(*after->film, again(*after)), "") << mode;
    for (std::size_t i = 0; i < after->film->direct.size(); ++i)
      ASSERT_EQ(after->film->indirect[i], before->film->indirect[i]) << "indirect light lags behind";
    EXPECT_LT(mean(after->film->emission), mean(before->film->emission));
    // The lamps' own pixels apart: exact light is linear.
    RenderContext context = stage.context(request.parameters);
    context.tracer = relitTracer(stage.tracer, request.lights.direct);
    context.scene = context.tracer->sharedScene();
    const std::unique_ptr<Renderer> other = makeRenderer(context);
    finish(*other);
    const Film film = other->film();
    for (std::size_t i = 0; i < film.direct.size(); ++i) {
      EXPECT_EQ(film.emission[i], after->film->emission[i]);
      if (std::string_view(mode) == "always") continue;  // where vectors agree depends on how bright they are
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(film.direct[i][c], after->film->direct[i][c], 1e-5f * film.direct[i][c] + 1e-8f);
    }
  }
}

TEST(Session, SampledDirectLightIsNotSampledAgain) {
  const Stage stage(shippedScene("cornell-mirror.toml", 96, 96));
  Watched watched;
  SessionRequest request = requestFor(stage, parametersWith({{"dlv.mode", "always"}}));
  const auto before = watched.complete(watched.session.request(request));
  request.parameters.vectors.ilv.nMin += 1;
  const auto after = watched.complete(watched.session.request(request));
  ASSERT_TRUE(before && after);
  // Points where vectors are too unlike find so again, and a few more do.
  EXPECT_GT(before->statistics.fullDirect, 4000U);
  EXPECT_LT(after->statistics.fullDirect, before->statistics.fullDirect / 2);
  EXPECT_EQ(difference(*after->film, again(*after)), "");
}

TEST(Session, RefreshedIndirectLightIsThatOfTheNewLamps) {
  const Stage stage(sceneFromText(kTwoLamps));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  ASSERT_TRUE(watched.complete(watched.session.request(request)));
  request.lights.direct = request.lights.indirect = {Rgb(0.0f), Rgb(1.0f)};
  const auto refreshed = watched.complete(watched.session.request(request));
  ASSERT_TRUE(refreshed);
  RenderContext context = stage.context(request.parameters);
  context.tracer = relitTracer(stage.tracer, request.lights.direct);
  context.scene = context.tracer->sharedScene();
  const std::unique_ptr<Renderer> other = makeRenderer(context);
  finish(*other);
  EXPECT_EQ(difference(*refreshed->film, other->film()), "");
}

/// The frame's first ILVs, pinned.
std::shared_ptr<const PinnedVectors> pinFirst(const RenderFrame& frame, std::size_t count) {
  PinnedVectors pinned;
  pinned.scene = frame.scene;
  pinned.vectors.direct.resize(frame.scene->lights.size());
  std::vector<IndirectLightVector> records;
  for (std::size_t i = 0; i < count; ++i) records.push_back(frame.snapshot->indirect[i]);
  pinned.vectors.indirect = RecordSet<IndirectLightVector>().with(
      std::move(records), VectorRadii(frame.parameters.vectors, *frame.scene));
  return std::make_shared<const PinnedVectors>(std::move(pinned));
}

std::size_t countOf(const RecordSet<IndirectLightVector>& set, const RandomKey& identity) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.size(); ++i) count += set[i].birth.identity == identity ? 1 : 0;
  return count;
}

TEST(Session, PinnedVectorsSurviveWhatMakesThemStaleAndRestarts) {
  const Stage stage(shippedScene("cornell.toml", 48, 48));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  const auto first = watched.complete(watched.session.request(request));
  ASSERT_TRUE(first);
  request.pinned = pinFirst(*first, 3);
  const auto pinnedAlone = watched.complete(watched.session.request(request));
  ASSERT_TRUE(pinnedAlone);
  EXPECT_EQ(pinnedAlone->snapshot, first->snapshot) << "pinning what is there computes nothing";
  const auto expectPinned = [&](const std::shared_ptr<const RenderFrame>& frame, std::size_t count) {
    ASSERT_TRUE(frame);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(countOf(frame->snapshot->indirect, first->snapshot->indirect[i].birth.identity), count) << i;
    }
    EXPECT_EQ(difference(*frame->film, again(*frame)), "");
  };
  // A threshold keeps all vectors: the pinned ones are among them, once.
  setParameters(request.parameters, {{"ilv.n_min", "3"}});
  expectPinned(watched.complete(watched.session.request(request)), 1);
  setParameters(request.parameters, {{"ilv.n_min", "4"}, {"seed", "2"}});
  const auto stale = watched.complete(watched.session.request(request));
  expectPinned(stale, 1);
  EXPECT_EQ(countOf(stale->snapshot->indirect, first->snapshot->indirect[5].birth.identity), 0U);
  ++request.restarts;
  const auto restarted = watched.complete(watched.session.request(request));
  expectPinned(restarted, 1);
  EXPECT_EQ(restarted->warm->indirect.size(), 3U) << "nothing else is left";
  request.pinned = nullptr;
  ++request.restarts;
  expectPinned(watched.complete(watched.session.request(request)), 0);
}

TEST(Session, PausedItShowsWhatIsKnownAndGoesOnLater) {
  const Stage stage(shippedScene("cornell.toml", 300, 300));
  Watched watched;
  SessionRequest request = requestFor(stage, parametersWith({{"preset", "draft"}}));
  request.paused = true;
  const std::uint64_t number = watched.session.request(request);
  ASSERT_TRUE(watched.first(number));
  std::this_thread::sleep_for(100ms);
  EXPECT_FALSE(watched.session.frame()->complete);
  EXPECT_FALSE(watched.session.status().working);
  request.paused = false;
  const auto frame = watched.complete(watched.session.request(request));
  ASSERT_TRUE(frame);
  EXPECT_EQ(difference(*frame->film, picture(stage, request.parameters).film), "");
}

// A request that changes nothing shows what there is again, but not another picture as if it were its own.
TEST(Session, AnOlderPictureIsNotShownForANewRequest) {
  const Stage stage(shippedScene("cornell.toml", 32, 32));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  const std::uint64_t first = watched.session.request(request);
  ASSERT_TRUE(watched.complete(first));
  request.camera = stepAside(stage.camera, 0.1f);
  request.paused = true;
  const auto settle = [&] {
    for (int i = 0; i < 1000 && (watched.session.status().working || i < 10); ++i)
      std::this_thread::sleep_for(5ms);
  };
  watched.session.request(request);  // so small a picture has no coarse one to show at once
  settle();
  request.camera.exposureStops = 1.0;
  const std::uint64_t second = watched.session.request(request);
  settle();
  EXPECT_EQ(watched.session.frame()->request, first);
  request.paused = false;
  const auto frame = watched.complete(watched.session.request(request));
  ASSERT_TRUE(frame);
  EXPECT_GT(frame->request, second);
  EXPECT_EQ(frame->camera.position, request.camera.position);
}

// Requests faster than any pass: work that was broken off is not lost, and what comes out in the end can be
// made again from the vectors that it began with.
TEST(Session, InterruptedWorkIsKept) {
  const Stage stage(shippedScene("cornell-mirror.toml", 96, 96));
  Watched watched;
  SessionRequest request = requestFor(stage, parametersWith({{"dlv.mode", "always"}, {"dlv.seed", "50"}}));
  const RandomKey key = randomKey(7);
  for (std::uint32_t i = 0; i < 40; ++i) {
    request.camera = stepAside(stage.camera, 0.1f * uniform(key, i, 0));
    const int nMin = 1 + static_cast<int>(5.0f * uniform(key, i, 1));
    setParameters(request.parameters, {{"ilv.n_min", std::to_string(nMin)}});
    if (i % 11 == 10) ++request.restarts;
    if (i % 7 == 6) request.paused = !request.paused;
    watched.session.request(request);
    std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(30.0f * uniform(key, i, 2))));
  }
  request.paused = false;
  const std::uint64_t number = watched.session.request(request);
  // However slow the machine is, some vectors are finished before the last request.
  ASSERT_TRUE(watched.waitFor([&](const RenderFrame& shown) {
    return shown.request == number && shown.snapshot && shown.snapshot->indirect.size() > 0;
  }));
  request.camera = stage.camera;
  const auto frame = watched.complete(watched.session.request(request));
  ASSERT_TRUE(frame);
  ASSERT_TRUE(frame->warm);
  EXPECT_GT(frame->warm->indirect.size(), 0U);
  EXPECT_EQ(difference(*frame->film, again(*frame)), "");
}

TEST(Session, APictureBeyondTheMemoryLimitIsRefused) {
  const Stage stage(shippedScene("cornell.toml", 64, 64));
  Watched watched;
  SessionRequest request = requestFor(stage, {});
  request.memoryLimitBytes = 100'000'000;
  const auto first = watched.complete(watched.session.request(request));
  ASSERT_TRUE(first);
  request.camera.width = request.camera.height = 60'000;
  watched.session.request(request);
  ASSERT_TRUE(watched.endsEarly());
  const std::string error = watched.session.status().error;
  EXPECT_NE(error.find("60000 x 60000 pixels takes about"), std::string::npos) << error;
  EXPECT_NE(error.find("the limit is 100 MB: make it smaller"), std::string::npos) << error;
  EXPECT_EQ(watched.session.frame()->film, first->film) << "the picture from before stays";
  request.camera = stage.camera;
  const auto back = watched.complete(watched.session.request(request));
  ASSERT_TRUE(back);
  EXPECT_EQ(watched.session.status().error, "");
  EXPECT_EQ(back->statistics.fullIndirect, 0U) << "the vectors were kept";
}

TEST(Session, VectorsBeyondTheMemoryLimitEndTheRenderingAtTheLastWholePass) {
  const Stage stage(shippedScene("cornell.toml", 64, 64));
  SessionRequest request = requestFor(stage, {});
  const Picture whole = picture(stage, {});
  // The picture itself, and half of its vectors.
  const PictureMemory memory = pictureMemory(*stage.scene, {});
  request.memoryLimitBytes =
      std::size_t{64 * 64} * (memory.perPixel + memory.perPoint) + vectorBytes(*whole.snapshot) / 2;
  std::shared_ptr<const RenderFrame> frames[2];
  for (auto& frame : frames) {
    Watched watched;
    const std::uint64_t number = watched.session.request(request);
    ASSERT_TRUE(watched.endsEarly());
    frame = watched.session.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->request, number);
    EXPECT_FALSE(frame->complete);
    EXPECT_EQ(watched.session.status().error, "");
    EXPECT_NE(watched.session.status().stopped.find("the memory limit of"), std::string::npos);
    EXPECT_LE(frame->snapshot->indirect.size(), whole.snapshot->indirect.size() / 2);
    EXPECT_GT(frame->snapshot->indirect.size(), 0U);
    // A larger limit lets it go on.
    SessionRequest more = request;
    more.memoryLimitBytes *= 2;
    const auto complete = watched.complete(watched.session.request(more));
    ASSERT_TRUE(complete);
    EXPECT_EQ(watched.session.status().stopped, "");
  }
  EXPECT_EQ(frames[0]->statistics.passes, frames[1]->statistics.passes);
  EXPECT_EQ(difference(*frames[0]->film, *frames[1]->film), "");
}

TEST(Session, FramesOutliveTheSession) {
  std::shared_ptr<const RenderFrame> frame;
  const Stage stage(shippedScene("cornell.toml", 32, 32));
  {
    Watched watched;
    frame = watched.complete(watched.session.request(requestFor(stage, {})));
    ASSERT_TRUE(frame);
    EXPECT_EQ(watched.session.status().error, "");
  }
  EXPECT_GT(mean(frame->film->direct), 0.0);
}

TEST(Session, EndsSoonWhileItWorks) {
  const Stage stage(shippedScene("cornell.toml", 512, 512));
  auto watched = std::make_unique<Watched>();
  watched->session.request(requestFor(stage, parametersWith({{"preset", "fine"}})));
  std::this_thread::sleep_for(100ms);
  const auto start = std::chrono::steady_clock::now();
  watched.reset();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  // 50 ms are promised on an idle machine; tests share theirs.
  EXPECT_LT(took.count(), isFast() ? 1.0 : 10.0);
}

}  // namespace
}  // namespace lightvane::render_test
