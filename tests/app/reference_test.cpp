// `lightvane reference`, as a user runs it.

#include <cmath>
#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_file.h"
#include "core/measure/comparison.h"
#include "core/measure/picture_error.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class ReferenceCommand : public testing::Test {
 protected:
  static std::vector<std::string> words(const std::string& output, const std::string& target,
                                        const std::vector<std::string>& more = {}) {
    std::vector<std::string> all = {
        "reference", shippedScene("cornell"), "-o", output, "--size", "24x24", "--target", target};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome run(const std::string& output, const std::string& target,
              const std::vector<std::string>& more = {}) {
    const Outcome outcome = program_.run(words(output, target, more));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return outcome;
  }
  LayeredImage picture(const std::string& name) {
    auto read = readImage(program_.path(name));
    EXPECT_TRUE(read) << read.error().message();
    return read.value_or(LayeredImage{});
  }

  Program program_;
};

TEST_F(ReferenceCommand, IsAsSureAsAsked) {
  run("a.exr", "8%");
  const LayeredImage read = picture("a.exr");
  ASSERT_TRUE(read.hasRgb("standard_error"));
  const double noise = pictureNoise(read.rgb(), varianceOf(read));
  EXPECT_LE(noise, 0.08);
  EXPECT_GT(noise, 0.07) << "not a pass too many: one has 16 of the paths";
  EXPECT_EQ(read.metadata.at("complete"), "true");
}

// What the file says of its noise is what two of them differ by, independent as they are: by the root of 2 of
// it, to what some hundred pixels with three colours tell.
TEST_F(ReferenceCommand, KnowsItsOwnNoise) {
  run("a.exr", "8%");
  run("b.exr", "8%", {"--seed", "5"});
  const LayeredImage a = picture("a.exr");
  const LayeredImage b = picture("b.exr");
  for (const std::string layer : {"", "direct", "indirect"}) {
    const std::string name = layer.empty() ? "beauty" : layer;
    const ImageRgb ofA = a.rgb(layer), ofB = b.rgb(layer);
    const double apart = pictureError(ofA, ofB, {}).relative;
    const double noise =
        std::hypot(pictureNoise(ofA, varianceOf(a, name)), pictureNoise(ofB, varianceOf(b, name)));
    EXPECT_NEAR(apart / noise, 1.0, 0.25) << name;
  }
}

TEST_F(ReferenceCommand, GoesOnWithoutLosingAPath) {
  run("whole.exr", "6%");
  run("a.exr", "12%");
  EXPECT_TRUE(program_.exists("a.exr.resume"));
  const Outcome further = run("a.exr", "6%");
  EXPECT_THAT(further.err, HasSubstr("going on from a.exr.resume"));
  EXPECT_EQ(program_.read("a.exr"), program_.read("whole.exr")) << "as if it had not been stopped";

  const std::string before = program_.read("a.exr.resume");
  EXPECT_THAT(run("a.exr", "6%").err, HasSubstr("a.exr is as sure as asked already"));
  EXPECT_EQ(program_.read("a.exr"), program_.read("whole.exr"));
  EXPECT_EQ(program_.read("a.exr.resume"), before);
  std::filesystem::remove(program_.path("a.exr"));
  run("a.exr", "6%");
  EXPECT_TRUE(program_.exists("a.exr")) << "made again where it is gone";
  EXPECT_THAT(run("a.exr", "12%", {"--restart"}).err, Not(HasSubstr("going on from")));
  EXPECT_NE(program_.read("a.exr"), program_.read("whole.exr"));
}

TEST_F(ReferenceCommand, KeepsWhatItHasWhenItIsStopped) {
  program_.start(words("a.exr", "0.01%"));
  ASSERT_TRUE(program_.waitForError("noise"));
  program_.signal(SIGINT);
  const Outcome outcome = program_.finish();
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("paths a pixel: the same command goes on from there"));
  EXPECT_THAT(program_.files(), ElementsAre("a.exr", "a.exr.resume"));
  EXPECT_EQ(picture("a.exr").metadata.at("complete"), "false");
  EXPECT_THAT(run("a.exr", "0.01%", {"--time-limit", "0.1"}).err, HasSubstr("going on from a.exr.resume"));
}

// The command that a picture names makes it again, by `render`.
TEST_F(ReferenceCommand, NamesACommandThatMakesItAgain) {
  run("a.exr", "10%");
  const std::string command = picture("a.exr").metadata.at("command");
  EXPECT_THAT(command, HasSubstr("--method path"));
  const std::string key = "path.samples=";
  const std::string paths = command.substr(command.find(key) + key.size());
  const Outcome outcome = program_.run({"render", shippedScene("cornell"), "-o", "b.exr", "--size", "24x24",
                                        "-q", "--method", "path", "--seed", "1000003", "--spp", paths});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(picture("a.exr").rgb(), picture("b.exr").rgb());
}

TEST_F(ReferenceCommand, RefusesWhatItCannotBe) {
  const auto errorOf = [this](const std::vector<std::string>& all) {
    const Outcome outcome = program_.run(all);
    EXPECT_EQ(outcome.exitCode, 2);
    return outcome.err;
  };
  EXPECT_THAT(errorOf(words("a.png", "1%")), HasSubstr("nothing can be measured against that"));
  for (const char* target : {"0", "-1%", "1000%", "x", "%"})
    EXPECT_THAT(errorOf(words("a.exr", target)),
                HasSubstr("--target: expected a part of the picture's light"));
  EXPECT_THAT(errorOf({"reference", "-o", "a.exr"}), HasSubstr("which scene?"));
  EXPECT_THAT(errorOf({"reference", shippedScene("cornell")}), HasSubstr("where to?"));
  EXPECT_THAT(errorOf(words("a.exr", "1%", {"--method", "naive"})), HasSubstr("there is no option --method"));
}

}  // namespace
}  // namespace lightvane
