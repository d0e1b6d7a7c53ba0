// `lightvane render` as a user runs it: what it writes, and what it says where it cannot.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/settings.h"
#include "app/version.h"
#include "core/image/image_file.h"
#include "core/inspect/view_image.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// A small and quick rendering of the Cornell box to `output`, and more words.
Words quick(const std::string& output, const Words& more = {}) {
  Words words = {"render", shippedScene("cornell"), "-o", output, "--size", "24x20", "--preset", "draft"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words path(const std::string& output, const Words& more = {}) {
  Words words = {
      "render", shippedScene("cornell"), "-o", output, "--size", "16x12", "--method", "path", "--spp", "8"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class Render : public testing::Test {
 protected:
  void expectSuccess(const Words& words) {
    const Outcome outcome = program_.run(words);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "") << "stdout is for what was asked for";
  }
  /// One message, exit code 2, and no file left behind.
  void expectRefusal(const Words& words, const testing::Matcher<std::string>& message) {
    const std::vector<std::string> before = program_.files();
    const Outcome outcome = program_.run(words);
    EXPECT_EQ(outcome.exitCode, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, testing::StartsWith("lightvane: error: "));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, message);
    EXPECT_EQ(program_.files(), before);
  }
  LayeredImage image(const std::string& name) const {
    auto read = readImage(program_.path(name));
    if (!read) ADD_FAILURE() << read.error().message();
    return read.value_or(LayeredImage{});
  }

  Program program_;
};

TEST_F(Render, WritesEveryFormatAndNothingElse) {
  expectSuccess(quick("a.exr", {"-o", "b.png", "c.hdr", "d.pfm"}));
  EXPECT_THAT(program_.files(), ElementsAre("a.exr", "b.png", "c.hdr", "d.pfm"));
  for (const char* name : {"a.exr", "b.png", "c.hdr", "d.pfm"}) {
    const LayeredImage picture = image(name);
    EXPECT_EQ(picture.width, 24) << name;
    EXPECT_EQ(picture.height, 20) << name;
    float brightest = 0.0f;
    for (const Rgb& pixel : picture.rgb()) brightest = std::max(brightest, pixel.r);
    EXPECT_GT(brightest, 0.1f) << name;
  }
}

TEST_F(Render, LayersAddUpToThePicture) {
  for (const char* method : {"vectors", "path", "naive", "direct"}) {
    expectSuccess({"render", shippedScene("cornell-mirror"), "-o", "a.exr", "--size", "16x16", "--method",
                   method, "--set", "path.samples=2", "--set", "naive.samples=4", "--set", "ilv.rows=4"});
    const LayeredImage picture = image("a.exr");
    const ImageRgb beauty = picture.rgb();
    const ImageRgb layers[] = {picture.rgb("emission"), picture.rgb("direct"), picture.rgb("indirect"),
                               picture.rgb("specular")};
    for (std::size_t i = 0; i < beauty.size(); ++i) {
      // In this order to the bit: so the file says it (core/render/film.cpp).
      ASSERT_EQ(((layers[0][i] + layers[1][i]) + layers[2][i]) + layers[3][i], beauty[i])
          << method << " pixel " << i;
    }
  }
}

TEST_F(Render, ThreadsChangeNoByte) {
  expectSuccess(quick("one.exr", {"--threads", "1"}));
  expectSuccess(quick("three.exr", {"--threads", "3"}));
  EXPECT_EQ(program_.read("one.exr"), program_.read("three.exr"));
}

TEST_F(Render, SeedAndParametersChangeThePicture) {
  expectSuccess(path("a.exr"));
  for (const Words& more : {Words{"--seed", "2"}, Words{"--set", "light.bounce_samples=2"}}) {
    expectSuccess(path("b.exr", more));
    EXPECT_NE(image("a.exr").rgb(), image("b.exr").rgb()) << more.front();
  }
}

TEST_F(Render, CropIsThatPartOfTheWholePicture) {
  expectSuccess(path("whole.exr"));
  expectSuccess(path("part.exr", {"--crop", "5,3,7,6"}));
  const LayeredImage whole = image("whole.exr");
  const LayeredImage part = image("part.exr");
  ASSERT_EQ(part.width, 7);
  ASSERT_EQ(part.height, 6);
  for (const char* layer : {"", "direct", "indirect"}) {
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        ASSERT_EQ(part.rgb(layer).at(x, y), whole.rgb(layer).at(x + 5, y + 3))
            << layer << " " << x << "," << y;
      }
    }
  }
}

