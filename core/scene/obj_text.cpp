#include "core/scene/obj_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/text.h"

namespace lightvane {
namespace {

constexpr std::string_view kBlanks = " \t";
constexpr std::size_t kMostFaceCorners = 4096;  // cutting ears takes their square

/// What is left of a line once it is tidied; `line` has no blanks at its ends.
std::string tidyLine(std::string_view line) {
  std::string tidied;
  const bool isFace = line.size() > 1 && line[0] == 'f' && kBlanks.find(line[1]) != std::string_view::npos;
  const bool hasNumbers = isFace || line.starts_with('v');
  if (hasNumbers) line = line.substr(0, line.find('#'));
  for (const char c : line) {
    const bool endsWord = kBlanks.find(c) != std::string_view::npos;
    while (isFace && endsWord && tidied.ends_with('/')) tidied.pop_back();
    tidied += c;
  }
  while (!tidied.empty() &&
         (kBlanks.find(tidied.back()) != std::string_view::npos || (isFace && tidied.back() == '/')))
    tidied.pop_back();
  return tidied;
}

/// "v", "v/vt", "v//vn" or "v/vt/vn" of whole numbers other than 0.
bool isFaceCorner(std::string_view text) {
  int parts = 0;
  while (true) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const std::string_view part = text.substr(0, slash);
    int index = 0;
    const auto [end, status] = std::from_chars(part.data(), part.data() + part.size(), index);
    const bool isIndex = status == std::errc() && end == part.data() + part.size() && index != 0;
    const bool mayBeEmpty = parts == 1 && slash < text.size();
    if (!isIndex && !(part.empty() && mayBeEmpty)) return false;
    if (++parts > 3) return false;
    if (slash == text.size()) return true;
    text.remove_prefix(slash + 1);
  }
}

std::optional<Error> checkFace(const std::filesystem::path& path, const std::vector<TextWord>& words,
                               std::size_t line) {
  if (words.size() - 1 > kMostFaceCorners) {
    return Error{textPlace(path, line, words[0].column),
                 fmt::format("f: a face of {} corners", words.size() - 1), "cut it into smaller ones"};
  }
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (isFaceCorner(words[i].text)) continue;
    return Error{textPlace(path, line, words[i].column),
                 fmt::format("f: expected v, v/vt, v//vn or v/vt/vn in whole numbers from 1 (or below 0, "
                             "counted back), found \"{}\"",
                             words[i].text),
                 {}};
  }
  return std::nullopt;
}

/// A normal of no number is as good as none, and tinyobjloader makes it one of length 0.
bool isNoNumber(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  const std::string word = lowered(std::string(text));
  return word.starts_with("nan") || word.starts_with("inf");
}

}  // namespace

void tidyObjText(std::string& text, LoadWatch& watch) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::size_t in = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  std::size_t out = 0;   // never beyond `in`
  std::size_t owed = 0;  // ends of lines that were continued
  std::string continued;
  std::size_t lines = 0;
  while (in < text.size()) {
    watch.piece(lines++);
    const std::size_t end = std::min(text.find_first_of("\r\n", in), text.size());
    const std::size_t next = std::min(text.size(), end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1));
    std::string_view line(text.data() + in, end - in);
    const std::size_t first = std::min(line.find_first_not_of(kBlanks), line.size());
    // Comments are left alone, be they continued or not.
    const bool isComment = first < line.size() && line[first] == '#' && continued.empty();
    const std::size_t last = line.find_last_not_of(kBlanks);
    const bool isContinued = !isComment && last != std::string_view::npos && line[last] == '\\';
    in = next;
    if (isContinued) {
      continued += line.substr(0, last);
      continued += ' ';
      ++owed;
      if (in < text.size()) continue;
      line = {};  // nothing comes any more
    }
    const bool isPlain = continued.empty() &&
                         (line.empty() || (line.back() != ' ' && line.back() != '\t' && line.back() != '/' &&
                                           line.find('#') == std::string_view::npos &&
                                           line.find("/ ") == std::string_view::npos &&
                                           line.find("/\t") == std::string_view::npos));
    if (isPlain || isComment) {
      std::copy(line.begin(), line.end(), text.begin() + static_cast<std::ptrdiff_t>(out));
      out += line.size();
    } else {
      continued += line;
      const std::size_t start = std::min(continued.find_first_not_of(kBlanks), continued.size());
      // Columns of messages are those of the file.
      const std::string tidied =
          continued.substr(0, start) + tidyLine(std::string_view(continued).substr(start));
      std::copy(tidied.begin(), tidied.end(), text.begin() + static_cast<std::ptrdiff_t>(out));
      out += tidied.size();
      continued.clear();
    }
    for (++owed; owed > 0 && out < in; --owed) text[out++] = '\n';
    owed = 0;
  }
  text.resize(out);
}

