#pragma once

#include <string>

#include "app/gl/gl_functions.h"
#include "core/image/image.h"
#include "core/inspect/color_map.h"

namespace lightvane {

/// What a golden picture shows.
enum class GoldenOf {
  Values,    ///< written down in the test
  Rendering  ///< whose last bits are the compiler's, and may turn a threshold here and there
};

/// Holds a picture against tests/gl/golden/`name`.png: to the byte under the Mesa that drew these, within a
/// tolerance under any other OpenGL, and where it shows a rendering. A failure leaves `name`.actual.png and
/// `name`.difference.png in the build folder and names them.
///
/// LIGHTVANE_WRITE_GOLDEN=1 in the environment writes the pictures anew instead: look at them before you
/// commit them.
void expectGolden(const Gl& gl, const Image<Color8>& actual, const std::string& name,
                  GoldenOf content = GoldenOf::Values);

/// The same for what is drawn over a picture, `bare`: the tolerance goes by the pixels that the golden
/// picture differs from that one in, not by those of the picture beneath, of which an overlay may cover a
/// hundredth.
void expectGoldenOverlay(const Gl& gl, const Image<Color8>& actual, const Image<Color8>& bare,
                         const std::string& name, GoldenOf content = GoldenOf::Values);

}  // namespace lightvane
