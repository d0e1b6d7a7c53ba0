#include "core/base/tasks.h"

#include <immintrin.h>

namespace lightvane {
namespace {

constexpr unsigned int kFlushToZeroAndDenormalsAreZero = 0x8040;

}  // namespace

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
  _mm_setcsr(saved_ | kFlushToZeroAndDenormalsAreZero);
}
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }

}  // namespace lightvane
