#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/image/image.h"
#include "core/scene/description.h"

namespace lightvane {

/// The R, G and B of a picture file that a scene uses, linear. An error where it cannot be read, or where a
/// value is not finite, negative or above `most`; `rule` is what the message says of such values. Throws
/// LoadStopped as `watch` says, as those below do.
Expected<std::shared_ptr<const ImageRgb>> loadPixels(const std::filesystem::path& path, float most,
                                                     const std::string& rule,
                                                     LoadWatch& watch = LoadWatch::none());

/// The pixels of a texture: what a surface reflects, with values in [0, 1] as loadPixels checks them, or the
/// picture's alpha as grey, 1 everywhere where it has none.
Expected<std::shared_ptr<const ImageRgb>> loadTexels(const std::filesystem::path& path,
                                                     TextureChannel channel = TextureChannel::Color,
                                                     LoadWatch& watch = LoadWatch::none());
/// The same of the bytes of a PNG or JPEG file; `where` is what messages call them.
Expected<std::shared_ptr<const ImageRgb>> readTexels(std::string_view bytes, const std::string& where,
                                                     TextureChannel channel = TextureChannel::Color,
                                                     LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
