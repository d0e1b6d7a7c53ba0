// `lightvane compare`, as a user runs it.

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image/image_file.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class Compare : public testing::Test {
 protected:
  /// Writes a picture.
  void write(const std::string& name, const ImageRgb& pixels) {
    LayeredImage image;
    image.width = pixels.width();
    image.height = pixels.height();
    image.setRgb("", pixels);
    const auto written = writeImage(program_.path(name), image);
    ASSERT_TRUE(written) << written.error().message();
  }
  /// Writes an even picture, of layers if they are given.
  void writeEven(const std::string& name, float value, const std::vector<std::string>& layers = {},
                 int width = 32) {
    LayeredImage image;
    image.width = width;
    image.height = 16;
    image.setRgb("", ImageRgb(width, 16, Rgb(value)));
    for (const std::string& layer : layers) image.setRgb(layer, ImageRgb(width, 16, Rgb(0.5f * value)));
    const auto written = writeImage(program_.path(name), image);
    ASSERT_TRUE(written) << written.error().message();
  }
  json jsonOf(std::vector<std::string> words) {
    words.insert(words.begin(), "compare");
    words.emplace_back("--json");
    const Outcome outcome = program_.run(words);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return json::parse(outcome.out);
  }
  std::string errorOf(const std::vector<std::string>& words) {
    const Outcome outcome = program_.run(words);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  }

  Program program_;
};

