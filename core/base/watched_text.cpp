#include "core/base/watched_text.h"

#include <algorithm>

namespace lightvane {

// Parsers take from 10 to 100 ns for a byte.
constexpr std::size_t kBytesPerLook = std::size_t{1} << 14;

WatchedText::int_type WatchedText::underflow() {
  if (given_ == text_.size() || watch_.isStopped()) return traits_type::eof();
  watch_.tellFraction(static_cast<double>(given_) / static_cast<double>(text_.size()));
  // Streams read and never write here, whatever their type says.
  char* const first = const_cast<char*>(text_.data()) + given_;
  const std::size_t count = std::min(kBytesPerLook, text_.size() - given_);
  given_ += count;
  setg(first, first, first + count);
  return traits_type::to_int_type(*first);
}

WatchedText::pos_type WatchedText::seekoff(off_type offset, std::ios_base::seekdir from,
                                           std::ios_base::openmode which) {
  const off_type first = from == std::ios_base::cur   ? static_cast<off_type>(position())
                         : from == std::ios_base::end ? static_cast<off_type>(text_.size())
                                                      : 0;
  return seekpos(first + offset, which);
}

WatchedText::pos_type WatchedText::seekpos(pos_type place, std::ios_base::openmode) {
  const off_type wanted = place;
  if (wanted < 0 || wanted > static_cast<off_type>(text_.size())) return {off_type{-1}};
  given_ = static_cast<std::size_t>(wanted);
  setg(nullptr, nullptr, nullptr);
  return place;
}

}  // namespace lightvane
