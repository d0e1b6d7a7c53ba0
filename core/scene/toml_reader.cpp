#include "core/scene/toml_reader.h"

#include <algorithm>
#include <istream>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/base/watched_text.h"

namespace lightvane {
namespace {

bool isInside(double number, const Interval& interval) {
  return number >= interval.least && number <= interval.greatest;  // false for NaN
}

std::string wordsForOne(const Interval& interval) {
  return fmt::format("a {}number{}", interval.adjective, interval.range);
}

std::string wordsForSeveral(std::size_t count, const Interval& interval) {
  return fmt::format("[{}], {} {}numbers{}", count == 2 ? "a, b" : "a, b, c", count == 2 ? "two" : "three",
                     interval.adjective, interval.range);
}

std::optional<double> numberIn(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  if (const auto* floating = node.as_floating_point()) return floating->get();
  return std::nullopt;
}

/// Reads TOML no further than it takes to count the parts of keys.
class KeyScan {
 public:
  explicit KeyScan(std::string_view text) : text_(text) {}

  /// Where a key has more parts than any of ours: toml++ bounds how deep values are nested, but not that, and
  /// frees tables within tables by recursion. Nothing where all is well.
  std::optional<toml::source_position> tooDeep() {
    constexpr std::size_t kMostParts = 100;
    constexpr std::string_view kBetweenKeys = "\n=[]{},";
    std::size_t parts = 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skipString(c);  // may be a part
        continue;
      }
      if (c == '#') skipComment();
      if (c == '.' && ++parts > kMostParts) return toml::source_position{place_.line, place_.column + 1};
      if (kBetweenKeys.find(c) != std::string_view::npos) parts = 1;
      step();
    }
    return std::nullopt;
  }

 private:
  void step(std::size_t count = 1) {
    for (; count > 0 && at_ < text_.size(); --count) {
      const bool isEnd = text_[at_++] == '\n';
      place_.line += isEnd ? 1 : 0;
      place_.column = isEnd ? 0 : place_.column + 1;
    }
  }
  void skipComment() {
    while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') step();
  }
  void skipString(char quote) {
    const std::string three(3, quote);
    const std::string end = text_.substr(at_, 3) == three ? three : std::string(1, quote);
    step(end.size());
    while (at_ < text_.size() && text_.substr(at_, end.size()) != end) {
      if (end.size() == 1 && text_[at_] == '\n') return;
      step(quote == '"' && text_[at_] == '\\' ? 2 : 1);
    }
    step(end.size());
  }

  std::string_view text_;
  std::size_t at_ = 0;
  toml::source_position place_{1, 0};  ///< before what is next
};

}  // namespace

std::string describeNode(const toml::node& node) {
  if (const auto* array = node.as_array()) {
    return array->empty() ? "an empty array" : fmt::format("an array of {}", array->size());
  }
  if (node.is_table()) return "a table";
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", text->get());
  if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* floating = node.as_floating_point()) return fmt::format("{}", floating->get());
  return "a date or time";
}

std::string titleOf(std::string_view key, std::size_t index, const toml::table& table) {
  const std::optional<std::string> name = table["name"].value_exact<std::string>();
  return fmt::format("[[{}]] {}{}", key, index + 1, name ? fmt::format(" ({})", *name) : std::string());
}

Expected<void> readToml(std::string_view text, const std::filesystem::path& path,
                        const std::function<void(TomlTable& root)>& read, LoadWatch& watch) {
  TomlReport report(path);
  if (const auto place = KeyScan(text).tooDeep())
    return makeError(report.place(*place), "a key of too many parts");
  try {
    // As a stream, since 100 MB take ten seconds.
    WatchedText watched(text, watch);
    std::istream stream(&watched);
    const toml::table file = toml::parse(stream);
    watch.look();
    TomlTable root(report, file, "the file");
    read(root);
  } catch (const toml::parse_error& error) {
    watch.look();  // a text that ended early is wrong, too
    return makeError(report.place(error.source().begin), std::string(error.description()));
  }
  if (const auto& error = report.error()) return tl::unexpected(*error);
  return {};
}

std::string TomlReport::place(const toml::source_position& position) const {
  // The root table of a file without a byte has no position.
  return fmt::format("{}:{}:{}", file_, std::max(position.line, toml::source_index{1}),
                     std::max(position.column, toml::source_index{1}));
}

void TomlReport::fail(const toml::source_position& position, std::string what, std::string hint) {
  fail(Error{place(position), std::move(what), std::move(hint)});
}

void TomlReport::fail(Error error) {
  if (!error_) error_ = std::move(error);
}

const toml::node* TomlTable::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return table_.get(key);
}

