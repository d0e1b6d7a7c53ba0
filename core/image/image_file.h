#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/image/image.h"

namespace lightvane {

/// The extensions that writeImage knows, with their dots: ".exr", ".hdr", ".pfm", ".png". readImage knows
/// ".jpg" and ".jpeg", too.
const std::vector<std::string>& imageExtensions();

/// Whether files of this ending (".png") hold what a screen shows, not radiance.
bool isForScreens(std::string_view ending);

/// Tells before any work is done whether `path` could be written: known extension, existing folder, not a
/// folder itself, permission to create the file. Leaves no file behind and an existing one as it is.
Expected<void> checkWritableImage(const std::filesystem::path& path);

/// Writes `image` in the format of the path's extension (in either case), atomically.
///
/// - `.exr`: all channels as 32-bit floats or integers, every bit pattern (NaN and infinity too);
///   metadata as string attributes "lightvane:key".
/// - `.pfm`: R, G, B, every bit pattern; metadata as lines "# key=value" after the pixels, where
///   readers do not look.
/// - `.hdr`: R, G, B as RGBE, to 1/256 of the pixel's largest component from 2^-128 to 2^127; NaN and
///   negative values become 0, too large ones the largest; metadata as lines "# key=value" of the header.
/// - `.png`: R, G, B as 8 bits of sRGB and tagged so; NaN and negative values become black, what is brighter
///   than 1 white; metadata as tEXt, or iTXt where it is not ASCII.
///
/// The bytes depend on `image` alone. May be called from any thread. Errors: those of
/// checkWritableImage, a full disk, no R, G, B for a format that holds nothing else. A picture without
/// pixels or channels, a channel of another size and a metadata key that breaks its rules (image.h) are
/// broken invariants.
Expected<void> writeImage(const std::filesystem::path& path, const LayeredImage& image);

/// The bytes of the file that writeImage would write for this extension (".png"), with the same errors but
/// for those of the disk.
Expected<std::string> imageBytes(const std::string& extension, const LayeredImage& image);

/// Reads a picture by its extension; metadata comes back where it was written by us. Always has R, G, B, but
/// for an OpenEXR file without them; grey pictures have them equal.
///
/// PNG of every depth and kind is decoded to linear light (by sRGB: its gAMA chunk is not used);
/// its transparency becomes channel "A", by which the colour is not multiplied. JPEG is decoded by sRGB. Half
/// floats widen. HDR values are divided by the file's EXPOSURE, PFM values multiplied by its scale. An
/// OpenEXR picture is its data window.
///
/// May be called from any thread. Refuses with a clear message: missing, damaged or truncated files, sizes
/// beyond 4 GiB of pixels, OpenEXR with several parts, deep pixels or subsampled channels, Radiance in XYZ or
/// column order. Throws LoadStopped as `watch` says.
Expected<LayeredImage> readImage(const std::filesystem::path& path, LoadWatch& watch = LoadWatch::none());

/// As readImage, of a PNG or JPEG file's bytes that are in memory already; `where` is what messages call
/// them.
Expected<LayeredImage> readImageBytes(std::string_view bytes, const std::string& where,
                                      LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