std::string_view beforeComment(std::string_view name) {
  const std::size_t comment = name.find(" #");
  return comment == std::string_view::npos ? name : trimmed(name.substr(0, comment));
}

std::optional<double> parseTextNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || status != std::errc()) return std::nullopt;
  if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) return std::nullopt;
  return value;
}

std::string textPlace(const std::filesystem::path& path, std::size_t line, std::size_t column) {
  return fmt::format("{}:{}:{}", path.string(), line, column);
}

std::optional<Error> checkTextNumbers(const std::filesystem::path& path, const std::vector<TextWord>& words,
                                      std::size_t line, std::size_t count) {
  if (words.size() < count + 1) {
    return Error{textPlace(path, line, words[0].column),
                 fmt::format("{}: expected {} number{}, found {}", words[0].text, count,
                             count == 1 ? "" : "s", words.size() - 1),
                 {}};
  }
  for (std::size_t i = 1; i <= count; ++i) {
    if (parseTextNumber(words[i].text)) continue;
    return Error{
        textPlace(path, line, words[i].column),
        fmt::format("{}: expected a finite number up to 3.4e38, found \"{}\"", words[0].text, words[i].text),
        {}};
  }
  return std::nullopt;
}

std::vector<TextWord> wordsOfLine(std::string_view line, LoadWatch& watch) {
  std::vector<TextWord> words;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(kBlanks, at)) != std::string_view::npos) {
    watch.piece(words.size() + 1);
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back({line.substr(at, end - at), at + 1});
    at = end;
  }
  return words;
}

Expected<ObjLines> checkObjText(const std::filesystem::path& path, std::string_view text, LoadWatch& watch) {
  ObjLines lines;
  SkippedStatements skipped;
  bool moreThanPositions = false;
  bool hasThinFaces = false;
  std::optional<Error> error = forEachTextLine(
      text, watch, [&](const std::vector<TextWord>& words, std::size_t line) -> std::optional<Error> {
        const std::string_view statement = words[0].text;
        if (statement == "v") {
          moreThanPositions |= words.size() > 4;
          return checkTextNumbers(path, words, line, 3);
        }
        if (statement == "vn") {
          const bool isNone =
              words.size() >= 4 && std::any_of(words.begin() + 1, words.begin() + 4,
                                               [](const TextWord& word) { return isNoNumber(word.text); });
          return isNone ? std::nullopt : checkTextNumbers(path, words, line, 3);
        }
        if (statement == "vt") return checkTextNumbers(path, words, line, 1);
        if (statement == "f") {
          hasThinFaces |= words.size() < 4;
          if (words.size() > 1) lines.faces.push_back(line);
          return checkFace(path, words, line);
        }
        if (statement == "mtllib") {
          if (words.size() > 1) lines.libraries.emplace_back(restOfLine(words[1], words));
          return std::nullopt;
        }
        // Names of parts, and smoothing groups, which say no more than the normals.
        constexpr std::array<std::string_view, 4> kHarmless = {"g", "o", "s", "usemtl"};
        if (std::find(kHarmless.begin(), kHarmless.end(), statement) == kHarmless.end())
          skipped.add(statement);
        return std::nullopt;
      });
  if (error) return tl::unexpected(*error);
  if (moreThanPositions)
    lines.warnings.push_back(fmt::format("{}: vertex weights or colours are not used", path.string()));
  if (hasThinFaces)
    lines.warnings.push_back(fmt::format("{}: faces of fewer than 3 corners are left out", path.string()));
  if (!skipped.empty())
    lines.warnings.push_back(fmt::format("{}: not used: {}", path.string(), skipped.list()));
  return lines;
}

std::filesystem::path portablePath(std::string_view name) {
  std::string portable(name);
  std::replace(portable.begin(), portable.end(), '\\', '/');
  const bool hasDrive = portable.size() > 1 && portable[1] == ':';
  const std::filesystem::path path(portable);
  return hasDrive || path.is_absolute() ? path.filename() : path;
}

std::filesystem::path pathInAnyCase(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return path;
  const std::string wanted = lowered(path.filename().string());
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::filesystem::path found;
  std::filesystem::directory_iterator entry(folder, ignored);
  for (; !ignored && entry != std::filesystem::directory_iterator(); entry.increment(ignored)) {
    if (lowered(entry->path().filename().string()) != wanted) continue;
    if (!found.empty()) return path;
    found = path.parent_path() / entry->path().filename();
  }
  return found.empty() ? path : found;
}

}  // namespace lightvane
