#include "tests/gl/memory_gl.h"

#include <array>
#include <cstdlib>
#include <stdexcept>

#include <GL/osmesa.h>

namespace lightvane {

struct MemoryGl::Context {
  OSMesaContext handle;
  // OSMesa wants a picture of its own to begin with. Nothing is drawn into it: what it gives differs from
  // what a window shows, while framebuffers are the same to the byte.
  std::array<std::uint32_t, 16> unused{};
};

MemoryGl::MemoryGl() : context_(std::make_unique<Context>()) {
  // Mesa draws on this thread: tests run side by side as it is, and the thread sanitizer cannot follow Mesa's
  // own threads. Pictures are the same for any number of them.
  setenv("LP_NUM_THREADS", "0", 1);
  const std::array<int, 11> attributes = {OSMESA_FORMAT,
                                          OSMESA_RGBA,
                                          OSMESA_PROFILE,
                                          OSMESA_CORE_PROFILE,
                                          OSMESA_CONTEXT_MAJOR_VERSION,
                                          3,
                                          OSMESA_CONTEXT_MINOR_VERSION,
                                          3,
                                          0,
                                          0,
                                          0};
  context_->handle = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (context_->handle == nullptr ||
      OSMesaMakeCurrent(context_->handle, context_->unused.data(), GL_UNSIGNED_BYTE, 4, 4) == GL_FALSE) {
    throw std::runtime_error("OSMesa gives no OpenGL 3.3 core context");
  }
  gl_ = std::make_unique<const Gl>(Gl::load(find).value());
}

MemoryGl::~MemoryGl() { OSMesaDestroyContext(context_->handle); }

Gl::Function MemoryGl::find(const char* name) { return OSMesaGetProcAddress(name); }

void GlTest::TearDown() { EXPECT_EQ(gl().GetError(), static_cast<GLenum>(GL_NO_ERROR)); }

}  // namespace lightvane

/// Asked by the leak sanitizer, where a test is built with it. What OSMesaMakeCurrent takes, no call of
/// OSMesa gives back.
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa\n"; }