TEST_F(Render, ScenesSettingsActBelowThoseOfTheCommandLine) {
  program_.write("room.toml",
                 program_.read(shippedScene("cornell")) + "\n[render]\nseed = 7\npreset = \"draft\"\n");
  expectSuccess({"render", "room.toml", "-o", "a.exr", "--size", "8x8"});
  expectSuccess({"render", "room.toml", "-o", "b.exr", "--size", "8x8", "--seed", "3", "--preset", "fine",
                 "--set", "ilv.rows=4", "--set", "ilv.columns=8"});
  EXPECT_EQ(image("a.exr").metadata.at("seed"), "7");
  EXPECT_THAT(image("a.exr").metadata.at("parameters"), HasSubstr("ilv.rows=8"));
  EXPECT_EQ(image("b.exr").metadata.at("seed"), "3");
  EXPECT_THAT(image("b.exr").metadata.at("parameters"), HasSubstr("ilv.rows=4 ilv.columns=8"));
}

TEST_F(Render, ExposureBrightensThePng) {
  std::string scene = program_.read(shippedScene("cornell"));
  program_.write("dark.toml", scene);
  const std::string camera = "[camera]\n";
  scene.replace(scene.find(camera), camera.size(), camera + "exposure = 2.0\n");
  program_.write("bright.toml", scene);
  for (const char* name : {"dark", "bright"}) {
    const std::string file = name;
    expectSuccess({"render", file + ".toml", "-o", file + ".png", file + ".exr", "--size", "8x8", "--method",
                   "direct"});
  }
  EXPECT_EQ(image("dark.exr").rgb(), image("bright.exr").rgb());
  float dark = 0.0f;
  float bright = 0.0f;
  for (const Rgb& p : image("dark.png").rgb()) dark += p.r;
  for (const Rgb& p : image("bright.png").rgb()) bright += p.r;
  // Four times, where it does not clip: 2 is well between none and all.
  EXPECT_GT(bright, 2.0f * dark);
}

TEST_F(Render, EveryViewIsAPictureWhoseCommandMakesItAgain) {
  expectSuccess(quick("truth.exr", {"--method", "path"}));
  std::set<std::string> pictures;
  for (const PictureViewInfo& info : pictureViews()) {
    std::vector<std::string> look = {"--view", info.name, "--exposure=-0.5", "--tone-map", "filmic"};
    if (info.view == PictureView::Error)
      look.insert(look.end(), {"--reference", "truth.exr", "--range=-50,50", "--color-map", "grey"});
    expectSuccess(quick("view.png", look));
    const std::string command = image("view.png").metadata.at("command");
    EXPECT_THAT(command, HasSubstr("--exposure=-0.5 --tone-map=filmic"));
    const std::string shell = "cd '" + program_.folder().string() + "' && '" LIGHTVANE_PROGRAM "'" +
                              command.substr(std::string("lightvane").size()) + " --quiet";
    ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
    EXPECT_EQ(program_.read("picture.png"), program_.read("view.png")) << command;
    pictures.insert(program_.read("view.png"));
  }
  EXPECT_EQ(pictures.size(), pictureViews().size()) << "every view is another picture";
}

