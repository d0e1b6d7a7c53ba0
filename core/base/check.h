#pragma once

#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace lightvane {

/// A broken promise between parts of the program: never the user's fault, always a defect worth reporting.
class InvariantViolation : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void failCheck(const char* file, int line, const char* condition, const std::string& values);

}  // namespace lightvane

/// Throws InvariantViolation with the condition, its place and the formatted values when `condition` is
/// false. On in every build: put it where its cost does not show.
#define LV_CHECK(condition, ...)                                                          \
  do {                                                                                    \
    if (!(condition)) [[unlikely]] {                                                      \
      ::lightvane::failCheck(__FILE__, __LINE__, #condition, ::fmt::format(__VA_ARGS__)); \
    }                                                                                     \
  } while (false)
