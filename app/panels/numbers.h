#pragma once

#include <cstdint>
#include <string>

namespace lightvane {

// Numbers as people read them.

/// "12.3 k", "4.56 M"
std::string shortCount(double count);
/// "312 MB"; powers of 1024
std::string byteCount(std::uint64_t bytes);
/// "0.4 s", "12 s", "3 min 05 s"
std::string durationText(double seconds);
/// Four digits at most: "0.0123", "1.5", "1.2e-06"; whole numbers with all of theirs: "20000"
std::string shortNumber(double value);

}  // namespace lightvane