TEST_F(Render, ExplainsWhereTheErrorComesFrom) {
  const Outcome outcome = program_.run(
      quick("a.exr", {"--explain", "--explain-samples", "64", "--explain-stride", "2", "--stats", "a.json"}));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  for (const char* word : {"Noise", "Leaks", "Interpolation", "Single direction", "Missing bounces",
                           "together", "64 samples each"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
  const LayeredImage explained = image("a.exr");
  EXPECT_TRUE(explained.hasRgb("error.noise"));
  EXPECT_TRUE(explained.hasRgb("truth"));
  EXPECT_THAT(explained.metadata.at("command"),
              HasSubstr("--explain --explain-samples 64 --explain-stride 2"));
  const json sources = json::parse(program_.read("a.json")).at("error_sources");
  EXPECT_EQ(sources.at("samples"), 64);
  const double noise = sources.at("picture").at("noise").at("relative");
  EXPECT_GT(noise, 0.0);
  EXPECT_LT(noise, 1.0);
  // A view of it asks for it, too, and for one source another picture than for the largest.
  expectSuccess(quick("largest.png", {"--view", "error-sources", "--explain-samples", "32"}));
  expectSuccess(
      quick("noise.png", {"--view", "error-sources", "--source", "noise", "--explain-samples", "32"}));
  EXPECT_NE(program_.read("largest.png"), program_.read("noise.png"));
}

TEST_F(Render, ExplainsOnlyWhatVectorsMadeAndWhatIsComplete) {
  expectRefusal(quick("a.exr", {"--explain", "--method", "path"}),
                HasSubstr("--explain: only light vectors"));
  expectRefusal(quick("a.exr", {"--explain-stride", "2"}), HasSubstr("nothing is explained"));
  expectRefusal(quick("a.exr", {"--explain", "--explain-samples", "0"}), HasSubstr("--explain-samples"));
  expectRefusal(quick("a.png", {"--source", "noise"}), HasSubstr("only the view `error-sources` shows one"));
  expectRefusal(quick("a.png", {"--view", "error-sources", "--source", "nois"}),
                HasSubstr("did you mean noise?"));
  const Outcome early = program_.run(quick("a.exr", {"--explain", "--passes", "1"}));
  EXPECT_EQ(early.exitCode, 0);
  EXPECT_THAT(early.err, HasSubstr("the picture is not complete"));
  EXPECT_EQ(early.out, "");
  EXPECT_FALSE(image("a.exr").hasRgb("truth"));
}

TEST_F(Render, ViewsThatThereIsNothingOfAreRefused) {
  expectRefusal(quick("a.png", {"--view", "where-computed", "--method", "path"}),
                HasSubstr("tells of light vectors"));
  expectRefusal(quick("a.png", {"--view", "vectors-used", "--set", "method.rules=printed"}),
                HasSubstr("tells of light vectors"));
  expectSuccess(
      {"render", shippedScene("cornell"), "-o", "other.exr", "--size", "7x5", "--method", "direct"});
  expectRefusal(quick("a.png", {"--view", "error", "--reference", "other.exr"}), HasSubstr("has 7x5 pixels"));
  expectRefusal(quick("a.png", {"--view", "error", "--reference", "none.exr"}), HasSubstr("no such file"));
}

// ---- metadata

TEST_F(Render, MetadataCommandMakesTheSameFileAgain) {
  program_.write("my room.toml", program_.read(shippedScene("cornell-mirror")));
  const Words words = {"render",
                       "my room.toml",
                       "-o",
                       "a.exr",
                       "--size",
                       "24x24",
                       "--crop",
                       "2,3,12,14",
                       "--preset",
                       "draft",
                       "--spp",
                       "2",
                       "--seed",
                       "5",
                       "--set",
                       "dlv.r_max=0.08m",
                       "--passes",
                       "3",
                       "--from=-0.1,0.3,-0.9",
                       "--up=0.1,1,0",
                       "--light",
                       "light=0.5,0.25,1"};
  expectSuccess(words);
  const auto metadata = image("a.exr").metadata;
  const std::string command = metadata.at("command");
  EXPECT_EQ(metadata.at("lightvane_version"), versionText());
  EXPECT_EQ(metadata.at("scene"), "my room.toml");
  EXPECT_EQ(metadata.at("method"), "vectors");
  EXPECT_EQ(metadata.at("crop"), "2,3,12,14");
  EXPECT_EQ(metadata.at("passes"), "3");
  ASSERT_THAT(command, testing::StartsWith("lightvane render 'my room.toml' -o picture.exr "));
  EXPECT_THAT(command, testing::EndsWith("--passes 3"));
  const std::string shell = "cd '" + program_.folder().string() + "' && '" LIGHTVANE_PROGRAM "'" +
                            command.substr(std::string("lightvane").size()) + " --quiet";
  ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
  EXPECT_EQ(program_.read("picture.exr"), program_.read("a.exr"));
}

TEST_F(Render, CamerasCanStandElsewhere) {
  expectSuccess(quick("own.pfm"));
  expectSuccess(quick("elsewhere.pfm", {"--from=0.1,0.3,-1", "--fov-y=45"}));
  EXPECT_NE(program_.read("own.pfm"), program_.read("elsewhere.pfm"));
  expectSuccess(quick("elsewhere.exr", {"--from=0.1,0.3,-1", "--fov-y=45"}));
  const std::string command = image("elsewhere.exr").metadata.at("command");
  EXPECT_THAT(command, HasSubstr("--from=0.1,0.3,-1 --fov-y=45"));
}

TEST_F(Render, CamerasTakeALensOrAreOrthographic) {
  expectSuccess(quick("own.pfm"));
  const auto again = [&](const std::string& file) {
    const std::string command = image(file).metadata.at("command");
    const std::string shell = "cd '" + program_.folder().string() + "' && '" LIGHTVANE_PROGRAM "'" +
                              command.substr(std::string("lightvane").size()) + " --quiet";
    EXPECT_EQ(std::system(shell.c_str()), 0) << shell;
    EXPECT_EQ(program_.read("picture.exr"), program_.read(file)) << command;
    return command;
  };
  expectSuccess(quick("lens.exr", {"--lens-radius=0.05", "--focus-distance=0.9", "--set", "film.samples=2"}));
  EXPECT_THAT(again("lens.exr"), HasSubstr("--lens-radius=0.05 --focus-distance=0.9"));
  expectSuccess(quick("flat.exr", {"--orthographic=0.6"}));
  EXPECT_THAT(again("flat.exr"), HasSubstr("--orthographic=0.6"));
  EXPECT_NE(image("flat.exr").rgb(), image("own.pfm").rgb());
  expectRefusal(quick("no.exr", {"--focus-distance=0.9"}), HasSubstr("the camera has no lens"));
  expectRefusal(quick("no.exr", {"--orthographic=0.6", "--lens-radius=0.1"}),
                HasSubstr("an orthographic camera has no lens"));
}

TEST_F(Render, LightsAreLinear) {
  expectSuccess(path("whole.exr"));
  expectSuccess(path("half.exr", {"--light", "light=0.5"}));
  const ImageRgb whole = image("whole.exr").rgb();
  const ImageRgb half = image("half.exr").rgb();
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(half[i], 0.5f * whole[i]);
  EXPECT_EQ(image("half.exr").metadata.at("lights"), "light=0.5");
  EXPECT_THAT(image("half.exr").metadata.at("command"), HasSubstr("--light=light=0.5"));
}

// What the window shows of a light that was changed and not refreshed.
TEST_F(Render, ReflectedLightCanBeOfOtherLights) {
  expectSuccess(quick("whole.exr", {"--save-cache", "whole.lvcache"}));
  const std::vector<std::string> stale = {"--light=light=0.5", "--indirect-light=light=1", "--cache",
                                          "whole.lvcache"};
  expectSuccess(quick("stale.exr", stale));
  const LayeredImage whole = image("whole.exr");
  const LayeredImage picture = image("stale.exr");
  const ImageRgb before = whole.rgb("direct");
  const ImageRgb after = picture.rgb("direct");
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], 0.5f * before[i]);
  EXPECT_EQ(picture.rgb("indirect"), whole.rgb("indirect"));
  EXPECT_EQ(picture.metadata.at("indirect_lights"), "light=1");
  EXPECT_THAT(picture.metadata.at("command"), HasSubstr("--light=light=0.5 --indirect-light=light=1"));

  const Outcome refused =
      program_.run(quick("refused.exr", {"--light=light=0.5", "--cache", "whole.lvcache"}));
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_THAT(refused.err, HasSubstr("whole.lvcache: was computed with other settings of the lights"));
  const Outcome unknown = program_.run(quick("refused.exr", {"--indirect-light=lihgt=1"}));
  EXPECT_EQ(unknown.exitCode, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--indirect-light: the scene has no light 'lihgt'"));
}

TEST_F(Render, MetadataNamesNeitherOutputNorThreads) {
  expectSuccess(quick("a.exr", {"--threads", "1", "--stats", "a.json"}));
  expectSuccess(quick("other name.exr", {"-o", "b.png", "--threads", "2", "--time-limit", "1h"}));
  EXPECT_EQ(program_.read("a.exr"), program_.read("other name.exr"));
}

// ---- --target-error

TEST_F(Render, MeetsATargetOfError) {
  expectSuccess(quick("first.exr", {"--stats", "first.json", "--target-error", "100%"}));
  const json first = json::parse(program_.read("first.json"));
  const double before = first["estimated_error"];
  EXPECT_GT(before, 0.0);
  EXPECT_EQ(first["parameters"]["ilv.n_max"], 256) << "as many as there are";
  const std::string target = fmt::format("{}%", 100.0 * 0.7 * before);
  expectSuccess(quick("better.exr", {"--stats", "better.json", "--target-error", target, "--threads", "2"}));
  const json better = json::parse(program_.read("better.json"));
  EXPECT_LE(better["estimated_error"], 0.7 * before);
  EXPECT_GT(better["ilv_records"], first["ilv_records"]);
  EXPECT_EQ(better["stopped_early"], false);
  // The picture's own words make it again.
  const std::string command = image("better.exr").metadata.at("command");
  EXPECT_THAT(command, HasSubstr("--target-error"));
  const std::string shell = "cd '" + program_.folder().string() + "' && '" LIGHTVANE_PROGRAM "'" +
                            command.substr(std::string("lightvane").size()) + " --quiet --threads 1";
  ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
  EXPECT_EQ(program_.read("picture.exr"), program_.read("better.exr"));
}

TEST_F(Render, StopsShortOfATargetThatItCannotMeet) {
  // One vector a point is as good as it is, however many there are.
  const Outcome outcome = program_.run(quick("a.exr", {"--target-error", "0.01%", "--set", "ilv.n_max=1"}));
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("indirect light off by about"));
  EXPECT_THAT(outcome.err, HasSubstr("above the target of 0.01 %"));
}

