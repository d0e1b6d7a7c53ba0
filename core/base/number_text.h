#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lightvane {

// Numbers as people read them.

/// A count with its thousands apart: "12,000".
std::string countText(std::size_t count);
/// "999", "12.3 k", "4.56 M"
std::string shortCount(double count);
/// "312 MB", "1.40 GB"; powers of 1000
std::string byteText(std::uint64_t bytes);
/// "850 ms", "12.3 s", "4 min 05 s", "3 h 20 min"
std::string durationText(double seconds);
/// Four digits at most: "0.0123", "1.5", "1.2e-06"; whole numbers with all of theirs: "20000"
std::string shortNumber(double value);

}  // namespace lightvane
