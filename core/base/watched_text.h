#pragma once

#include <streambuf>
#include <string_view>

#include "core/base/load_watch.h"

namespace lightvane {

/// A text for a library that reads it from a stream: its end comes early where the watch says stop, so that
/// nothing is thrown through the library. Whoever has given it to one looks at the watch afterwards. The text
/// and the watch must outlive it.
class WatchedText : public std::streambuf {
 public:
  WatchedText(std::string_view text, LoadWatch& watch) : text_(text), watch_(watch) {}

  /// How many bytes were read.
  std::size_t position() const { return given_ - static_cast<std::size_t>(egptr() - gptr()); }

 protected:
  int_type underflow() override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type place, std::ios_base::openmode which) override;

 private:
  std::string_view text_;
  std::size_t given_ = 0;  ///< bytes, up to the end of what can be read at once
  LoadWatch& watch_;
};

}  // namespace lightvane
