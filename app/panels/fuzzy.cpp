#include "app/panels/fuzzy.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "core/base/text.h"

namespace lightvane {
namespace {

// A letter that fits, one that follows on another, and one that begins a word: in what ratio matters little
// as long as a run of three beats two beginnings.
constexpr int kFits = 1;
constexpr int kRun = 10;
constexpr int kWord = 8;
constexpr int kWholeWord = 1;  // decides between "ilv.radius" and "ilv.radius_scale"
constexpr int kCannot = -1;

/// Of names such as n_min, all is one word.
bool endsWord(std::string_view text, std::size_t at) {
  return at + 1 == text.size() ||
         (std::isalnum(static_cast<unsigned char>(text[at + 1])) == 0 && text[at + 1] != '_');
}
bool isLetter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::optional<int> fuzzyScore(std::string_view typed, std::string_view candidate) {
  const std::string text = lowered(candidate);
  std::string letters = lowered(typed);
  std::erase(letters, ' ');
  if (letters.empty()) return 0;

  // best[j]: of the letters so far, with the last of them at text[j]; kCannot where it cannot be there.
  std::vector<int> best(text.size(), kCannot);
  std::vector<int> next(text.size());
  for (std::size_t i = 0; i < letters.size(); ++i) {
    int before = i == 0 ? 0 : kCannot;  // the best with the letter before anywhere left of j
    for (std::size_t j = 0; j < text.size(); ++j) {
      next[j] = kCannot;
      if (text[j] == letters[i]) {
        const bool startsWord = isLetter(text[j]) && (j == 0 || !isLetter(text[j - 1]));
        const int own = kFits + (startsWord ? kWord : 0);
        if (before != kCannot) next[j] = before + own;
        if (i > 0 && j > 0 && best[j - 1] != kCannot) next[j] = std::max(next[j], best[j - 1] + own + kRun);
        if (i + 1 == letters.size() && next[j] != kCannot && endsWord(text, j)) next[j] += kWholeWord;
      }
      if (i > 0) before = std::max(before, best[j]);
    }
    std::swap(best, next);
  }
  const int score = text.empty() ? kCannot : *std::max_element(best.begin(), best.end());
  if (score == kCannot) return std::nullopt;
  // Of texts that fit alike the shorter one is meant.
  return 64 * score - static_cast<int>(std::min<std::size_t>(text.size(), 63));
}

}  // namespace lightvane
