#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lightvane {

/// How much is measured.
struct CorrectionOptions {
  int size = 256;              ///< of the pictures, in pixels
  int rounds = 3;              ///< with different seeds
  int referenceSamples = 512;  ///< paths a pixel of each half of the reference
  std::vector<std::string> indirectScenes = {"cornell", "cornell-mirror", "cornell-glossy", "two-rooms"};
  std::vector<std::string> directScenes = {"cornell", "cornell-glossy"};
  std::filesystem::path referenceFolder = LIGHTVANE_REFERENCE_FOLDER;

  /// Small enough for a test that every row can be made; its numbers mean nothing.
  static CorrectionOptions quick();
};

/// What docs/method.md states, as Markdown: for each correction of the paper, what the refined rules lose on
/// the shipped scenes when it alone is taken back.
std::string correctionsTable(const CorrectionOptions& options);

}  // namespace lightvane