TEST_F(Render, EndsWhereverATimeLimitMeetsATarget) {
  // Some of them while it looks how far off the vectors are.
  for (int tenths = 1; tenths <= 12; ++tenths) {
    const Outcome outcome =
        program_.run({"render", shippedScene("cornell"), "-o", "a.exr", "--size", "256x256", "--preset",
                      "draft", "--target-error", "0.1%", "--time-limit", fmt::format("{}", 0.05 * tenths)});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("stopped"));
  }
}

TEST_F(Render, RefusesATargetThatNoVectorsCanMeet) {
  expectRefusal(quick("a.exr", {"--method", "path", "--target-error", "1%"}),
                HasSubstr("--target-error: only light vectors"));
  expectRefusal(quick("a.exr", {"--set", "method.rules=printed", "--target-error", "1%"}),
                HasSubstr("--target-error: only light vectors"));
  for (const char* wrong : {"0%", "-1%", "x", "nan"})
    expectRefusal(quick("a.exr", {"--target-error", wrong}), HasSubstr("--target-error"));
  expectSuccess(quick("a.exr", {"--save-cache", "a.lvcache"}));
  expectRefusal(quick("b.exr", {"--cache", "a.lvcache", "--lock-cache", "--target-error", "1%"}),
                HasSubstr("--target-error: a locked cache takes no more vectors"));
}

