#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include <GL/glcorearb.h>

#include "core/base/error.h"

namespace lightvane {

// What app/gl calls of OpenGL 3.3, once by the name in its type (PFNGL...PROC) and once by its own. The one
// list that the table below, its loading and its message are made of.
#define LIGHTVANE_GL_FUNCTIONS(X)                     \
  X(ACTIVETEXTURE, ActiveTexture)                     \
  X(ATTACHSHADER, AttachShader)                       \
  X(BINDBUFFER, BindBuffer)                           \
  X(BINDFRAMEBUFFER, BindFramebuffer)                 \
  X(BINDTEXTURE, BindTexture)                         \
  X(BINDVERTEXARRAY, BindVertexArray)                 \
  X(BLENDFUNCSEPARATE, BlendFuncSeparate)             \
  X(BLITFRAMEBUFFER, BlitFramebuffer)                 \
  X(BUFFERDATA, BufferData)                           \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus)   \
  X(CLEAR, Clear)                                     \
  X(CLEARCOLOR, ClearColor)                           \
  X(COMPILESHADER, CompileShader)                     \
  X(CREATEPROGRAM, CreateProgram)                     \
  X(CREATESHADER, CreateShader)                       \
  X(DELETEBUFFERS, DeleteBuffers)                     \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers)           \
  X(DELETEPROGRAM, DeleteProgram)                     \
  X(DELETESHADER, DeleteShader)                       \
  X(DELETETEXTURES, DeleteTextures)                   \
  X(DELETEVERTEXARRAYS, DeleteVertexArrays)           \
  X(DISABLE, Disable)                                 \
  X(DRAWARRAYS, DrawArrays)                           \
  X(DRAWARRAYSINSTANCED, DrawArraysInstanced)         \
  X(DRAWELEMENTSBASEVERTEX, DrawElementsBaseVertex)   \
  X(ENABLE, Enable)                                   \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
  X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D)       \
  X(GENBUFFERS, GenBuffers)                           \
  X(GENFRAMEBUFFERS, GenFramebuffers)                 \
  X(GENTEXTURES, GenTextures)                         \
  X(GENVERTEXARRAYS, GenVertexArrays)                 \
  X(GETERROR, GetError)                               \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog)             \
  X(GETPROGRAMIV, GetProgramiv)                       \
  X(GETSHADERINFOLOG, GetShaderInfoLog)               \
  X(GETSHADERIV, GetShaderiv)                         \
  X(GETSTRING, GetString)                             \
  X(GETUNIFORMLOCATION, GetUniformLocation)           \
  X(LINKPROGRAM, LinkProgram)                         \
  X(PIXELSTOREI, PixelStorei)                         \
  X(READPIXELS, ReadPixels)                           \
  X(SCISSOR, Scissor)                                 \
  X(SHADERSOURCE, ShaderSource)                       \
  X(TEXIMAGE2D, TexImage2D)                           \
  X(TEXPARAMETERI, TexParameteri)                     \
  X(TEXSUBIMAGE2D, TexSubImage2D)                     \
  X(UNIFORM1F, Uniform1f)                             \
  X(UNIFORM1I, Uniform1i)                             \
  X(UNIFORM2F, Uniform2f)                             \
  X(UNIFORM3F, Uniform3f)                             \
  X(UNIFORMMATRIX4FV, UniformMatrix4fv)               \
  X(USEPROGRAM, UseProgram)                           \
  X(VERTEXATTRIBDIVISOR, VertexAttribDivisor)         \
  X(VERTEXATTRIBIPOINTER, VertexAttribIPointer)       \
  X(VERTEXATTRIBPOINTER, VertexAttribPointer)         \
  X(VIEWPORT, Viewport)

/// OpenGL as a value: no loader library, since those that exist find their functions by way of a window
/// system and cannot draw in memory. Passed by reference to whatever draws; must outlive every object made
/// with it.
///
/// All of app/gl runs on the thread on which the context is current.
struct Gl {
  /// Finds a function by its name ("glClear"); null where there is none. That of GLFW, EGL or OSMesa.
  using Function = void (*)();
  using GetFunction = std::function<Function(const char* name)>;

  /// The functions of the context that is current. An error names the first one that is missing.
  static Expected<Gl> load(const GetFunction& getFunction);

#define LIGHTVANE_GL_MEMBER(TYPE, Name) PFNGL##TYPE##PROC Name = nullptr;
  LIGHTVANE_GL_FUNCTIONS(LIGHTVANE_GL_MEMBER)
#undef LIGHTVANE_GL_MEMBER
};

/// Owns one GL object; empty when made without a Gl. Made and destroyed while the context is current.
template <class Kind>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(const Gl& gl) : gl_(&gl), id_(Kind::make(gl)) {}
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;
  GlObject(GlObject&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlObject() {
    if (id_ != 0) Kind::remove(*gl_, id_);
  }

  GLuint id() const { return id_; }

 private:
  const Gl* gl_ = nullptr;
  GLuint id_ = 0;
};

#define LIGHTVANE_GL_KIND(Kind, Gen, Delete)                           \
  struct Kind {                                                        \
    static GLuint make(const Gl& gl) {                                 \
      GLuint id = 0;                                                   \
      gl.Gen(1, &id);                                                  \
      return id;                                                       \
    }                                                                  \
    static void remove(const Gl& gl, GLuint id) { gl.Delete(1, &id); } \
  };
LIGHTVANE_GL_KIND(GlTextureKind, GenTextures, DeleteTextures)
LIGHTVANE_GL_KIND(GlBufferKind, GenBuffers, DeleteBuffers)
LIGHTVANE_GL_KIND(GlVertexArrayKind, GenVertexArrays, DeleteVertexArrays)
LIGHTVANE_GL_KIND(GlFramebufferKind, GenFramebuffers, DeleteFramebuffers)
#undef LIGHTVANE_GL_KIND
struct GlProgramKind {
  static GLuint make(const Gl& gl) { return gl.CreateProgram(); }
  static void remove(const Gl& gl, GLuint id) { gl.DeleteProgram(id); }
};

using GlTexture = GlObject<GlTextureKind>;
using GlBuffer = GlObject<GlBufferKind>;
using GlVertexArray = GlObject<GlVertexArrayKind>;
using GlFramebuffer = GlObject<GlFramebufferKind>;
using GlProgram = GlObject<GlProgramKind>;

/// GL's way to say where in the bound buffer something begins.
inline const void* inBuffer(std::size_t offset) {
  return reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr): never followed
}

/// A texture that is read by texelFetch or texture(), without mipmaps; no pixels yet. Left bound.
GlTexture makeTexture(const Gl& gl, GLint filter);

}  // namespace lightvane
