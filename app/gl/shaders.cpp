#include "app/gl/shaders.h"

#include <regex>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "app/gl/embedded_shaders.h"
#include "core/base/file.h"

namespace lightvane {
namespace {

constexpr std::size_t kLinesPerFile = 10000;
constexpr std::size_t kLogLength = 8192;  // drivers cut what is longer

/// A stage with its included files pasted in. `files` are in the order of GLSL's source string numbers, by
/// which the driver's log speaks of them.
struct StageText {
  std::string text;
  std::vector<std::string> files;
};

Expected<StageText> readStage(const ShaderSources& sources, const std::string& name) {
  static const std::regex include(R"re(^\s*#\s*include\s+"([^"]+)"\s*$)re");
  const Expected<std::string> source = sources.read(name);
  if (!source) return tl::unexpected(source.error());

  StageText stage{{}, {name}};
  std::istringstream lines(*source);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (std::smatch parts; std::regex_match(line, parts, include)) {
      const std::string file = parts[1];
      const Expected<std::string> included = sources.read(file);
      if (!included) return tl::unexpected(included.error());
      line = fmt::format("#line {}\n{}\n#line {}", stage.files.size() * kLinesPerFile + 1, *included,
                         number + 1);
      stage.files.push_back(file);
    }
    stage.text += line + "\n";
  }
  return stage;
}

/// What a driver wrote into a buffer, without the zeros and line feeds at its end.
std::string logText(const std::string& buffer) {
  const std::string text = buffer.substr(0, buffer.find('\0'));
  return text.substr(0, text.find_last_not_of(" \n\r\t") + 1);
}

/// "overlay_zone.frag:14" from a driver's log. Mesa writes "0:14(3): error", NVIDIA "0(14) : error", others
/// "ERROR: 0:14:".
std::string placeOf(const std::string& log, const StageText& stage) {
  static const std::regex place(R"(\d+[:(](\d+))");
  std::smatch parts;
  if (!std::regex_search(log, parts, place)) return stage.files.front();
  const std::size_t line = std::stoul(parts[1]), file = line / kLinesPerFile;
  if (file >= stage.files.size()) return stage.files.front();
  return fmt::format("{}:{}", stage.files[file], line % kLinesPerFile);
}

}  // namespace

Expected<std::string> ShaderSources::read(const std::string& name) const {
  if (!folder.empty()) return readFile(folder / name);
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (shader.name == name) return std::string(shader.text);
  }
  return makeError(name, "no shader of this name is built in");
}

Expected<ShaderProgram> ShaderProgram::build(const Gl& gl, const ShaderSources& sources,
                                             const std::string& vertexName, const std::string& fragmentName) {
  ShaderProgram program(gl);
  const GLuint id = program.program_.id();
  for (const auto& [kind, name] :
       {std::pair(GL_VERTEX_SHADER, &vertexName), {GL_FRAGMENT_SHADER, &fragmentName}}) {
    const Expected<StageText> stage = readStage(sources, *name);
    if (!stage) return tl::unexpected(stage.error());

    const GLuint shader = gl.CreateShader(static_cast<GLenum>(kind));
    const char* text = stage->text.c_str();
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    gl.AttachShader(id, shader);
    gl.DeleteShader(shader);  // goes with the program, to which it is attached

    GLint good = GL_FALSE;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == GL_FALSE) {
      std::string log(kLogLength, '\0');
      gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
      log = logText(log);
      return makeError((sources.folder / placeOf(log, *stage)).string(),
                       "the shader does not compile:\n" + log);
    }
  }
  gl.LinkProgram(id);
  GLint good = GL_FALSE;
  gl.GetProgramiv(id, GL_LINK_STATUS, &good);
  if (good == GL_FALSE) {
    std::string log(kLogLength, '\0');
    gl.GetProgramInfoLog(id, static_cast<GLsizei>(log.size()), nullptr, log.data());
    return makeError(vertexName + " and " + fragmentName,
                     "the shaders do not fit together:\n" + logText(log));
  }
  return program;
}

}  // namespace lightvane