// ---- --stats

TEST_F(Render, StatisticsAreCompleteAndAgreeWithThePicture) {
  expectSuccess(quick("a.exr", {"--stats", "a.json", "--threads", "2", "--seed", "3"}));
  const json stats = json::parse(program_.read("a.json"));
  std::vector<std::string> keys;
  for (const auto& [key, value] : stats.items()) keys.push_back(key);
  EXPECT_THAT(keys, testing::UnorderedElementsAre(
                        "wall_seconds", "cpu_seconds", "rays", "ilv_records", "dlv_records", "full_indirect",
                        "interpolated_indirect", "full_direct", "interpolated_direct", "non_finite_samples",
                        "peak_memory_bytes", "passes", "scene_hash", "parameters", "method", "threads",
                        "unanswered", "refined_pixels", "stopped_early", "version"));
  std::uint64_t rays = 0;
  for (const char* kind : {"camera", "gather", "bounce", "shadow", "visibility"}) {
    rays += stats["rays"][kind].get<std::uint64_t>();
  }
  EXPECT_EQ(stats["rays"]["total"], rays);
  EXPECT_GT(rays, 0u);
  EXPECT_GT(stats["wall_seconds"], 0.0);
  EXPECT_GT(stats["cpu_seconds"], 0.0);
  EXPECT_GT(stats["peak_memory_bytes"], 1u << 20);
  EXPECT_EQ(stats["threads"], 2);
  EXPECT_EQ(stats["stopped_early"], false);
  EXPECT_EQ(stats["non_finite_samples"], 0);

  const LayeredImage picture = image("a.exr");
  EXPECT_EQ(stats["scene_hash"], picture.metadata.at("scene_hash"));
  EXPECT_EQ(std::to_string(stats["passes"].get<int>()), picture.metadata.at("passes"));
  EXPECT_EQ(stats["version"], picture.metadata.at("lightvane_version"));
  double full = 0.0;
  for (const float count : picture.channels.at("cache.full_ilv")) full += static_cast<double>(count);
  EXPECT_EQ(stats["full_indirect"].get<double>(), full)
      << "one sample a pixel, no mirrors: each ILV has its pixel";
  EXPECT_EQ(stats["ilv_records"], stats["full_indirect"]);

  EXPECT_EQ(stats["parameters"].size(), parametersAsText(Parameters{}).size());
  EXPECT_EQ(stats["parameters"]["seed"], 3);
  EXPECT_EQ(stats["parameters"]["path.roulette"], true);
  EXPECT_EQ(stats["parameters"]["dlv.r_max"], "1.5%");
  EXPECT_EQ(stats["parameters"]["method.name"], "vectors");
}

