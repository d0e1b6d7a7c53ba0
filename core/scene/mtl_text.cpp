#include "core/scene/mtl_text.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/scene/obj_text.h"

namespace lightvane {
namespace {

/// What becomes of a number beyond its range.
enum class Beyond { IsClamped, IsLeftOut };

/// A statement that we use, and the numbers that follow it.
struct MtlStatement {
  std::string_view name;
  std::size_t count;  ///< of a colour fewer may be written: the first stands for the others
  double least, greatest;
  std::string_view range;
  Beyond beyond;
};
constexpr double kMostFloat = std::numeric_limits<float>::max();
constexpr MtlStatement kMtlStatements[] = {
    {"Kd", 3, 0.0, 1.0, "in [0, 1]", Beyond::IsClamped},
    {"Ks", 3, 0.0, 1.0, "in [0, 1]", Beyond::IsClamped},
    {"Tf", 3, 0.0, 1.0, "in [0, 1]", Beyond::IsClamped},
    {"Ke", 3, 0.0, kMostFloat, "of at least 0", Beyond::IsClamped},
    {"Ns", 1, 0.0, kMostFloat, "of at least 0", Beyond::IsClamped},
    {"Ni", 1, 1e-3, 1e3, "from 0.001 to 1000", Beyond::IsLeftOut},
    {"d", 1, 0.0, 1.0, "in [0, 1]", Beyond::IsClamped},
    {"Tr", 1, 0.0, 1.0, "in [0, 1]", Beyond::IsClamped},
    {"illum", 1, 0.0, 10.0, "from 0 to 10", Beyond::IsLeftOut},
};

/// An option of a picture's statement, with how many words follow it at most. Numbers may be fewer.
struct MapOption {
  std::string_view name;
  std::size_t most;
  bool isOfNumbers;
  bool isMissed;  ///< without it the picture looks otherwise
};
constexpr MapOption kMapOptions[] = {
    {"-s", 3, true, false},       {"-o", 3, true, false},       {"-t", 3, true, true},
    {"-mm", 2, true, true},       {"-boost", 1, true, true},    {"-bm", 1, true, false},
    {"-texres", 1, true, false},  {"-clamp", 1, false, false},  {"-blendu", 1, false, false},
    {"-blendv", 1, false, false}, {"-imfchan", 1, false, true}, {"-type", 1, false, true},
    {"-cc", 1, false, false}};

/// Writes the statements of one file.
class MtlWriter {
 public:
  MtlWriter(const std::filesystem::path& path, std::vector<std::string>& warnings)
      : path_(path), warnings_(warnings) {}

  std::optional<Error> add(const std::vector<TextWord>& words, std::size_t line) {
    const std::string_view statement = words[0].text;
    if (statement == "newmtl") {
      text_ += fmt::format("newmtl {}\n", words.size() > 1 ? restOfLine(words[1], words) : "");
      return std::nullopt;
    }
    if (statement == "map_Kd" || statement == "map_Ke") {
      addPicture(words, line);
      return std::nullopt;
    }
    const auto* known = std::find_if(std::begin(kMtlStatements), std::end(kMtlStatements),
                                     [&](const MtlStatement& s) { return s.name == statement; });
    if (known != std::end(kMtlStatements)) return addNumbers(*known, words, line);
    skipped_.add(statement);
    return std::nullopt;
  }

  std::string finish() {
    if (!skipped_.empty()) {
      warnings_.push_back(
          fmt::format("{}: not used: {} (Kd, Ks, Ns, Ke, Ni, Tf, d, Tr, illum, map_Kd and map_Ke are)",
                      path_.string(), skipped_.list()));
    }
    return std::move(text_);
  }

 private:
  std::optional<Error> addNumbers(const MtlStatement& statement, std::vector<TextWord> words,
                                  std::size_t line) {
    const std::string_view kind = words.size() > 1 ? words[1].text : std::string_view();
    // Spectra, and colours of another space.
    if (statement.count == 3 && (kind == "spectral" || kind == "xyz")) {
      skipped_.add(fmt::format("{} {}", statement.name, kind));
      return std::nullopt;
    }
    if (statement.name == "d" && kind == "-halo") {
      skipped_.add("d -halo");
      words.erase(words.begin() + 1);
    }
    cutComment(words);
    if (words.size() == 1) {
      warnings_.push_back(
          fmt::format("{}: {} without a number", textPlace(path_, line, words[0].column), statement.name));
      return std::nullopt;
    }
    // One number of a colour is all three.
    const std::size_t written = words.size() == 2 ? 1 : statement.count;
    if (std::optional<Error> wrong = checkTextNumbers(path_, words, line, written)) return wrong;
    std::vector<double> numbers;
    for (std::size_t i = 0; i < statement.count; ++i) {
      const TextWord& word = words[std::min(i, written - 1) + 1];
      const double number = parseTextNumber(word.text).value_or(0.0);  // checked
      const double inRange = std::clamp(number, statement.least, statement.greatest);
      if (number != inRange) {
        warnOfRange(statement, word, line, inRange);
        if (statement.beyond == Beyond::IsLeftOut) return std::nullopt;
      }
      numbers.push_back(inRange);
    }
    text_ += fmt::format("{} {}\n", statement.name, fmt::join(numbers, " "));
    return std::nullopt;
  }

