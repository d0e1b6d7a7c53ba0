#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lightvane {

/// How much is measured.
struct TableOptions {
  int size = 512;                    ///< of the pictures, in pixels
  int rounds = 5;                    ///< in which things take turns
  int referenceSamples = 512;        ///< paths a pixel of each half of the reference
  std::size_t floorPoints = 2000;    ///< of the tracing stage
  std::size_t tracedRays = 500'000;  ///< of a kind and a round, likewise
  std::vector<int> naiveSamples = {32, 128, 512, 1024};
  std::filesystem::path referenceFolder = LIGHTVANE_REFERENCE_FOLDER;

  /// Small enough for a test that every row can be made; its numbers mean nothing.
  static TableOptions quick();
};

/// What docs/performance.md states, as Markdown; says on stderr what it is at. Minutes, and some more the
/// first time, for the references.
std::string performanceTable(const TableOptions& options);

/// Renders a scene's picture as the preset `balanced` does, on all cores, and returns the most memory that
/// this process ever held, in MB of 10^6 bytes.
double peakMegabytes(const std::string& sceneName, int size);

}  // namespace lightvane
