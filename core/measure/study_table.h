#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/measure/sweep.h"

namespace lightvane {

// What studies say, as text: many scenes in one table.

/// Of studies that look at each light of a scene by itself: the one that the scene was lit by.
struct StudiedLight {
  std::string name, kind;  ///< empty where the scene had no light at all

  bool isNone() const { return kind.empty(); }
};

/// One scene's study, as far as it is done: its points are told apart by their labels.
struct StudiedScene {
  std::string name;
  Sweep sweep;
  std::optional<StudiedLight> light = {};  ///< none: lit by all that it has

  /// Null where it is not done.
  const SweepPoint* pointNamed(std::string_view label) const;
};

/// Cells as text; the first row is the head, the first column names the rows.
struct StudyTable {
  std::string title, text;
  std::vector<std::vector<std::string>> rows;
};

/// What a cell says where there is no number.
inline constexpr const char* kNoStudyValue = "–";

/// A ratio with three digits: "1.30", "12.5", "380", "1.6e+04".
std::string studyNumber(double value);
/// "6.1 ± 0.32": the mean of a metric over the seeds, times `scale`, and their standard deviation where there
/// are several. `point` may be null.
std::string studySpreadCell(const SweepPoint* point, const std::string& metric, double scale);
/// Likewise of CPU time, in seconds.
std::string studyTimeCell(const SweepPoint* point);

/// Of ratios, one a seed or one a scene: their geometric mean, and the interval that holds its true value
/// with a certainty of 95 % (Student's t of their logarithms).
struct MeanRatio {
  double mean = 1.0;
  std::optional<double> low, high;  ///< nothing of one ratio
};
/// The ratios must be above 0 and finite, and one at least.
MeanRatio meanRatio(std::span<const double> ratios);
/// "1.30 [1.10, 1.54]".
std::string studyRatioCell(const MeanRatio& ratio);

/// As Markdown, the titles as headings of the second level.
std::string studyMarkdown(std::span<const StudyTable> tables);

}  // namespace lightvane
