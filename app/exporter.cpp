#include "app/exporter.h"

#include <exception>
#include <utility>

#include "app/session_file.h"
#include "core/image/image_file.h"
#include "core/inspect/picture_style.h"
#include "core/io/cache_file.h"

namespace lightvane {

namespace fs = std::filesystem;

const std::vector<ExportFormat>& exportFormats() {
  static const std::vector<ExportFormat> formats = {
      {".png", "PNG: the view as it is shown, 8 bits", true},
      {".exr", "OpenEXR: every layer, 32-bit floats, scene units", false},
      {".hdr", "Radiance HDR: the picture, scene units", false},
      {".pfm", "PFM: the picture, 32-bit floats, scene units", false},
      {std::string(kCacheEnding), "Lightvane's cache: all vectors, to go on from", false},
      {".ply", "PLY: all vectors as a point cloud, for other programs", false},
      {std::string(kSessionEnding), "Session: scene, camera, parameters and view", false}};
  return formats;
}

void Exporter::write(const fs::path& path, std::function<Expected<void>()> work,
                     std::optional<Beside> beside) {
  job_.start([path, work = std::move(work), beside = std::move(beside)](const StopFlag&) -> Written {
    const fs::path besidePath = beside ? beside->path : fs::path();
    try {
      const Expected<void> ready = beside ? beside->write() : Expected<void>();
      return {path, besidePath, ready ? work() : ready};
    } catch (const std::exception& broken) {
      return {path, besidePath, makeError(path.string(), broken.what(), "is there enough memory?")};
    }
  });
}

void Exporter::capture(Capture capture, const fs::path& path, std::map<std::string, std::string> metadata,
                       std::optional<Beside> beside) {
  capture_ = WantedCapture{std::move(capture), path, std::move(metadata), std::move(beside)};
}

void Exporter::finish(const Image<Color8>& pixels) {
  if (!capture_) return;
  WantedCapture wanted = *std::move(capture_);
  capture_.reset();
  LayeredImage image = filePicture(pixels);
  image.metadata = std::move(wanted.metadata);
  write(
      wanted.path, [image = std::move(image), path = wanted.path] { return writeImage(path, image); },
      std::move(wanted.beside));
}

}  // namespace lightvane
