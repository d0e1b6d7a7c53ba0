#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/measure/sweep.h"

namespace lightvane {

/// The pictures of a sweep's points, no wider than kThumbnailWidth, as addresses that hold them
/// ("data:image/png;base64,..."): so that a page needs no file beside it. Each is read and made once. On one
/// thread.
class Thumbnails {
 public:
  /// Pictures' names are relative to `folder`.
  explicit Thumbnails(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// By name, of those pictures of the sweep that are there and can be read. Cost of a new one: that of
  /// reading it.
  const std::map<std::string, std::string>& of(const Sweep& sweep);

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::string> addresses_;
};

}  // namespace lightvane
