#include "app/text_table.h"

#include <algorithm>

namespace lightvane {
namespace {

/// Characters of UTF-8: bytes that do not go on with one.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::string alignedTable(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<std::string>& notes) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < rows[r].size(); ++i)
      line += rows[r][i] + std::string(widths[i] - width(rows[r][i]) + 2, ' ');
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    if (r < notes.size() && !notes[r].empty()) text += "    " + notes[r] + "\n";
  }
  return text;
}

}  // namespace lightvane