void TomlTable::mismatch(std::string_view key, const toml::node& node, std::string_view expected,
                         std::string hint) {
  report_.fail(node.source().begin,
               fmt::format("{} of {}: expected {}, found {}", key, title_, expected, describeNode(node)),
               std::move(hint));
}

bool TomlTable::hasTable(std::string_view key) {
  const toml::node* node = find(key);
  return node && node->is_table();
}

bool TomlTable::hasText(std::string_view key, std::string_view text) {
  const toml::node* node = find(key);
  return node && node->is_string() && node->as_string()->get() == text;
}

bool TomlTable::read(std::string_view key, double& value, const Interval& interval) {
  const toml::node* node = find(key);
  if (!node) return false;
  const std::optional<double> number = numberIn(*node);
  if (!number || !isInside(*number, interval)) {
    mismatch(key, *node, wordsForOne(interval));
    return false;
  }
  value = *number;
  return true;
}

bool TomlTable::read(std::string_view key, float& value, const Interval& interval) {
  double number = 0.0;
  if (!read(key, number, interval)) return false;
  value = static_cast<float>(number);
  return true;
}

bool TomlTable::read(std::string_view key, int& value, const Interval& interval) {
  const toml::node* node = find(key);
  if (!node) return false;
  const auto* integer = node->as_integer();
  if (!integer || !isInside(static_cast<double>(integer->get()), interval)) {
    mismatch(key, *node, wordsForOne(interval));
    return false;
  }
  value = static_cast<int>(integer->get());
  return true;
}

bool TomlTable::read(std::string_view key, bool& value) {
  const toml::node* node = find(key);
  if (!node) return false;
  if (!node->is_boolean()) {
    mismatch(key, *node, "true or false");
    return false;
  }
  value = node->as_boolean()->get();
  return true;
}

bool TomlTable::read(std::string_view key, std::string& value) {
  const toml::node* node = find(key);
  if (!node) return false;
  if (!node->is_string()) {
    mismatch(key, *node, "a string in quotes");
    return false;
  }
  value = node->as_string()->get();
  return true;
}

template <std::size_t N>
bool TomlTable::readNumbers(std::string_view key, const toml::node& node, std::array<double, N>& values,
                            const Interval& interval) {
  const toml::array* array = node.as_array();
  if (!array || array->size() != N) {
    mismatch(key, node, wordsForSeveral(N, interval));
    return false;
  }
  for (std::size_t i = 0; i < N; ++i) {
    const std::optional<double> number = numberIn((*array)[i]);
    if (!number || !isInside(*number, interval)) {
      mismatch(key, (*array)[i], wordsForSeveral(N, interval));
      return false;
    }
    values[i] = *number;
  }
  return true;
}

bool TomlTable::read(std::string_view key, Vec2& value, const Interval& interval) {
  const toml::node* node = find(key);
  std::array<double, 2> numbers{};
  if (!node || !readNumbers(key, *node, numbers, interval)) return false;
  value = Vec2(numbers[0], numbers[1]);
  return true;
}

bool TomlTable::read(std::string_view key, Vec3d& value, const Interval& interval) {
  const toml::node* node = find(key);
  std::array<double, 3> numbers{};
  if (!node || !readNumbers(key, *node, numbers, interval)) return false;
  value = {numbers[0], numbers[1], numbers[2]};
  return true;
}

bool TomlTable::read(std::string_view key, Rgb& value, const Interval& interval) {
  const toml::node* node = find(key);
  if (!node) return false;
  if (node->is_table()) {
    fail(key, "no texture may stand in place of this colour: those of materials take one");
    return false;
  }
  std::array<double, 3> numbers{};
  if (!readNumbers(key, *node, numbers, interval)) return false;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != 0.0 && static_cast<float>(numbers[i]) == 0.0f) {
      failAt(key, i, fmt::format("{} is too small to be told from 0", numbers[i]),
             "the smallest is about 1.2e-38");
      return false;
    }
  }
  value = Rgb(numbers[0], numbers[1], numbers[2]);
  return true;
}

bool TomlTable::read(std::string_view key, std::array<int, 2>& value, const Interval& interval) {
  const toml::node* node = find(key);
  std::array<double, 2> numbers{};
  if (!node || !readNumbers(key, *node, numbers, interval)) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!(*node->as_array())[i].is_integer()) {
      mismatch(key, (*node->as_array())[i], wordsForSeveral(2, interval));
      return false;
    }
    value[i] = static_cast<int>(numbers[i]);
  }
  return true;
}

bool TomlTable::read(std::string_view key, std::vector<Vec3d>& value) {
  const toml::node* node = find(key);
  if (!node) return false;
  const toml::array* array = node->as_array();
  if (!array) {
    mismatch(key, *node, "an array of points [x, y, z]");
    return false;
  }
  std::vector<Vec3d> points;
  points.reserve(array->size());
  for (const toml::node& element : *array) {
    std::array<double, 3> numbers{};
    if (!readNumbers(key, element, numbers, kFinite)) return false;
    points.emplace_back(numbers[0], numbers[1], numbers[2]);
  }
  value = std::move(points);
  return true;
}

