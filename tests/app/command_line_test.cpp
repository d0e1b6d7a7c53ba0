#include "app/command_line.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightvane {
namespace {

using Words = std::vector<std::string>;

RenderArguments render(Words words) {
  words.insert(words.begin(), "render");
  const auto parsed = parseCommandLine(words);
  if (!parsed) {
    ADD_FAILURE() << parsed.error().message();
    return {};
  }
  return std::get<RenderArguments>(*parsed);
}

std::string errorOf(const Words& words) {
  const auto parsed = parseCommandLine(words);
  return parsed ? "none" : parsed.error().message();
}

TEST(CommandLine, SceneMayStandBeforeOrAfterTheOutputs) {
  using testing::ElementsAre;
  for (const Words& words :
       {Words{"a.toml", "-o", "b.exr", "c.png"}, Words{"-o", "b.exr", "c.png", "a.toml"},
        Words{"-o", "b.exr", "-o", "c.png", "a.toml"}, Words{"--output", "b.exr", "a.toml", "c.png"},
        Words{"-o", "b.exr", "c.png", "--seed", "1", "a.toml"}}) {
    const RenderArguments arguments = render(words);
    EXPECT_EQ(arguments.scene, "a.toml");
    EXPECT_THAT(arguments.outputs, ElementsAre("b.exr", "c.png"));
  }
}

TEST(CommandLine, EveryOptionOfRenderIsRead) {
  const RenderArguments a =
      render({"s.obj",   "-o",           "o.exr",      "--method",  "path",       "--preset",
              "fine",    "--set",        "ilv.rows=3", "--set",     "ilv.rows=4", "--camera",
              "left",    "--size",       "64x48",      "--crop",    "1,2,3,4",    "--spp",
              "7",       "--seed",       "9",          "--threads", "2",          "--passes",
              "5",       "--time-limit", "2m",         "--resume",  "--stats",    "s.json",
              "--quiet", "--save-cache", "c1",         "--cache",   "c2",         "--lock-cache"});
  std::string settings;
  for (const RenderSetting& s : a.settings.settings) settings += s.key + "=" + s.value + " ";
  EXPECT_EQ(settings, "method.name=path preset=fine seed=9 ilv.rows=3 ilv.rows=4 ");
  EXPECT_EQ(a.settings.samplesPerPixel.value().value, "7");
  EXPECT_EQ(a.camera, "left");
  EXPECT_EQ(a.size, (PictureSize{64, 48}));
  EXPECT_EQ(a.crop, (PictureCrop{1, 2, 3, 4}));
  EXPECT_EQ(a.threads, 2);
  EXPECT_EQ(a.passes, 5);
  EXPECT_EQ(a.timeLimitSeconds, 120.0);
  EXPECT_TRUE(a.resume && a.quiet && a.lockCache);
  EXPECT_EQ(a.stats, "s.json");
  EXPECT_EQ(a.saveCache, "c1");
  EXPECT_EQ(a.cache, "c2");
}

TEST(CommandLine, CamerasAndLightsAreChangedByNumbers) {
  const RenderArguments a =
      render({"s.toml", "-o", "o.exr", "--from=-1,2.5,3e-2", "--at", "0,0,1", "--up", "0,0,1", "--fov-y",
              "30.5", "--light", "lamp=0.5", "--light", "a=b=1,0,2", "--indirect-light", "lamp=2"});
  EXPECT_EQ(a.cameraChanges.position, Vec3d(-1, 2.5, 0.03));
  EXPECT_EQ(a.cameraChanges.target, Vec3d(0, 0, 1));
  EXPECT_EQ(a.cameraChanges.up, Vec3d(0, 0, 1));
  EXPECT_EQ(a.cameraChanges.fovYDegrees, 30.5);
  EXPECT_FALSE(a.cameraChanges.lensRadius);
  EXPECT_THAT(a.lights,
              testing::ElementsAre(LightChange{"lamp", Rgb(0.5f)}, LightChange{"a=b", Rgb(1, 0, 2)}));
  EXPECT_THAT(a.indirectLights, testing::ElementsAre(LightChange{"lamp", Rgb(2.0f)}));
}

TEST(CommandLine, CamerasTakeALensOrAHeight) {
  const CameraChanges lens =
      render({"s.toml", "-o", "o.exr", "--lens-radius", "0.02", "--focus-distance=1.5e1"}).cameraChanges;
  EXPECT_EQ(lens.lensRadius, 0.02);
  EXPECT_EQ(lens.focusDistance, 15.0);
  EXPECT_TRUE(lens.any());
  EXPECT_EQ(render({"s.toml", "-o", "o.exr", "--lens-radius=0"}).cameraChanges.lensRadius, 0.0);
  EXPECT_EQ(render({"s.toml", "-o", "o.exr", "--orthographic", "2.5"}).cameraChanges.orthographicHeight, 2.5);
  const auto refused = [](const Words& more) {
    Words words = {"render", "s.toml", "-o", "o.exr"};
    words.insert(words.end(), more.begin(), more.end());
    return errorOf(words);
  };
  EXPECT_THAT(refused({"--orthographic=0"}), testing::HasSubstr("expected a length above 0, found '0'"));
  EXPECT_THAT(refused({"--orthographic=x"}), testing::HasSubstr("--orthographic"));
  EXPECT_THAT(refused({"--lens-radius=-1"}), testing::HasSubstr("expected a length, or 0 for a pinhole"));
  EXPECT_THAT(refused({"--focus-distance=nan"}), testing::HasSubstr("--focus-distance"));
  EXPECT_THAT(refused({"--orthographic=2", "--fov-y=30"}), testing::HasSubstr("cannot stand beside --fov-y"));
}

TEST(CommandLine, RefusesWhatIsNoPointAngleOrFactor) {
  for (const char* text : {"", "1,2", "1,2,3,4", "1,2,x", "1,2,inf", "1,,3"})
    EXPECT_FALSE(parsePoint(text, "--at")) << text;
  for (const char* text :
       {"", "lamp", "=1", "lamp=", "lamp=1,2", "lamp=-1", "lamp=1e9", "lamp=nan", "lamp=1,2,3,4"})
    EXPECT_FALSE(parseLight(text, "--light")) << text;
}

TEST(CommandLine, PicturesForScreensTakeALook) {
  const RenderArguments a =
      render({"s.toml", "-o", "o.exr", "o.PNG", "--view", "error", "--reference", "r.exr", "--exposure=-1.5",
              "--tone-map", "filmic", "--color-map", "grey", "--range=-5,1e2"});
  EXPECT_EQ(a.look, (PictureLook{PictureView::Error,
                                 -1.5f,
                                 ToneMap::Filmic,
                                 {.map = ColorMap::Grey, .fixedRange = true, .low = -5.0f, .high = 100.0f}}));
  EXPECT_EQ(a.reference, "r.exr");
  EXPECT_EQ(render({"s.toml", "-o", "o.exr"}).look, PictureLook{});
}

TEST(CommandLine, RefusesLooksThatCannotBe) {
  const auto refused = [](const Words& more, const char* output = "o.png") {
    Words words = {"render", "s.toml", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return errorOf(words);
  };
  EXPECT_EQ(
      refused({"--view", "indirct"}),
      "--view: expected beauty, direct, indirect, specular, where-computed, vectors-used, nearest-vector, "
      "error, estimated-error, error-sources, albedo, normal or depth, found 'indirct' (did you mean "
      "indirect?)");
  EXPECT_THAT(refused({"--tone-map", "linear"}), testing::HasSubstr("expected clip, reinhard or filmic"));
  EXPECT_THAT(refused({"--color-map", "jet"}), testing::HasSubstr("expected grey, viridis"));
  for (const char* stops : {"x", "nan", "21", "-20.5"})
    EXPECT_THAT(refused({std::string("--exposure=") + stops}), testing::HasSubstr("expected stops from -20"));
  for (const char* range : {"1", "1,", "2,1", "1,1", "0,inf", "nan,1", "1,2,3"})
    EXPECT_THAT(refused({std::string("--range=") + range}), testing::HasSubstr("expected LOW,HIGH")) << range;
  EXPECT_THAT(refused({"--view", "error"}), testing::HasSubstr("--reference FILE"));
  EXPECT_THAT(refused({"--reference", "r.exr"}), testing::HasSubstr("--view error"));
  EXPECT_THAT(refused({"--view", "depth"}, "o.exr"), testing::HasSubstr("no .png is written"));
}

TEST(CommandLine, OtherCommands) {
  const auto open = parseCommandLine(Words{"room.toml"});
  EXPECT_EQ(std::get<OpenArguments>(*open).file, "room.toml");
  for (const char* file : {"room.obj", "room.ply", "room.gltf", "room.GLB"})
    EXPECT_EQ(std::get<OpenArguments>(*parseCommandLine(Words{file})).file, file);
  EXPECT_EQ(std::get<OpenArguments>(*parseCommandLine(Words{"room.lvsession"})).file, "room.lvsession");
  EXPECT_FALSE(std::get<OpenArguments>(*parseCommandLine(Words{})).file);
  const auto scene = parseCommandLine(Words{"scene", "room.toml", "--json"});
  EXPECT_EQ(std::get<SceneArguments>(*scene).scene, "room.toml");
  EXPECT_TRUE(std::get<SceneArguments>(*scene).json);
  const auto parameters = parseCommandLine(Words{"parameters", "--markdown", "ilv", "seed"});
  EXPECT_THAT(std::get<ParametersArguments>(*parameters).keys, testing::ElementsAre("ilv", "seed"));
  EXPECT_TRUE(std::get<ParametersArguments>(*parameters).markdown);
}

TEST(CommandLine, MistakesAreNamedWithWhatWasMeant) {
  EXPECT_EQ(errorOf({"rendr", "a.toml"}),
            "'rendr' is neither a command nor a .toml, .obj, .ply, .gltf, .glb or .lvsession file (did you "
            "mean render?)");
  EXPECT_EQ(errorOf({"render", "a.toml", "-o", "a.exr", "--sead", "3"}),
            "render: there is no option --sead (did you mean --seed?)");
  EXPECT_EQ(errorOf({"a.toml", "-o", "a.exr"}),
            "a scene without a command takes no more words (lightvane render a.toml -o FILE ...)");
  EXPECT_THAT(errorOf({"render", "-o", "a.exr"}), testing::StartsWith("render: which scene?"));
  EXPECT_THAT(errorOf({"render", "a.toml"}), testing::HasSubstr("(-o a.exr)"));
  EXPECT_THAT(errorOf({"render", "a.toml", "b.toml", "-o", "a.exr"}),
              testing::HasSubstr("unexpected word 'b.toml'"));
  EXPECT_THAT(errorOf({"render", "a.toml", "-o", "a.exr", "--set", "ilv.rows"}),
              testing::HasSubstr("--set: expected key=value, found 'ilv.rows'"));
  EXPECT_THAT(errorOf({"render", "a.toml", "-o", "a.exr", "--seed"}), testing::HasSubstr("--seed"));
  EXPECT_THAT(errorOf({"scene"}), testing::StartsWith("scene: which scene?"));
  EXPECT_THAT(errorOf({"--verson"}), testing::HasSubstr("did you mean --version?"));
}

TEST(CommandLine, NumbersOutOfTheirRangesAreRefused) {
  const auto refuses = [](const std::string& option, const std::string& value) {
    return errorOf({"render", "a.toml", "-o", "a.exr", option, value}).starts_with(option + ": expected");
  };
  for (const char* size : {"0x5", "5x0", "-1x5", "5", "5x", "x5", "5x5x5", "65537x1", "5.5x5", "5 x5"}) {
    EXPECT_TRUE(refuses("--size", size)) << size;
  }
  for (const char* crop :
       {"1,2,3", "1,2,3,4,5", "1,2,0,4", "1,2,3,0", "-1,2,3,4", "a,b,c,d", ",,,", "1 2 3 4"}) {
    EXPECT_TRUE(refuses("--crop", crop)) << crop;
  }
  for (const char* count : {"0", "-1", "x", "1.5", "99999999999"}) {
    EXPECT_TRUE(refuses("--passes", count)) << count;
    EXPECT_TRUE(refuses("--threads", count)) << count;
  }
  for (const char* time : {"0", "-5", "x", "5d", "inf", "nan", "s", "1e300"}) {
    EXPECT_TRUE(refuses("--time-limit", time)) << time;
  }
}

TEST(CommandLine, DurationsHaveUnits) {
  EXPECT_EQ(parseDuration("90", "x"), 90.0);
  EXPECT_EQ(parseDuration("90s", "x"), 90.0);
  EXPECT_EQ(parseDuration("1.5m", "x"), 90.0);
  EXPECT_EQ(parseDuration("2h", "x"), 7200.0);
}

}  // namespace
}  // namespace lightvane