// ---- caches

TEST_F(Render, CachesAreWrittenReadAndLocked) {
  expectSuccess(quick("a.exr", {"--save-cache", "room.lvcache", "--stats", "a.json"}));
  expectSuccess(quick("b.exr", {"--cache", "room.lvcache", "--lock-cache", "--stats", "b.json"}));
  const json a = json::parse(program_.read("a.json"));
  const json b = json::parse(program_.read("b.json"));
  EXPECT_EQ(b["ilv_records"], a["ilv_records"]);
  EXPECT_EQ(b["full_indirect"], 0) << "the cache was locked";
  EXPECT_THAT(image("b.exr").metadata.at("command"), HasSubstr("--cache room.lvcache --lock-cache"));
  expectRefusal(quick("c.exr", {"--lock-cache"}), HasSubstr("--lock-cache: there is no cache to lock"));
  expectRefusal(path("c.exr", {"--cache", "room.lvcache"}), HasSubstr("this method has none"));
  expectRefusal(path("c.exr", {"--save-cache", "c"}), HasSubstr("--save-cache: caches hold light vectors"));
  expectRefusal(quick("c.exr", {"--cache", "missing"}), HasSubstr("missing: no such file"));
  expectRefusal(quick("c.exr", {"--cache", "a.exr"}), HasSubstr("a.exr"));
}

TEST_F(Render, PointCloudsAreWrittenAndNotRead) {
  expectSuccess(quick("a.exr", {"--save-cache", "room.PLY", "--stats", "a.json"}));
  const std::string cloud = program_.read("room.PLY");
  const auto count = json::parse(program_.read("a.json"))["ilv_records"].get<int>();
  EXPECT_THAT(cloud, testing::StartsWith("ply\nformat binary_little_endian 1.0\ncomment Lightvane "));
  EXPECT_THAT(cloud, HasSubstr(fmt::format("\nelement vertex {}\n", count)));
  expectRefusal(quick("b.exr", {"--cache", "room.PLY"}),
                HasSubstr("--cache: room.PLY is a point cloud for other programs"));
}

TEST_F(Render, WarnsOfParametersThatContradictEachOther) {
  const Outcome outcome = program_.run(quick("a.exr", {"--set", "ilv.n_min=20", "--set", "ilv.n_max=16"}));
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, HasSubstr("ilv.n_min = 20 vectors are asked for where ilv.n_max = 16 are used"));
  EXPECT_THAT(program_.run(quick("b.exr")).err, testing::Not(HasSubstr("asked for")));
}

