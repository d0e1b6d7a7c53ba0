#include "app/gl/gl_functions.h"

namespace lightvane {

Expected<Gl> Gl::load(const GetFunction& getFunction) {
  Gl gl;
#define LIGHTVANE_GL_LOAD(TYPE, Name)                                                              \
  gl.Name = reinterpret_cast<PFNGL##TYPE##PROC>(getFunction("gl" #Name));                          \
  if (gl.Name == nullptr) {                                                                        \
    return makeError("OpenGL", "this driver has no function gl" #Name,                             \
                     "Lightvane draws with OpenGL 3.3; a newer driver or Mesa's llvmpipe has it"); \
  }
  LIGHTVANE_GL_FUNCTIONS(LIGHTVANE_GL_LOAD)
#undef LIGHTVANE_GL_LOAD
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
