#pragma once

#include <optional>
#include <string_view>

namespace lightvane {

/// How well letters that were typed fit a text: all of them, in their order, in any case; spaces count for
/// nothing. Beginnings of words and runs of letters weigh most, short texts more than long ones. Nothing
/// where they do not fit; larger is better.
std::optional<int> fuzzyScore(std::string_view typed, std::string_view candidate);

}  // namespace lightvane
