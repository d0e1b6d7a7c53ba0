#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/load_watch.h"

namespace lightvane {

// OBJ and MTL files as text. tinyobjloader takes whatever is not a number as 0, and stumbles over what many
// writers leave behind; so a text is tidied and every line is checked before the library reads it.

/// A word of a line, with the column of its first character.
struct TextWord {
  std::string_view text;
  std::size_t column = 0;
};

/// Makes a text easy to read, in place: without a byte order mark, blanks at the end of lines, comments
/// behind the numbers of `v` and `f` lines, and slashes with nothing behind them in those of faces; lines
/// that a backslash continues are one line. Every other line keeps its number.
void tidyObjText(std::string& text, LoadWatch& watch);

/// A finite number that float can hold.
std::optional<double> parseTextNumber(std::string_view text);

/// An error unless at least `count` numbers follow the line's first word.
std::optional<Error> checkTextNumbers(const std::filesystem::path& path, const std::vector<TextWord>& words,
                                      std::size_t line, std::size_t count);

/// "file:line:column"
std::string textPlace(const std::filesystem::path& path, std::size_t line, std::size_t column);

/// The words of a line.
std::vector<TextWord> wordsOfLine(std::string_view line, LoadWatch& watch);

/// All of a line from this word on.
inline std::string_view restOfLine(const TextWord& word, const std::vector<TextWord>& words) {
  return {word.text.data(),
          static_cast<std::size_t>(words.back().text.data() + words.back().text.size() - word.text.data())};
}

/// Calls `body(words, lineNumber)` for each line that holds something but a comment, until it returns an
/// error. Throws LoadStopped as `watch` says.
template <class Body>
std::optional<Error> forEachTextLine(std::string_view text, LoadWatch& watch, const Body& body) {
  constexpr std::size_t kLinesPerLook = 1024;  // a line takes a microsecond or two
  std::size_t lineNumber = 0;
  const std::size_t size = text.size();
  while (!text.empty()) {
    if (lineNumber++ % kLinesPerLook == 0)
      watch.look(1.0 - static_cast<double>(text.size()) / static_cast<double>(size));
    // "\n", "\r\n" and "\r" end a line, as for tinyobjloader.
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::vector<TextWord> words = wordsOfLine(text.substr(0, end), watch);
    if (!words.empty() && words[0].text[0] != '#') {
      if (std::optional<Error> error = body(words, lineNumber)) return error;
    }
    const bool pair = text.substr(end, 2) == "\r\n";
    text.remove_prefix(std::min(text.size(), end + (pair ? 2 : 1)));
  }
  return std::nullopt;
}

/// Statements that were skipped, each once, in the order of their first appearance.
class SkippedStatements {
 public:
  void add(std::string_view statement) {
    if (seen_.emplace(statement).second) list_ += (list_.empty() ? "" : ", ") + std::string(statement);
  }
  bool empty() const { return list_.empty(); }
  const std::string& list() const { return list_; }

 private:
  std::set<std::string, std::less<>> seen_;
  std::string list_;
};

/// What the lines of an OBJ file say beside what tinyobjloader reads.
struct ObjLines {
  std::vector<std::size_t> faces;      ///< the line of every face, in order
  std::vector<std::string> libraries;  ///< what follows each mtllib
  std::vector<std::string> warnings;
};

/// A name without what follows a blank and a #: a comment, as a rule, but names may have that, too.
std::string_view beforeComment(std::string_view name);

/// Checks the lines of a tidied OBJ file. Throws LoadStopped as `watch` says.
Expected<ObjLines> checkObjText(const std::filesystem::path& path, std::string_view text, LoadWatch& watch);

/// The path of a file that an OBJ or MTL file names: with backslashes as the slashes that they were where
/// such files are written, and beside the file where it is an absolute one, which is of another machine.
std::filesystem::path portablePath(std::string_view name);

/// The file of this name or, where there is none, the only one in its folder whose name differs in the case
/// of letters alone, as where no two such files can be; else the path as it is.
std::filesystem::path pathInAnyCase(const std::filesystem::path& path);

}  // namespace lightvane
