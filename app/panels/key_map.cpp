#include "app/panels/key_map.h"

#include <algorithm>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/base/text.h"

namespace lightvane {
namespace {

/// One line `action = "chords"` that was understood.
struct Assignment {
  ActionId action;
  std::vector<KeyChord> chords;
  std::string where;
};

bool isFlightKey(const KeyChord& chord) {
  return !chord.ctrl && !chord.alt && !chord.shift &&
         std::any_of(kFlightKeys.begin(), kFlightKeys.end(), [&](char c) { return chord.key == keyOf(c); });
}

/// Chords separated by spaces.
Expected<std::vector<KeyChord>> parseChords(std::string_view text, const std::string& where) {
  std::vector<KeyChord> chords;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const std::optional<KeyChord> chord = parseChord(word);
    if (!chord) {
      return makeError(where, fmt::format("'{}' is no key", word),
                       "keys are written as Ctrl+Shift+P, F5, Space or [");
    }
    if (isFlightKey(*chord)) {
      return makeError(where, fmt::format("{} is held to fly through the scene", formatChord(*chord)),
                       "add Ctrl, Alt or Shift to it");
    }
    chords.push_back(*chord);
  }
  return chords;
}

Expected<ActionId> parseAction(std::string_view name, const std::string& where) {
  if (const auto action = actionNamed(name)) return *action;
  std::vector<std::string> names;
  for (const ActionInfo& info : actionTable()) names.emplace_back(info.name);
  return makeError(where, fmt::format("there is no action '{}'", name), suggestion(name, names));
}

/// The text between the quotes that a value stands in; nothing else may follow but a comment.
std::optional<std::string_view> quoted(std::string_view value) {
  if (value.size() < 2 || value.front() != '"') return std::nullopt;
  const std::size_t end = value.find('"', 1);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view rest = trimmed(value.substr(end + 1));
  if (!rest.empty() && rest.front() != '#') return std::nullopt;
  return value.substr(1, end - 1);
}

Expected<Assignment> parseLine(std::string_view line, const std::string& where) {
  const std::size_t equal = line.find('=');
  const std::optional<std::string_view> value =
      equal == std::string_view::npos ? std::nullopt : quoted(trimmed(line.substr(equal + 1)));
  if (!value) {
    return makeError(where, fmt::format("'{}' is not of the form action = \"keys\"", line),
                     "as in edit.undo = \"Ctrl+Z\"");
  }
  const Expected<ActionId> action = parseAction(trimmed(line.substr(0, equal)), where);
  if (!action) return tl::unexpected(action.error());
  Expected<std::vector<KeyChord>> chords = parseChords(*value, where);
  if (!chords) return tl::unexpected(chords.error());
  return Assignment{*action, std::move(*chords), where};
}

/// A chord that two actions have; the second is one of `assigned` where either is.
struct Conflict {
  KeyChord chord;
  ActionId other;
  std::size_t assignment;  ///< the one to be given up
};

std::optional<Conflict> findConflict(const KeyMap& keys, const std::vector<Assignment>& assignments) {
  std::map<KeyChord, ActionId> owners;
  for (const ActionInfo& info : actionTable()) {
    for (const KeyChord& chord : keys.chordsOf(info.id)) {
      const auto [owner, isFirst] = owners.emplace(chord, info.id);
      if (isFirst || owner->second == info.id) continue;
      // The later line gives way.
      for (std::size_t i = assignments.size(); i-- > 0;) {
        const ActionId action = assignments[i].action;
        if (action == info.id) return Conflict{chord, owner->second, i};
        if (action == owner->second) return Conflict{chord, info.id, i};
      }
    }
  }
  return std::nullopt;
}

KeyMap keysWith(const std::vector<Assignment>& assignments) {
  KeyMap keys;
  for (const Assignment& assignment : assignments) keys.set(assignment.action, assignment.chords);
  return keys;
}

/// Takes a line out that gives an action the keys of another; false where there is none.
bool giveUpOne(std::vector<Assignment>& assignments, std::vector<Error>& errors) {
  const std::optional<Conflict> conflict = findConflict(keysWith(assignments), assignments);
  if (!conflict) return false;
  const Assignment& lost = assignments[conflict->assignment];
  errors.push_back(
      Error{lost.where,
            fmt::format("{} would be both {} and {}", formatChord(conflict->chord),
                        actionInfo(lost.action).name, actionInfo(conflict->other).name),
            fmt::format("give {} other keys in a line of its own", actionInfo(conflict->other).name)});
  assignments.erase(assignments.begin() + static_cast<std::ptrdiff_t>(conflict->assignment));
  return true;
}

}  // namespace

KeyMap::KeyMap() {
  for (const ActionInfo& info : actionTable()) {
    Expected<std::vector<KeyChord>> chords = parseChords(info.keys, info.name);
    LV_CHECK(chords.has_value(), "the default keys of {}", info.name);
    set(info.id, std::move(*chords));
  }
}

std::optional<ActionId> KeyMap::actionFor(const KeyChord& chord) const {
  for (std::size_t i = 0; i < chords_.size(); ++i) {
    if (std::find(chords_[i].begin(), chords_[i].end(), chord) != chords_[i].end()) {
      return static_cast<ActionId>(i);
    }
  }
  return std::nullopt;
}

std::string KeyMap::textOf(ActionId id) const {
  const std::vector<KeyChord>& chords = chordsOf(id);
  return chords.empty() ? std::string() : formatChord(chords.front());
}

std::string KeyMap::allTextOf(ActionId id) const {
  std::string text;
  for (const KeyChord& chord : chordsOf(id)) {
    if (!text.empty()) text += ", ";
    text += formatChord(chord);
  }
  return text;
}

KeyFile parseKeyFile(std::string_view text, const std::string& file) {
  KeyFile result;
  std::vector<Assignment> assignments;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string whole; std::getline(lines, whole);) {
    ++number;
    const std::string_view line = trimmed(whole);
    if (line.empty() || line.front() == '#') continue;
    Expected<Assignment> assignment = parseLine(line, fmt::format("{}:{}", file, number));
    if (assignment) {
      assignments.push_back(std::move(*assignment));
    } else {
      result.errors.push_back(assignment.error());
    }
  }
  // A line that is given up brings its action's default back, which may be in another's way: look again.
  // Ends, because each round takes one line, and the defaults are free of conflicts.
  while (giveUpOne(assignments, result.errors)) {
  }
  result.keys = keysWith(assignments);
  return result;
}

std::string keyFileText(const KeyMap& keys) {
  std::string text =
      "# Keys of Lightvane's window: action = \"keys\". Several keys are separated by spaces, \"\" takes all "
      "away.\n"
      "# Ctrl, Alt and Shift are held with a letter, digit or sign, or with F1 to F12, Space, Enter, Tab, "
      "Backspace,\n"
      "# Insert, Delete, Home, End, PageUp, PageDown, Left, Right, Up or Down.\n"
      "# W, A, S, D, Q and E alone are held to fly.\n";
  std::optional<ActionGroup> group;
  for (const ActionInfo& info : actionTable()) {
    if (group != info.group) {
      group = info.group;
      text += fmt::format("\n# {}\n", kActionGroupNames[static_cast<std::size_t>(info.group)]);
    }
    std::string chords;
    for (const KeyChord& chord : keys.chordsOf(info.id)) {
      if (!chords.empty()) chords += ' ';
      chords += formatChord(chord);
    }
    text += fmt::format("{} = \"{}\"  # {}\n", info.name, chords, info.help);
  }
  return text;
}

}  // namespace lightvane
