#include "app/gl/gl_functions.h"

#include <string>

namespace lightvane {

Expected<Gl> Gl::load(const GetFunction& getFunction) {
  struct Entry {
    const char* name;
    void (*set)(Gl& gl, Function function);
  };
#define LIGHTVANE_GL_ENTRY(TYPE, Name) \
  {"gl" #Name,                         \
   [](Gl& table, Function function) { table.Name = reinterpret_cast<PFNGL##TYPE##PROC>(function); }},
  static constexpr Entry kEntries[] = {LIGHTVANE_GL_FUNCTIONS(LIGHTVANE_GL_ENTRY)};
#undef LIGHTVANE_GL_ENTRY

  Gl gl;
  for (const Entry& entry : kEntries) {
    const Function function = getFunction(entry.name);
    if (function == nullptr) {
      return makeError("OpenGL", std::string("this driver has no function ") + entry.name,
                       "Lightvane draws with OpenGL 3.3; a newer driver or Mesa's llvmpipe has it");
    }
    entry.set(gl, function);
  }
  return gl;
}

GlTexture makeTexture(const Gl& gl, GLint filter) {
  GlTexture texture(gl);
  gl.BindTexture(GL_TEXTURE_2D, texture.id());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  return texture;
}

}  // namespace lightvane
