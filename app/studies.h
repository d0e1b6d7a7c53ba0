#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/measure/study_table.h"

namespace lightvane {

class SweepWork;

/// What a study renders of a scene. Of EachLight every light is a work of its own, by itself, and so is the
/// scene without any; their references are sampled direct light in place of traced paths.
enum class StudyLighting { AllLights, EachLight };

/// What `lightvane sweep --study NAME` can measure. A new study is a row of the table in studies.cpp; its
/// points and what it says are core/measure's.
struct Study {
  const char* name;
  const char* tells;  ///< for --help: "what each correction of the paper is worth"
  int seeds;          ///< of each point, without --seeds
  /// Adds the points of one scene, which is loaded. Errors name what asks for what cannot be measured.
  Expected<void> (*plan)(SweepWork& work);
  std::vector<StudyTable> (*tables)(std::span<const StudiedScene> scenes);
  StudyLighting lighting = StudyLighting::AllLights;
};

std::span<const Study> studies();
/// Null where there is none of that name.
const Study* findStudy(std::string_view name);
std::vector<std::string> studyNames();

}  // namespace lightvane
