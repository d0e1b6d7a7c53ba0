#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/measure/sweep.h"
#include "core/render/parameters.h"

namespace lightvane {

/// A parameter by which the refined rules depart from the paper: docs/method.md, "What we changed".
struct Correction {
  std::string key;
  std::string printed, refined;  ///< its values, as --set has them
  std::string paper;             ///< section or equation; empty where the paper has nothing of the kind
  std::string corrects;          ///< what is wrong as printed, in a few words

  /// The layer of a picture that it is about: "direct" or "indirect".
  std::string_view layer() const { return key.starts_with("dlv.") ? "direct" : "indirect"; }
};

/// All of them, those of direct light first. Together their printed values are the rules `printed`
/// (core/vectors/parameters.h) without the row order, and with a level of recursion.
std::span<const Correction> corrections();

/// What is made of the corrections for one point of a study: each is measured alone, from both ends.
enum class StudyRole {
  All,      ///< all are made: the refined rules
  None,     ///< none is: everything as printed, by the same passes
  Without,  ///< all but one
  Alone     ///< one only
};

/// How much work a point is allowed, so that errors can be told at equal times, too.
enum class StudyEffort { Coarse, Usual, Fine };

struct StudyPoint {
  StudyRole role = StudyRole::All;
  const Correction* correction = nullptr;  ///< of Without and Alone
  StudyEffort effort = StudyEffort::Usual;

  /// "without ilv.weight, coarse": the names of all points differ.
  std::string label() const;
  /// A value for every correction.
  SweepSettings settings() const;
};

/// The points of one scene: all, none, and each correction taken back and made alone, with every effort. In a
/// scene that keeps no DLVs the corrections of these change nothing, and have no points.
std::vector<StudyPoint> studyPoints(bool hasDirectVectors);

/// Changes the cells of a gather and ilv.radius_scale by the factors by which the presets `draft` and `fine`
/// differ from `balanced` under the refined rules. Nothing else: what the corrections set stays.
void applyEffort(Parameters& parameters, StudyEffort effort);

}  // namespace lightvane
