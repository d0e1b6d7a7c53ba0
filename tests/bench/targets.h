#pragma once

#include <filesystem>
#include <string>

namespace lightvane {

struct TargetOptions {
  double scale = 1.0;             ///< of the pictures' width and height
  int rounds = 5;                 ///< in which the pictures and the unit take turns
  int referenceSamples = 65'536;  ///< of the hemisphere above every point that the error is measured at
  std::filesystem::path referenceFolder = LIGHTVANE_REFERENCE_FOLDER;

  /// Small enough for a test that every row can be made; its numbers mean nothing.
  static TargetOptions quick();
};

/// What whole pictures cost in units (EmbreeUnit) at the error they have, against what they are to cost; one
/// thread. Markdown; says on stderr what it is at.
///
/// The error is the metric `mrae` of the whole picture, away from edges and lights, on the pixels of
/// pictureSample. They are held against renderings by `naive`, which has no bias, with so many samples that
/// their noise is small; it is told.
std::string targetsTable(const TargetOptions& options);

}  // namespace lightvane
