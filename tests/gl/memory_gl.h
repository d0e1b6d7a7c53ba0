#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "app/gl/gl_functions.h"

namespace lightvane {

/// OpenGL 3.3 core that draws in memory, without a display: OSMesa. Current on the thread that made it.
class MemoryGl {
 public:
  MemoryGl();
  ~MemoryGl();
  MemoryGl(const MemoryGl&) = delete;
  MemoryGl& operator=(const MemoryGl&) = delete;

  const Gl& gl() const { return *gl_; }

  /// What OSMesa finds; the context's own.
  static Gl::Function find(const char* name);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
  std::unique_ptr<const Gl> gl_;
};

/// A test with a context; fails where it leaves a GL error behind.
class GlTest : public testing::Test {
 protected:
  const Gl& gl() const { return memory_.gl(); }
  void TearDown() override;

 private:
  MemoryGl memory_;
};

}  // namespace lightvane
