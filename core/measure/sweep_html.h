#pragma once

#include <string>
#include <string_view>

#include "core/measure/sweep.h"

namespace lightvane {

// Text and numbers of a page. Pages are XML as well as HTML, so that a test can tell whether they are whole.

/// Text for elements and quoted attributes. Bytes that are not UTF-8, and characters that XML has no place
/// for, become U+FFFD.
std::string escapedHtml(std::string_view text);

/// A file's relative path as an address, already escaped: '#', '?' and ':' in a name would end or begin
/// something.
std::string escapedUrlPath(std::string_view path);

/// The characters of UTF-8, for the width of a text.
std::size_t characterCount(std::string_view text);

/// A number of an axis: "0.05", "2·10⁻⁵".
std::string axisNumberText(double value);

/// Three digits: "1.23", "∞", "–" where it is no number.
std::string reportNumber(double value);

/// "1.23 ± 0.04": as many decimals as both need; the mean alone where nothing is known to spread.
std::string spreadText(const Spread& spread, bool hasSpread);

}  // namespace lightvane
