#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lightvane {

/// A key by what is printed on it. Letters, digits and signs have the codes of ASCII (upper case), so that
/// window libraries' own codes are easily mapped; others follow.
enum class Key : std::uint16_t {
  None = 0,
  Space = ' ',
  Apostrophe = '\'',
  Comma = ',',
  Minus = '-',
  Period = '.',
  Slash = '/',
  Digit0 = '0',
  Digit9 = '9',
  Semicolon = ';',
  Equal = '=',
  A = 'A',
  Z = 'Z',
  LeftBracket = '[',
  Backslash = '\\',
  RightBracket = ']',
  Grave = '`',
  Escape = 256,
  Enter,
  Tab,
  Backspace,
  Insert,
  Delete,
  Right,
  Left,
  Down,
  Up,
  PageUp,
  PageDown,
  Home,
  End,
  F1 = 290,
  F12 = 301
};

/// The key of a letter or a digit.
constexpr Key keyOf(char character) { return static_cast<Key>(character); }
/// F1 to F12.
constexpr Key functionKey(int number) { return static_cast<Key>(static_cast<int>(Key::F1) + number - 1); }

/// "Ctrl", "F11", "P", "["; empty for a key that has no name here.
std::string keyName(Key key);
std::optional<Key> keyNamed(std::string_view name);

/// A key and what is held with it.
struct KeyChord {
  Key key = Key::None;
  bool ctrl = false;
  bool shift = false;
  bool alt = false;

  auto operator<=>(const KeyChord&) const = default;
};

/// "Ctrl+Shift+P"
std::string formatChord(const KeyChord& chord);
/// Reads what formatChord writes; case and spaces are free. Nothing where a part is no key.
std::optional<KeyChord> parseChord(std::string_view text);

}  // namespace lightvane
