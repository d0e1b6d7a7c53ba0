#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/image.h"

namespace lightvane {

/// How a picture of linear radiance becomes 8 bits. Used by the formats that cannot hold floats only.
struct DisplayTransform {
  float exposureStops = 0.0f;  ///< radiance is multiplied by 2^exposureStops before it is encoded
};

/// The extensions that writeImage and readImage know, with their dots: ".exr", ".hdr", ".pfm", ".png".
const std::vector<std::string>& imageExtensions();

/// Tells before any work is done whether `path` could be written: known extension, existing folder, not a folder
/// itself, permission to create the file.
Expected<void> checkWritableImage(const std::filesystem::path& path);

/// Writes `image` in the format of the path's extension, atomically. `.exr` holds every channel as 32-bit floats or
/// integers; `.hdr`, `.pfm` and `.png` hold R, G, B. Each carries the metadata: EXR as string attributes, PNG as tEXt
/// (sRGB-tagged), HDR as header lines "# key=value", PFM as "# key=value" lines after the pixels, where readers do
/// not look.
Expected<void> writeImage(const std::filesystem::path& path, const LayeredImage& image,
                          const DisplayTransform& display = {});

/// Reads a picture by its extension. PNG is decoded to linear light; metadata comes back where it was written by us.
/// Refuses with a clear message: missing, damaged or truncated files, and sizes beyond 1 GiB of pixels.
Expected<LayeredImage> readImage(const std::filesystem::path& path);

}  // namespace lightvane
