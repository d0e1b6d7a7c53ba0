#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels/panel_io.h"
#include "app/panels/value_scale.h"

namespace lightvane {

// What the panel of parameters says beside their values. Pure; read off the list of fields.

/// Fields that are shown together: those whose keys begin alike.
struct ParameterGroup {
  std::string prefix;  ///< "ilv"
  std::string title;
};

/// The groups of all parameters, in the order in which they are shown.
const std::vector<ParameterGroup>& parameterGroups();
/// The prefix of the group that a key belongs to.
std::string_view groupOf(std::string_view key);

/// Why a group, or a field, is of no effect as things are; empty where it has one. `scene` may be null.
std::string whyGroupIsIdle(std::string_view group, const Parameters& parameters, const SceneSummary* scene);
std::string whyFieldIsIdle(std::string_view key, const Parameters& parameters, const SceneSummary* scene);

/// What must be told of a field before it is changed.
struct FieldFacts {
  Field field;
  std::string range;  ///< "1 to 1000"
  std::string defaultValue;
  std::string startValue;  ///< the scene's
};
/// As lines for a tooltip: what it does; key; range; default and the scene's value; the paper's section.
std::vector<std::string> tooltipLines(const FieldFacts& facts);
/// What a change of the field costs, as a sentence: what its ChangeCost says, or where that is of light
/// vectors alone and the field is not, what really is done.
std::string costText(const Field& field);
/// What setting the field to make it `candidate` would take, for a line of its tooltip: vectors, or where the
/// method has none, its own work. Empty where it is not known.
std::string changeText(std::string_view key, const Parameters& candidate,
                       const std::optional<ChangeEstimate>& estimate);
/// "about 1,200 new vectors; 850 ILVs become stale", "no new vector"; empty where it is not known.
std::string estimateText(const std::optional<ChangeEstimate>& estimate);
/// Of which kinds vectors become stale; of none where it is not known.
StaleKinds staleKinds(const std::optional<ChangeEstimate>& estimate);

/// Whether letters of the filter are found in a field's key, label or help: each of its words, in any case.
bool matchesFilter(const Field& field, std::string_view filter);

/// The unit that a length is shown in.
enum class LengthUnit { Percent, Scene, Metre };
/// "%", "cm", "m"
std::string lengthUnitText(LengthUnit unit, const SceneSummary* scene);
/// A length as a number of that unit, and back. A percentage makes a relative length, others one in metres.
double lengthIn(LengthUnit unit, const Length& length, const SceneSummary* scene);
Length lengthOf(double number, LengthUnit unit, const SceneSummary* scene);
/// What was typed for a length as setParameter reads it: with a unit of its own, or in `unit`.
std::string canonicalLength(std::string_view typed, LengthUnit unit, const SceneSummary* scene);

}  // namespace lightvane
