#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/image/image.h"

namespace lightvane {

/// The R, G and B of a picture file that a scene uses, linear. An error where it cannot be read, or where a
/// value is not finite, negative or above `most`; `rule` is what the message says of such values.
Expected<std::shared_ptr<const ImageRgb>> loadPixels(const std::filesystem::path& path, float most,
                                                     const std::string& rule);

/// As loadPixels, of what a surface reflects: values in [0, 1].
Expected<std::shared_ptr<const ImageRgb>> loadReflectance(const std::filesystem::path& path);

/// The alpha of a picture file as grey; 1 everywhere where it has none.
Expected<std::shared_ptr<const ImageRgb>> loadAlpha(const std::filesystem::path& path);

/// loadReflectance of the bytes of a PNG or JPEG file; `where` is what messages call them.
Expected<std::shared_ptr<const ImageRgb>> readReflectance(std::string_view bytes, const std::string& where);

/// loadAlpha of the bytes of a PNG or JPEG file.
Expected<std::shared_ptr<const ImageRgb>> readAlpha(std::string_view bytes, const std::string& where);

}  // namespace lightvane
