#include "core/base/check.h"

namespace lightvane {

void failCheck(const char* file, int line, const char* condition, const std::string& values) {
  throw InvariantViolation(fmt::format("{}:{}: {} does not hold: {}", file, line, condition, values));
}

}  // namespace lightvane
