#pragma once

#include <filesystem>
#include <string>

#include "app/gl/gl_functions.h"
#include "core/base/math.h"

namespace lightvane {

/// Where shaders come from: built into the program, or a folder that is read anew each time, so that a shader
/// can be worked on while the program runs. The build embeds the folder `shaders`.
struct ShaderSources {
  std::filesystem::path folder;  ///< empty: built in

  /// The text of one file, "picture.frag".
  Expected<std::string> read(const std::string& name) const;
};

/// A linked vertex and fragment shader. On the GL thread.
class ShaderProgram {
 public:
  /// Compiles and links. A line `#include "file.glsl"` of a stage stands for that file's text; what is
  /// included includes nothing. Errors give the file and line that the driver names, and its whole log.
  static Expected<ShaderProgram> build(const Gl& gl, const ShaderSources& sources,
                                       const std::string& vertexName, const std::string& fragmentName);

  void use() const { gl_->UseProgram(program_.id()); }

  // Uniforms of the program in use. A name that the linker found no use for is passed over, as GL does: a
  // shader that is being worked on may ignore any of them.
  void set(const char* name, int value) const { gl_->Uniform1i(location(name), value); }
  void set(const char* name, float value) const { gl_->Uniform1f(location(name), value); }
  void set(const char* name, const Vec2& value) const { gl_->Uniform2f(location(name), value.x, value.y); }
  void set(const char* name, const Vec3& value) const {
    gl_->Uniform3f(location(name), value.x, value.y, value.z);
  }
  void set(const char* name, const glm::mat4& value) const {
    gl_->UniformMatrix4fv(location(name), 1, GL_FALSE, &value[0][0]);
  }

 private:
  explicit ShaderProgram(const Gl& gl) : gl_(&gl), program_(gl) {}
  GLint location(const char* name) const { return gl_->GetUniformLocation(program_.id(), name); }

  const Gl* gl_;
  GlProgram program_;
};

}  // namespace lightvane
