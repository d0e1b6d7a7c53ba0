#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "core/base/color.h"
#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/base/math.h"

namespace lightvane {

// A typed reader of TOML tables. A key becomes known by being asked for, so that the list of known keys,
// which messages about unknown ones draw on, is the reading code itself.

/// The numbers that a key takes, and how messages call them: "a {adjective}number{range}".
struct Interval {
  double least;
  double greatest;
  const char* adjective;
  const char* range;
};
/// Areas and volumes of lengths up to here are still finite in double.
inline constexpr double kLargestLength = 1e100;
inline constexpr Interval kFinite{-kLargestLength, kLargestLength, "finite ", " up to 1e100"};
inline constexpr Interval kPositive{1.0 / kLargestLength, kLargestLength, "", " above 0 (1e-100 to 1e100)"};
inline constexpr Interval kUnitInterval{0.0, 1.0, "", " in [0, 1]"};
/// Radiance, irradiance and intensity are held as float.
inline constexpr Interval kLightPower{0.0, std::numeric_limits<float>::max(), "", " from 0 to 3.4e38"};

/// The file being read and the first thing found wrong in it. Reading goes on with defaults after an error,
/// so that the code that reads needs no error paths; whoever started it looks here at the end.
class TomlReport {
 public:
  explicit TomlReport(const std::filesystem::path& path) : file_(path.string()) {}

  /// "file:line:column"
  std::string place(const toml::source_position& position) const;
  std::string place(const toml::node& node) const { return place(node.source().begin); }

  /// Keeps the first call's error and ignores the others, which often follow from it.
  void fail(const toml::source_position& position, std::string what, std::string hint = {});
  /// As above, of what others found, with its place.
  void fail(Error error);

  const std::optional<Error>& error() const { return error_; }

 private:
  std::string file_;
  std::optional<Error> error_;
};

/// One table while it is being read.
///
/// Every `read` makes its key known and fills `value` where the key is present and right; it returns whether
/// it did. A value that is wrong is reported with its place, what was expected and what was found. Call
/// finish() at the end.
class TomlTable {
 public:
  /// `title` is what messages call the table: "[camera]". `report` and `table` must outlive this.
  TomlTable(TomlReport& report, const toml::table& table, std::string title)
      : report_(report), table_(table), title_(std::move(title)) {}

  bool has(std::string_view key) { return find(key) != nullptr; }
  bool hasTable(std::string_view key);
  /// Whether the key's value is this string.
  bool hasText(std::string_view key, std::string_view text);

  bool read(std::string_view key, double& value, const Interval& interval = kFinite);
  bool read(std::string_view key, float& value, const Interval& interval);
  bool read(std::string_view key, int& value, const Interval& interval);
  bool read(std::string_view key, bool& value);
  bool read(std::string_view key, std::string& value);
  bool read(std::string_view key, Vec2& value, const Interval& interval);
  bool read(std::string_view key, Vec3d& value, const Interval& interval = kFinite);
  /// Refuses numbers that are not 0 and too small for float, and, as unsupported, a texture in place of the
  /// colour: who takes one asks hasTable before.
  bool read(std::string_view key, Rgb& value, const Interval& interval);
  bool read(std::string_view key, std::array<int, 2>& value, const Interval& interval);
  bool read(std::string_view key, std::vector<Vec3d>& value);
  /// A direction or an axis: three numbers, not all 0.
  bool readDirection(std::string_view key, Vec3d& value);
  /// A string that is one of `words`.
  bool readWord(std::string_view key, std::string& value, std::span<const std::string> words);
  /// As readWord for a key that must be there. Without it no other key can be judged, so it is reported at
  /// once.
  bool readType(std::string_view key, std::string& value, std::span<const std::string> words);
  /// One number for all three, or three numbers.
  bool readScale(std::string_view key, Vec3d& value, const Interval& interval);

  /// A table, or nullptr. `hint` is for a value that is none.
  const toml::table* readTable(std::string_view key, std::string hint = {});
  /// All tables in an array of tables; none where the key is absent.
  std::vector<const toml::table*> readTables(std::string_view key, std::string hint = {});

  /// As readTable and readTables, ready to be read. Their titles are "[key]", in a table "[table.key]", and
  /// "[[key]] 3 (name)".
  std::optional<TomlTable> subtable(std::string_view key, std::string hint = {});
  std::vector<TomlTable> subtables(std::string_view key, std::string hint = {});

  /// Makes finish() report `key` where it is absent; `expected` says what should be there.
  void require(std::string_view key, std::string expected);
  /// Reports something about a key that is present, at its value's place.
  void fail(std::string_view key, std::string_view what, std::string hint = {});
  /// As fail, at the place of element `index` of an array.
  void failAt(std::string_view key, std::size_t index, std::string_view what, std::string hint = {});

  /// Reports the first unknown key, else the first missing one. True if nothing was wrong in the file so far.
  bool finish();

  const std::string& title() const { return title_; }
  TomlReport& report() { return report_; }
  const toml::table& table() const { return table_; }

 private:
  struct Required {
    std::string key;
    std::string expected;
  };

  const toml::node* find(std::string_view key);
  void failMissing(std::string_view key, std::string_view expected);
  void mismatch(std::string_view key, const toml::node& node, std::string_view expected,
                std::string hint = {});
  template <std::size_t N>
  bool readNumbers(std::string_view key, const toml::node& node, std::array<double, N>& values,
                   const Interval& interval);

  TomlReport& report_;
  const toml::table& table_;
  std::string title_;
  std::vector<std::string> known_;
  std::vector<Required> required_;
};

/// What a message calls a value: "the number 3", "\"red\"", "an array of 2", "a table".
std::string describeNode(const toml::node& node);
/// What messages call an entry of an array of tables: "[[shape]] 3 (floor)".
std::string titleOf(std::string_view key, std::size_t index, const toml::table& table);

/// Parses a file's text and gives its root, which messages call "the file", to `read`. The error is the first
/// that `read` reported, or what keeps the text from being TOML; `path` is what it names. Throws LoadStopped
/// as `watch` says while the text is parsed.
Expected<void> readToml(std::string_view text, const std::filesystem::path& path,
                        const std::function<void(TomlTable& root)>& read,
                        LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