TEST_F(Render, AnEmptyValueIsNoValue) {
  for (const char* option : {"--crop", "--camera", "--method", "--passes", "--stats"})
    expectRefusal(quick("c.exr", {option, ""}), HasSubstr(std::string(option) + ": has an empty value"));
}

TEST_F(Render, WritesThroughALink) {
  std::filesystem::create_symlink("behind.exr", program_.path("link.exr"));
  program_.write("behind.exr", "");
  expectSuccess(quick("link.exr"));
  EXPECT_TRUE(std::filesystem::is_symlink(program_.path("link.exr")));
  EXPECT_GT(image("behind.exr").width, 0);
}

// ---- what it says

TEST_F(Render, SaysWhatItDidOnStderr) {
  const Outcome outcome = program_.run(quick("a.exr"));
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("; wrote a.exr\n"));
  EXPECT_THAT(outcome.err, HasSubstr("ILVs"));
  EXPECT_THAT(outcome.err, HasSubstr("passes"));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("\x1b"))) << "stderr is no terminal here";
}

TEST_F(Render, QuietIsSilent) {
  const Outcome outcome = program_.run(quick("a.exr", {"--quiet", "--resume"}));
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST_F(Render, QuietStillWarns) {
  program_.write(
      "dark.toml",
      "version = 1\n[camera]\nposition = [0.0, 0.0, 2.0]\n[material.grey]\ndiffuse = [0.5, 0.5, 0.5]\n"
      "[[shape]]\ntype = \"sphere\"\nmaterial = \"grey\"\nradius = 0.5\n");
  const Outcome outcome = program_.run({"render", "dark.toml", "-o", "a.png", "--size", "8x8", "-q"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.err, "lightvane: warning: the scene has no light: its picture is black\n");
}

TEST_F(Render, WithoutADisplayASceneAloneIsRenderedHere) {
  program_.write("room.toml", program_.read(shippedScene("furnace")) + "\n[render]\npreset = \"draft\"\n");
  std::string scene = program_.read("room.toml");
  scene.replace(scene.find("resolution"), std::string("resolution").size(), "resolution = [8, 8] #");
  program_.write("room.toml", scene);
  const Outcome outcome = program_.run({"room.toml"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("there is no display for the window"));
  EXPECT_THAT(outcome.err, HasSubstr("rendering room.toml to room.png"));
  EXPECT_THAT(program_.files(), ElementsAre("room.png", "room.toml"));
}

// ---- refusals, all before work begins

TEST_F(Render, WithoutADisplayASessionSaysSo) {
  program_.write("room.lvsession", "");
  expectRefusal({"room.lvsession"}, HasSubstr("there is no display"));
}

TEST_F(Render, RefusesWhatIsNoScene) {
  expectRefusal({"render", "missing.toml", "-o", "a.exr"}, HasSubstr("missing.toml: no such file"));
  program_.write("notes.txt", "hello");
  expectRefusal({"render", "notes.txt", "-o", "a.exr"},
                HasSubstr("expected a .toml, .obj, .ply, .gltf or .glb file"));
  program_.write("broken.toml", "version = 1\n[camera\n");
  expectRefusal({"render", "broken.toml", "-o", "a.exr"}, HasSubstr("broken.toml:2:"));
  program_.write("wrong.toml", program_.read(shippedScene("cornell")) + "\n[render]\nilv.nmin = 3\n");
  expectRefusal({"render", "wrong.toml", "-o", "a.exr"},
                HasSubstr("there is no parameter 'ilv.nmin' (did you mean ilv.n_min?)"));
  expectRefusal({"render", "wrong.toml", "-o", "a.exr"},
                testing::ContainsRegex("wrong.toml:[0-9]+:[0-9]+: "));
}

TEST_F(Render, RefusesWhatCannotBeWritten) {
  expectRefusal(quick("a.gif"), HasSubstr("unknown image format .gif"));
  expectRefusal(quick("a.jpeg"), HasSubstr("JPEG pictures are read, not written"));
  expectRefusal(quick("a"), HasSubstr("has no extension"));
  expectRefusal(quick("missing/a.exr"), HasSubstr("the folder missing does not exist"));
  expectRefusal(quick("a.exr", {"--stats", "missing/a.json"}),
                HasSubstr("the folder missing does not exist"));
  expectRefusal(quick("a.exr", {"--save-cache", "missing/a"}),
                HasSubstr("the folder missing does not exist"));
  // /proc lets nobody create a file, root neither.
  expectRefusal(quick("/proc/a.exr"), HasSubstr("/proc/a.exr: cannot be written"));
  expectRefusal(quick("a.exr", {"--stats", "/proc/a.json"}), HasSubstr("/proc/a.json: cannot be written"));
  std::filesystem::create_directory(program_.path("folder.exr"));
  expectRefusal(quick("folder.exr"), HasSubstr("is a folder"));
  if (geteuid() != 0) {
    std::filesystem::create_directory(program_.path("locked"));
    std::filesystem::permissions(program_.path("locked"), std::filesystem::perms::owner_read);
    expectRefusal(quick("locked/a.exr"), HasSubstr("locked/a.exr"));
  }
}

TEST_F(Render, RefusesToWriteTwoThingsToOneFile) {
  expectRefusal(quick("a.exr", {"-o", "./a.exr"}), HasSubstr("is also --output"));
  expectRefusal(quick("a.exr", {"--stats", "a.exr"}), HasSubstr("--stats: a.exr is also --output"));
  expectRefusal(quick("a.exr", {"--stats", "b", "--save-cache", "b"}),
                HasSubstr("--save-cache: b is also --stats"));
  expectRefusal(quick("a.exr", {"--stats", shippedScene("cornell")}), HasSubstr("is also the scene"));
}

TEST_F(Render, RefusesWhatTheSceneDoesNotHave) {
  expectRefusal(quick("a.exr", {"--camera", "left"}), HasSubstr("the scene has no camera 'left'"));
  std::string scene = program_.read(shippedScene("cornell"));
  scene.replace(scene.find("[camera]"), std::string("[camera]").size(), "[[cameras]]\nname = \"front\"");
  program_.write("room.toml", scene);
  expectRefusal({"render", "room.toml", "-o", "a.exr", "--camera", "fornt"},
                HasSubstr("did you mean front?"));
  expectRefusal({"render", "room.toml", "-o", "a.exr", "--camera", "xyz"}, HasSubstr("it has front"));
  expectRefusal(quick("a.exr", {"--crop", "20,0,5,5"}), HasSubstr("the picture has 24x20 pixels"));
  expectRefusal(quick("a.exr", {"--crop", "2147483647,0,5,5"}), HasSubstr("reaches out of the picture"));
}

TEST_F(Render, RefusesCamerasThatSeeNothing) {
  expectRefusal(quick("a.exr", {"--from=1,1,1", "--at=1,1,1"}), HasSubstr("the same point"));
  expectRefusal(quick("a.exr", {"--from=0,0,1e20"}),
                HasSubstr("no farther from the scene than 1e9 times its size"));
  expectRefusal(quick("a.exr", {"--from=0,0,0", "--at=0,1,0", "--up=0,1,0"}),
                HasSubstr("up points along the view"));
  expectRefusal(quick("a.exr", {"--light", "ligth=1"}), HasSubstr("did you mean light?"));
}

TEST_F(Render, RefusesUnknownKeysAndValues) {
  expectRefusal(quick("a.exr", {"--set", "ilv.nmin=3"}),
                HasSubstr("--set ilv.nmin=3: there is no parameter"));
  expectRefusal(quick("a.exr", {"--set", "ilv.n_min=0"}), HasSubstr("takes a value from 1 to 1000, not '0'"));
  expectRefusal(quick("a.exr", {"--method", "photons"}), HasSubstr("vectors, path, naive or direct"));
  expectRefusal({"render", shippedScene("cornell"), "-o", "a.exr", "--preset", "best"},
                HasSubstr("--preset: preset takes draft, balanced or fine, not 'best'"));
  expectRefusal(quick("a.exr", {"--spp", "many"}), HasSubstr("--spp: film.samples takes a whole number"));
  expectRefusal(quick("a.exr", {"--seed", "-1"}), HasSubstr("--seed: seed takes"));
  expectRefusal(quick("a.exr", {"--seed", "1", "--set", "seed=2"}), HasSubstr("give one of them"));
}

}  // namespace
}  // namespace lightvane
