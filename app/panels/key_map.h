#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels/actions.h"
#include "app/panels/key_chord.h"
#include "core/base/error.h"

namespace lightvane {

/// Keys that are held to fly through the scene; no action may have one of them alone.
inline constexpr std::string_view kFlightKeys = "WASDQE";

/// Which keys do what.
class KeyMap {
 public:
  /// The keys of the table of actions.
  KeyMap();

  std::optional<ActionId> actionFor(const KeyChord& chord) const;
  const std::vector<KeyChord>& chordsOf(ActionId id) const { return chords_[static_cast<std::size_t>(id)]; }
  /// What menus show: the first chord, or nothing.
  std::string textOf(ActionId id) const;
  /// All chords, separated by ", ".
  std::string allTextOf(ActionId id) const;

  void set(ActionId id, std::vector<KeyChord> chords) {
    chords_[static_cast<std::size_t>(id)] = std::move(chords);
  }

 private:
  std::array<std::vector<KeyChord>, kActionCount> chords_;
};

/// What a file of keys says. Lines that could not be followed leave their actions at the default.
struct KeyFile {
  KeyMap keys;
  std::vector<Error> errors;
};

/// Reads lines of TOML's simplest kind: `edit.redo = "Ctrl+Shift+Z Ctrl+Y"`; "" takes an action's keys away,
/// # begins a comment. Errors name `file:line`: an unknown action (with the nearest), a chord that is none,
/// and two actions with the same keys.
KeyFile parseKeyFile(std::string_view text, const std::string& file);

/// All actions and their keys as such a file, with what each does.
std::string keyFileText(const KeyMap& keys);

}  // namespace lightvane
