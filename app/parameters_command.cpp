#include "app/parameters_command.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "app/settings.h"
#include "app/text_table.h"
#include "core/base/text.h"
#include "core/render/parameters.h"

namespace lightvane {
namespace {

constexpr const char* kMarkdownHead =
    "# Parameters\n"
    "\n"
    "Written by `lightvane parameters --markdown`; a test holds it to that.\n"
    "\n"
    "Any of these can be given as `--set key=value` on the command line, and by its key in a scene's "
    "`[render]`. From\n"
    "weak to strong: the defaults below, what `method.rules` sets, what the preset sets, the other keys of "
    "`[render]`,\n"
    "those of the command line.\n"
    "\n"
    "Lengths are a part of the scene's diagonal, `1.5%`, or metres, `0.08m`. *Cost* is what a change makes "
    "stale: `answer`\n"
    "only interpolates anew, `vectors` computes light anew. *Paper* is the section or equation of Zaninetti "
    "and Peroche.\n"
    "\n";

/// Whether `key` is asked for: by its name, or by the part before one of its dots.
bool isNamed(std::string_view key, const std::string& name) {
  return key == name || (key.starts_with(name) && key.size() > name.size() && key[name.size()] == '.');
}

Expected<std::vector<FieldDescription>> select(std::vector<FieldDescription> rows,
                                               const std::vector<std::string>& names) {
  if (names.empty()) return rows;
  std::vector<std::string> known;
  for (const FieldDescription& row : rows) {
    const std::string key = row.field.key;
    known.push_back(key);
    if (const std::size_t dot = key.find('.'); dot != std::string::npos) known.push_back(key.substr(0, dot));
  }
  for (const std::string& name : names) {
    if (std::none_of(rows.begin(), rows.end(),
                     [&](const FieldDescription& row) { return isNamed(row.field.key, name); })) {
      return makeError("parameters", fmt::format("there is no parameter '{}'", name),
                       suggestion(name, known));
    }
  }
  std::erase_if(rows, [&](const FieldDescription& row) {
    return std::none_of(names.begin(), names.end(),
                        [&](const std::string& name) { return isNamed(row.field.key, name); });
  });
  return rows;
}

std::string asText(const std::vector<FieldDescription>& rows) {
  std::vector<std::vector<std::string>> cells = {{"key", "default", "range", "unit", "cost", "paper"}};
  std::vector<std::string> notes = {""};
  for (const FieldDescription& row : rows) {
    cells.push_back({row.field.key, row.value, row.range, row.field.unit, changeCostName(row.field.cost),
                     row.field.paper});
    notes.push_back(helpOf(row.field));
  }
  return alignedTable(cells, notes);
}

std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

/// A table of what each choice of `key` sets other keys to.
template <class E, std::size_t N, class Apply>
std::string whatChoicesSet(std::string_view key, const std::array<Choice<E>, N>& choices,
                           const Apply& apply) {
  std::array<std::vector<FieldDescription>, N> columns;
  std::string head = "| key |";
  std::string rule = "|---|";
  for (std::size_t i = 0; i < N; ++i) {
    Parameters parameters;
    apply(parameters, choices[i].value);
    columns[i] = describeParameters(parameters);
    head += fmt::format(" {} |", choices[i].name);
    rule += "---|";
  }
  std::string text = head + "\n" + rule + "\n";
  for (std::size_t r = 0; r < columns[0].size(); ++r) {
    const bool same = std::all_of(columns.begin(), columns.end(),
                                  [&](const auto& column) { return column[r].value == columns[0][r].value; });
    if (same || columns[0][r].field.key == key) continue;
    text += fmt::format("| `{}` |", columns[0][r].field.key);
    for (const auto& column : columns) text += fmt::format(" {} |", cell(column[r].value));
    text += "\n";
  }
  return text;
}

std::string asMarkdown(const std::vector<FieldDescription>& rows, bool whole) {
  std::string text = whole ? kMarkdownHead : "";
  text += "| key | default | range | unit | cost | paper | what it does |\n|---|---|---|---|---|---|---|\n";
  for (const FieldDescription& row : rows) {
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", row.field.key, cell(row.value),
                        cell(row.range), row.field.unit, changeCostName(row.field.cost), row.field.paper,
                        cell(helpOf(row.field)));
  }
  if (!whole) return text;
  text += "\n## What `method.rules` sets\n\n";
  text += whatChoicesSet("method.rules", kRulesNames,
                         [](Parameters& p, Rules rules) { applyRules(p.vectors, rules); });
  text += "\n## What presets set\n\n`--preset NAME`, or `preset = \"NAME\"` in `[render]`.\n\n";
  text +=
      whatChoicesSet("preset", kPresetNames, [](Parameters& p, Preset preset) { applyPreset(p, preset); });
  return text;
}

}  // namespace

Expected<std::string> describeParameterList(const ParametersArguments& arguments) {
  const auto rows = select(describeParameters(Parameters{}), arguments.keys);
  if (!rows) return tl::unexpected(rows.error());
  return arguments.markdown ? asMarkdown(*rows, arguments.keys.empty()) : asText(*rows);
}

}  // namespace lightvane
