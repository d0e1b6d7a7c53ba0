#include <cstring>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/gl/draw_lists.h"
#include "app/gl/overlay_layer.h"
#include "app/gl/picture_layer.h"
#include "tests/gl/memory_gl.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

TEST(GlFunctions, AMissingOneIsNamed) {
  const Expected<Gl> gl = Gl::load([](const char* name) -> Gl::Function {
    return std::strcmp(name, "glDrawElementsBaseVertex") == 0 ? nullptr : +[] {};
  });
  ASSERT_FALSE(gl);
  EXPECT_THAT(gl.error().message(), testing::HasSubstr("no function glDrawElementsBaseVertex"));
}

class Shaders : public GlTest {
 protected:
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  std::string errorOf(const std::string& vertex, const std::string& fragment) const {
    const Expected<ShaderProgram> program = ShaderProgram::build(gl(), {folder_.path()}, vertex, fragment);
    return program ? "" : program.error().message();
  }

  TemporaryFolder folder_;
  const std::string kVertex = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n";
};

TEST_F(Shaders, AFolderStandsForWhatIsBuiltIn) {
  const ShaderSources fromSource{fs::path(LIGHTVANE_SOURCE_DIR) / "shaders"};
  EXPECT_EQ(fromSource.read("picture.frag").value(), ShaderSources{}.read("picture.frag").value());
  EXPECT_TRUE(OverlayLayer::create(gl(), fromSource));
}

TEST_F(Shaders, AnErrorNamesFileAndLineAndHasTheLog) {
  write("good.vert", kVertex);
  write("bad.frag", "#version 330 core\nout vec4 color;\nvoid main() {\n  color = lamp;\n}\n");
  EXPECT_THAT(
      errorOf("good.vert", "bad.frag"),
      testing::AllOf(testing::StartsWith((folder_ / "bad.frag:4").string() + ": the shader does not compile"),
                     testing::HasSubstr("lamp")));
}

TEST_F(Shaders, AnErrorInAnIncludedFileNamesThat) {
  write("good.vert", kVertex);
  write("shared.glsl", "float scaled(float x) {\n  return x * lamp;\n}\n");
  write("user.frag",
        "#version 330 core\n#include \"shared.glsl\"\nout vec4 color;\nvoid main() { color = "
        "vec4(scaled(1.0)); }\n");
  EXPECT_THAT(errorOf("good.vert", "user.frag"), testing::StartsWith((folder_ / "shared.glsl:2").string()));

  write("shared.glsl", "float twice(float x) {\n  return 2.0 * x;\n}\n");
  write("user.frag",
        "#version 330 core\n#include \"shared.glsl\"\nout vec4 color;\nvoid main() { color = lamp; }\n");
  EXPECT_THAT(errorOf("good.vert", "user.frag"), testing::StartsWith((folder_ / "user.frag:4").string()));
}

TEST_F(Shaders, StagesThatDoNotFitTogetherAreNamed) {
  write("lamp.vert", "#version 330 core\nout vec4 lamp;\nvoid main() { gl_Position = lamp = vec4(0.0); }\n");
  write("eager.frag",
        "#version 330 core\nin vec3 lamp;\nout vec4 color;\nvoid main() { color = vec4(lamp, 1.0); }\n");
  EXPECT_THAT(errorOf("lamp.vert", "eager.frag"),
              testing::AllOf(testing::StartsWith("lamp.vert and eager.frag: "), testing::HasSubstr("lamp")));
}

TEST_F(Shaders, AMissingFileIsNamed) {
  write("good.vert", kVertex);
  EXPECT_THAT(errorOf("good.vert", "none.frag"), testing::HasSubstr("none.frag"));
  EXPECT_THAT(ShaderSources{}.read("none.frag").error().message(), testing::HasSubstr("none.frag"));
}

class FramebufferTest : public GlTest {};

TEST_F(FramebufferTest, IsReadFromTheTop) {
  const Framebuffer target(gl(), 5, 3);
  target.clear({10, 20, 30, 255});
  target.fill(1, 0, 2, 1, {200, 100, 50, 255});
  const Image<Color8> read = target.read();
  EXPECT_EQ(read.at(0, 0), (Color8{10, 20, 30, 255}));
  EXPECT_EQ(read.at(1, 0), (Color8{200, 100, 50, 255}));
  EXPECT_EQ(read.at(2, 0), (Color8{200, 100, 50, 255}));
  EXPECT_EQ(read.at(3, 0), (Color8{10, 20, 30, 255}));
  EXPECT_EQ(read.at(1, 1), (Color8{10, 20, 30, 255}));
}

TEST_F(FramebufferTest, ACopyIsTheSame) {
  const Framebuffer from(gl(), 5, 3), to(gl(), 5, 3);
  from.clear({10, 20, 30, 255});
  from.fill(1, 0, 2, 1, {200, 100, 50, 255});
  from.copyTo(to);
  EXPECT_EQ(to.read(), from.read());
}

TEST_F(FramebufferTest, ObjectsMoveWithWhoOwnsThem) {
  GlTexture first(gl());
  const GLuint id = first.id();
  GlTexture second = std::move(first);
  EXPECT_EQ(second.id(), id);
  EXPECT_EQ(first.id(), 0U);  // NOLINT(bugprone-use-after-move): what a move leaves is promised
  first = std::move(second);
  EXPECT_EQ(first.id(), id);
}

}  // namespace
}  // namespace lightvane