TEST_F(Compare, TellsEveryMetricOfEveryLayer) {
  writeEven("a.exr", 1.1f, {"direct", "indirect"});
  writeEven("b.exr", 1.0f, {"direct", "indirect"});
  const Outcome outcome = program_.run({"compare", "a.exr", "b.exr"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("a.exr against b.exr: 32 x 16 pixels, of which 512 count"));
  EXPECT_THAT(outcome.out, HasSubstr("metric      beauty"));
  for (const char* metric :
       {"bias", "mrae", "rmse", "relmse", "relative", "worst-tile", "psnr", "ssim", "flip", "hdrflip"})
    EXPECT_THAT(outcome.out, HasSubstr("\n" + std::string(metric) + " "));

  const json all = jsonOf({"a.exr", "b.exr"});
  EXPECT_EQ(all["layers"].size(), 3U);
  for (const char* layer : {"beauty", "direct", "indirect"}) {
    const json& of = all["layers"][layer];
    EXPECT_EQ(of["counted"], 512);
    EXPECT_NEAR(of["metrics"]["bias"]["value"].get<double>(), 0.1, 1e-6) << layer;
    // Relative to the mean and, a little, to the hundredth of it that stands for the dark.
    EXPECT_NEAR(of["metrics"]["relative"]["value"].get<double>(), 0.1, 1e-5) << layer;
    EXPECT_FALSE(of["metrics"]["relative"].contains("of_reference_noise")) << "the file does not say it";
  }
  EXPECT_NEAR(all["layers"]["direct"]["metrics"]["rmse"]["value"].get<double>(), 0.05, 1e-6);
}

TEST_F(Compare, TellsWhatIsAskedFor) {
  writeEven("a.exr", 0.5f, {"direct"});
  writeEven("b.exr", 0.5f, {"direct"});
  const json one = jsonOf({"a.exr", "b.exr", "--metric", "psnr", "--metric", "rmse", "--layer", "direct"});
  ASSERT_EQ(one["layers"].size(), 1U);
  EXPECT_EQ(one["layers"]["direct"]["metrics"].size(), 2U);
  EXPECT_EQ(one["layers"]["direct"]["metrics"]["psnr"]["value"], "infinite");
  EXPECT_EQ(one["layers"]["direct"]["metrics"]["rmse"]["value"], 0.0);
}

// Every pair of formats; what a screen shows and what light is are told apart.
TEST_F(Compare, ReadsEveryFormat) {
  for (const char* ending : {".exr", ".hdr", ".pfm"}) {
    writeEven("a" + std::string(ending), 0.75f);
    EXPECT_EQ(jsonOf({"a" + std::string(ending), "a.exr", "--metric",
                      "bias"})["layers"]["beauty"]["metrics"]["bias"]["value"],
              0.0)
        << ending;
  }
  writeEven("a.png", 0.25f);
  writeEven("b.png", 0.25f);
  const Outcome same = program_.run({"compare", "a.png", "b.png", "--metric", "flip"});
  EXPECT_EQ(same.err, "");
  EXPECT_THAT(same.out, HasSubstr("flip    0"));
  const Outcome mixed = program_.run({"compare", "a.png", "a.exr", "--metric", "flip"});
  EXPECT_EQ(mixed.exitCode, 0);
  EXPECT_THAT(mixed.err,
              HasSubstr("a.png has what a screen shows, exposed and clipped, and a.exr has radiance"));
}

TEST_F(Compare, LeavesOutEdgesAndLights) {
  const std::vector<std::string> render = {
      "render", shippedScene("cornell"), "--size", "48x48", "--quiet", "--preset", "draft"};
  for (const std::string name : {"a.exr", "b.exr"}) {
    std::vector<std::string> words = render;
    words.insert(words.end(), {"-o", name, "--seed", name == "a.exr" ? "1" : "2"});
    ASSERT_EQ(program_.run(words).exitCode, 0);
  }
  const auto countedOf = [this](const std::string& without) {
    std::vector<std::string> words = {"a.exr", "b.exr", "--metric", "bias"};
    if (!without.empty()) words.insert(words.end(), {"--without", without});
    return jsonOf(words)["layers"]["beauty"]["counted"].get<int>();
  };
  EXPECT_EQ(countedOf(""), 48 * 48);
  const int edges = countedOf("edges");
  const int lights = countedOf("lights");
  EXPECT_LT(edges, 48 * 48 - 200);
  EXPECT_GT(edges, 48 * 48 / 4);
  EXPECT_LT(lights, 48 * 48);
  EXPECT_GT(lights, 48 * 48 - 200);
  EXPECT_LT(countedOf("edges,lights"), std::min(edges, lights));
}

TEST_F(Compare, TakesOffTheNoiseOfAPathTracedReference) {
  const auto render = [this](const std::string& name, const std::string& seed, const std::string& paths) {
    ASSERT_EQ(program_
                  .run({"render", shippedScene("cornell"), "-o", name, "--size", "32x32", "--quiet",
                        "--method", "path", "--spp", paths, "--seed", seed})
                  .exitCode,
              0);
  };
  render("a.exr", "1", "1024");
  render("b.exr", "2", "16");
  const json metric =
      jsonOf({"a.exr", "b.exr", "--metric", "relative"})["layers"]["beauty"]["metrics"]["relative"];
  // The picture has an eighth of the reference's noise: of what is between them almost nothing is its own.
  EXPECT_TRUE(metric["noise_subtracted"]);
  EXPECT_GT(metric["of_reference_noise"].get<double>(), 0.03);
  EXPECT_LT(metric["value"].get<double>(), 0.6 * metric["of_reference_noise"].get<double>());
}

TEST_F(Compare, MapsWhereTheErrorIs) {
  writeEven("b.exr", 1.0f);
  ImageRgb pixels(32, 16, Rgb(1.0f));
  pixels.at(20, 5) = Rgb(1.5f);
  write("a.exr", pixels);
  const Outcome outcome =
      program_.run({"compare", "a.exr", "b.exr", "--metric", "relative", "--map", "map.pfm"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const ImageRgb map = readImage(program_.path("map.pfm"))->rgb();
  EXPECT_NEAR(map.at(20, 5).g, 0.5f, 0.01f);
  EXPECT_EQ(map.at(3, 3).g, 0.0f);
  const Outcome screen = program_.run(
      {"compare", "a.exr", "b.exr", "--metric", "relative", "--map", "map.png", "--range", "0,50"});
  EXPECT_THAT(screen.err, HasSubstr("from 0 (dark) to 50 % (bright)"));
  const ImageRgb shown = readImage(program_.path("map.png"))->rgb();
  EXPECT_GT(shown.at(20, 5).g, 4.0f * shown.at(3, 3).g);
}

TEST_F(Compare, SaysWhatIsNotFinite) {
  writeEven("b.exr", 1.0f);
  ImageRgb pixels(32, 16, Rgb(1.0f));
  pixels.at(1, 1).g = std::numeric_limits<float>::quiet_NaN();
  pixels.at(2, 1).r = std::numeric_limits<float>::infinity();
  write("a.exr", pixels);
  const Outcome outcome = program_.run({"compare", "a.exr", "b.exr", "--metric", "bias"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, HasSubstr("beauty: 2 pixels are not finite in one of the pictures and left out"));
  EXPECT_THAT(outcome.out, HasSubstr("of which 510 count"));
  for (Rgb& pixel : pixels) pixel = Rgb(std::numeric_limits<float>::quiet_NaN());
  write("a.exr", pixels);
  EXPECT_THAT(errorOf({"compare", "a.exr", "b.exr"}), HasSubstr("no pixel of beauty can be compared"));
}

TEST_F(Compare, RefusesWhatCannotBeCompared) {
  writeEven("a.exr", 1.0f);
  writeEven("b.exr", 1.0f, {"direct"}, 33);
  writeEven("c.exr", 1.0f, {"direct"});
  EXPECT_THAT(errorOf({"compare", "a.exr"}), HasSubstr("compare: which pictures? two are compared"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "b.exr", "c.exr"}), HasSubstr("unexpected word 'c.exr'"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "b.exr"}),
              HasSubstr("a.exr: has 32x16 pixels, and b.exr has 33x16 (only pictures of one size"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "none.exr"}), HasSubstr("none.exr: no such file"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "c.exr", "--layer", "direkt"}),
              HasSubstr("a.exr: has no layer direkt"));
  EXPECT_THAT(errorOf({"compare", "c.exr", "c.exr", "--layer", "direkt"}), HasSubstr("did you mean direct?"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "c.exr", "--metric", "relmsee"}),
              HasSubstr("did you mean relmse?"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "c.exr", "--without", "sky"}),
              HasSubstr("--without: expected edges or lights, found 'sky'"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "c.exr", "--without", "edges"}),
              HasSubstr("neither picture says"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "c.exr", "--map", "m.png"}), HasSubstr("a map is of one metric"));
  EXPECT_THAT(errorOf({"compare", "a.exr", "c.exr", "--metric", "flip", "--map", "c.exr"}),
              HasSubstr("the reference"));
  EXPECT_THAT(program_.files(), ElementsAre("a.exr", "b.exr", "c.exr"));
}

}  // namespace
}  // namespace lightvane
