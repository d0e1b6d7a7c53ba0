#include "core/base/freed_memory.h"

#include <cstdlib>  // __GLIBC__

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace lightvane {

void keepFreedMemory() {
#ifdef __GLIBC__
  // Blocks from 32 MB on, the largest that mallopt takes, still come from the system and go back to it.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  // What a thread's own heap has at its end, beside the heap's own size.
  mallopt(M_TOP_PAD, 64 << 20);
#endif
}

void returnFreedMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace lightvane
