#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lightvane {

/// The number of single-character insertions, deletions, replacements and swaps of neighbours between two
/// words.
std::size_t editDistance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`, or empty where none is near enough to be what was meant.
std::string nearestWord(std::string_view word, std::span<const std::string> candidates);

/// "did you mean X?", or empty: the hint of an error about an unknown word.
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

/// The Latin letters A to Z in lower case, all other bytes as they are.
std::string lowered(std::string_view text);

/// Without the spaces, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view text);

/// With '?' for what a terminal would take for commands: names out of files have anything. Lines stay lines.
std::string withoutCommands(std::string text);

/// "a, b or c"
std::string listWords(std::span<const std::string> words);

}  // namespace lightvane
