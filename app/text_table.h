#pragma once

#include <string>
#include <vector>

namespace lightvane {

/// Rows of cells in columns as wide as their widest cell, two spaces apart; UTF-8 whose characters are all
/// one column wide. `notes` are lines of their own below the rows, indented; those that are empty are left
/// out.
std::string alignedTable(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<std::string>& notes = {});

}  // namespace lightvane
