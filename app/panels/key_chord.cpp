#include "app/panels/key_chord.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/base/text.h"

namespace lightvane {
namespace {

struct NamedKey {
  Key key;
  std::string_view name;
};

constexpr std::array kNamedKeys{NamedKey{Key::Space, "Space"},
                                NamedKey{Key::Escape, "Esc"},
                                NamedKey{Key::Enter, "Enter"},
                                NamedKey{Key::Tab, "Tab"},
                                NamedKey{Key::Backspace, "Backspace"},
                                NamedKey{Key::Insert, "Insert"},
                                NamedKey{Key::Delete, "Delete"},
                                NamedKey{Key::Right, "Right"},
                                NamedKey{Key::Left, "Left"},
                                NamedKey{Key::Down, "Down"},
                                NamedKey{Key::Up, "Up"},
                                NamedKey{Key::PageUp, "PageUp"},
                                NamedKey{Key::PageDown, "PageDown"},
                                NamedKey{Key::Home, "Home"},
                                NamedKey{Key::End, "End"}};

constexpr std::string_view kSigns = "',-./;=[\\]`";

bool sameWord(std::string_view a, std::string_view b) { return lowered(a) == lowered(b); }

}  // namespace

std::string keyName(Key key) {
  for (const NamedKey& named : kNamedKeys) {
    if (named.key == key) return std::string(named.name);
  }
  if (key >= Key::F1 && key <= Key::F12) {
    return "F" + std::to_string(static_cast<int>(key) - static_cast<int>(Key::F1) + 1);
  }
  const auto code = static_cast<unsigned>(key);
  if (code >= 128) return {};
  const auto c = static_cast<char>(code);
  const bool printed = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       (c != '\0' && kSigns.find(c) != std::string_view::npos);
  return printed ? std::string(1, c) : std::string();
}

std::optional<Key> keyNamed(std::string_view name) {
  for (const NamedKey& named : kNamedKeys) {
    if (sameWord(named.name, name)) return named.key;
  }
  for (int number = 1; number <= 12; ++number) {
    if (sameWord(keyName(functionKey(number)), name)) return functionKey(number);
  }
  if (name.size() != 1) return std::nullopt;
  const Key key = keyOf(static_cast<char>(std::toupper(static_cast<unsigned char>(name.front()))));
  return keyName(key).empty() ? std::nullopt : std::optional(key);
}

std::string formatChord(const KeyChord& chord) {
  std::string text;
  if (chord.ctrl) text += "Ctrl+";
  if (chord.alt) text += "Alt+";
  if (chord.shift) text += "Shift+";
  return text + keyName(chord.key);
}

std::optional<KeyChord> parseChord(std::string_view text) {
  KeyChord chord;
  for (;;) {
    const std::size_t plus = text.find('+');
    const std::string_view part = trimmed(text.substr(0, plus));
    if (plus == std::string_view::npos) {
      const std::optional<Key> key = keyNamed(part);
      if (!key) return std::nullopt;
      chord.key = *key;
      return chord;
    }
    bool* held = sameWord(part, "ctrl")    ? &chord.ctrl
                 : sameWord(part, "shift") ? &chord.shift
                 : sameWord(part, "alt")   ? &chord.alt
                                           : nullptr;
    if (held == nullptr || *held) return std::nullopt;
    *held = true;
    text.remove_prefix(plus + 1);
  }
}

}  // namespace lightvane