  static void cutComment(std::vector<TextWord>& words) {
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::size_t comment = words[i].text.find('#');
      if (comment == std::string_view::npos) continue;
      words[i].text = words[i].text.substr(0, comment);
      words.resize(words[i].text.empty() ? i : i + 1);
    }
  }

  /// The first time for each statement.
  void warnOfRange(const MtlStatement& statement, const TextWord& word, std::size_t line, double taken) {
    if (!outOfRange_.insert(statement.name).second) return;
    const std::string becomes =
        statement.beyond == Beyond::IsClamped ? fmt::format("taken as {:g}", taken) : std::string("left out");
    warnings_.push_back(fmt::format(
        "{}: {}: expected {} {}, found {}: {}", textPlace(path_, line, word.column), statement.name,
        statement.count == 3 ? "three numbers" : "a number", statement.range, word.text, becomes));
  }

  void addPicture(const std::vector<TextWord>& words, std::size_t line) {
    const std::string_view statement = words[0].text;
    std::array<double, 2> scale = {1.0, 1.0};
    std::array<double, 2> offset = {0.0, 0.0};
    std::string_view clamp = "off";
    std::size_t at = 1;
    while (at < words.size() && words[at].text.starts_with('-')) {
      const auto* option = std::find_if(std::begin(kMapOptions), std::end(kMapOptions),
                                        [&](const MapOption& o) { return o.name == words[at].text; });
      if (option == std::end(kMapOptions)) break;  // a name may begin with anything
      ++at;
      // The last word is the name, even if it is a number.
      std::size_t count = 0;
      while (count < option->most && at + count + 1 < words.size() &&
             (!option->isOfNumbers || parseTextNumber(words[at + count].text)))
        ++count;
      std::array<double, 2>* numbers = option->name == "-s"   ? &scale
                                       : option->name == "-o" ? &offset
                                                              : nullptr;
      for (std::size_t i = 0; numbers != nullptr && i < std::min<std::size_t>(count, 2); ++i)
        (*numbers)[i] = parseTextNumber(words[at + i].text).value_or(0.0);  // counted
      if (option->name == "-clamp" && count == 1) clamp = words[at].text;
      if (option->isMissed) skipped_.add(fmt::format("{} of {}", option->name, statement));
      at += count;
    }
    if (at >= words.size()) {
      warnings_.push_back(fmt::format("{}: {} without the name of a picture",
                                      textPlace(path_, line, words[0].column), statement));
      return;
    }
    std::string_view name = restOfLine(words[at], words);
    std::error_code ignored;
    if (!std::filesystem::exists(path_.parent_path() / portablePath(name), ignored))
      name = beforeComment(name);
    const bool isQuoted = name.size() > 2 && name.starts_with('"') && name.ends_with('"');
    if (isQuoted) name = name.substr(1, name.size() - 2);
    text_ += fmt::format("{} -s {} {} 1 -o {} {} 0 -clamp {} {}\n", statement, scale[0], scale[1], offset[0],
                         offset[1], clamp, name);
  }

  const std::filesystem::path& path_;
  std::vector<std::string>& warnings_;
  std::string text_;
  SkippedStatements skipped_;
  std::set<std::string_view> outOfRange_;
};

}  // namespace

Expected<std::string> checkedMtlText(const std::filesystem::path& path, std::string text,
                                     std::vector<std::string>& warnings, LoadWatch& watch) {
  tidyObjText(text, watch);
  MtlWriter writer(path, warnings);
  if (auto error = forEachTextLine(text, watch, [&](const std::vector<TextWord>& words, std::size_t line) {
        return writer.add(words, line);
      }))
    return tl::unexpected(*error);
  return writer.finish();
}

}  // namespace lightvane