bool TomlTable::readDirection(std::string_view key, Vec3d& value) {
  Vec3d direction(0.0);
  if (!read(key, direction)) return false;
  if (direction == Vec3d(0.0)) {
    fail(key, "expected a direction, found [0, 0, 0]");
    return false;
  }
  value = direction;
  return true;
}

bool TomlTable::readWord(std::string_view key, std::string& value, std::span<const std::string> words) {
  std::string word;
  if (!read(key, word)) return false;
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    fail(key, fmt::format("expected {}, found \"{}\"", listWords(words), word), suggestion(word, words));
    return false;
  }
  value = std::move(word);
  return true;
}

bool TomlTable::readType(std::string_view key, std::string& value, std::span<const std::string> words) {
  if (!has(key)) failMissing(key, listWords(words));
  return readWord(key, value, words);
}

bool TomlTable::readScale(std::string_view key, Vec3d& value, const Interval& interval) {
  const toml::node* node = find(key);
  if (!node || node->is_array()) return read(key, value, interval);
  double uniform = 1.0;
  if (!read(key, uniform, interval)) return false;
  value = Vec3d(uniform);
  return true;
}

const toml::table* TomlTable::readTable(std::string_view key, std::string hint) {
  const toml::node* node = find(key);
  if (!node) return nullptr;
  if (!node->is_table()) mismatch(key, *node, "one table", std::move(hint));
  return node->as_table();
}

std::vector<const toml::table*> TomlTable::readTables(std::string_view key, std::string hint) {
  std::vector<const toml::table*> tables;
  const toml::node* node = find(key);
  if (!node) return tables;
  const toml::array* array = node->as_array();
  if (!array) {
    mismatch(key, *node, "an array of tables", std::move(hint));
    return tables;
  }
  for (const toml::node& element : *array) {
    if (!element.is_table()) {
      mismatch(key, element, "a table", std::move(hint));
      return {};
    }
    tables.push_back(element.as_table());
  }
  return tables;
}

std::optional<TomlTable> TomlTable::subtable(std::string_view key, std::string hint) {
  const toml::table* table = readTable(key, std::move(hint));
  if (!table) return std::nullopt;
  const bool isNested = title_.starts_with('[') && !title_.starts_with("[[");
  const std::string outer = isNested ? title_.substr(1, title_.size() - 2) + "." : "";
  return TomlTable(report_, *table, fmt::format("[{}{}]", outer, key));
}

std::vector<TomlTable> TomlTable::subtables(std::string_view key, std::string hint) {
  std::vector<TomlTable> tables;
  for (const toml::table* table : readTables(key, std::move(hint))) {
    tables.emplace_back(report_, *table, titleOf(key, tables.size(), *table));
  }
  return tables;
}

void TomlTable::require(std::string_view key, std::string expected) {
  required_.push_back({std::string(key), std::move(expected)});
}

void TomlTable::fail(std::string_view key, std::string_view what, std::string hint) {
  const toml::node* node = find(key);
  report_.fail(node ? node->source().begin : table_.source().begin,
               fmt::format("{} of {}: {}", key, title_, what), std::move(hint));
}

void TomlTable::failAt(std::string_view key, std::size_t index, std::string_view what, std::string hint) {
  const toml::node* node = find(key);
  const toml::array* array = node ? node->as_array() : nullptr;
  const toml::node* element = array ? array->get(index) : nullptr;
  if (!element) return fail(key, what, std::move(hint));
  report_.fail(element->source().begin, fmt::format("{} of {}: {}", key, title_, what), std::move(hint));
}

void TomlTable::failMissing(std::string_view key, std::string_view expected) {
  fail(key, fmt::format("missing, expected {}", expected));
}

bool TomlTable::finish() {
  // Unknown keys first: a key that seems to be missing is most often one that is misspelt.
  const toml::key* unknown = nullptr;
  for (const auto& [key, node] : table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    const auto isEarlier = [](const toml::source_position& a, const toml::source_position& b) {
      return a < b;
    };
    if (!unknown || isEarlier(key.source().begin, unknown->source().begin)) unknown = &key;
  }
  if (unknown) {
    std::string hint = suggestion(unknown->str(), known_);
    if (hint.empty()) hint = fmt::format("known here: {}", listWords(known_));
    report_.fail(unknown->source().begin, fmt::format("{} of {}: unknown key", unknown->str(), title_), hint);
  }
  for (const Required& required : required_) {
    if (!table_.contains(required.key)) failMissing(required.key, required.expected);
  }
  return !report_.error();
}

}  // namespace lightvane
