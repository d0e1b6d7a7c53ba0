# cmake -DFOLDER=shaders -DOUTPUT=embedded_shaders.cpp -P embed.cmake: the folder's GLSL as a C++ file
# (app/gl/embedded_shaders.h).

file(GLOB shaders "${FOLDER}/*.vert" "${FOLDER}/*.frag" "${FOLDER}/*.glsl")
set(entries "")
foreach(shader ${shaders})
  cmake_path(GET shader FILENAME name)
  file(READ "${shader}" text)
  string(APPEND entries "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()

file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [=[
// Written by shaders/embed.cmake.
#include "app/gl/embedded_shaders.h"

namespace lightvane {
namespace {

constexpr EmbeddedShader kShaders[] = {
@entries@};

}  // namespace

std::span<const EmbeddedShader> embeddedShaders() { return kShaders; }

}  // namespace lightvane
]=])
