#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/measure/corrections.h"
#include "core/measure/study_table.h"

namespace lightvane {

/// What a picture took, and how far it is from its reference.
struct TimedError {
  double cpuSeconds = 0.0, error = 0.0;
};

struct ErrorAtTime {
  double error = 0.0;
  bool isBeyond = false;  ///< the time is outside of what was measured: by a factor of 2 at most
};

/// The error of a method at this time, by the straight line through what was measured of it, in logarithms:
/// errors fall with a power of the time over so short a range, and noise in one measurement is shared.
/// Nothing where that has fewer than two times, an error that is not above 0 and finite, or no time within a
/// factor of 2. Pure.
std::optional<ErrorAtTime> errorAtTime(std::span<const TimedError> measured, double cpuSeconds);

/// What the study of corrections says: the scenes with all corrections and with none, then what each
/// correction is worth, taken back and made alone, over all scenes and scene by scene. Pure.
std::vector<StudyTable> correctionTables(std::span<const StudiedScene> scenes);

}  // namespace lightvane
