// Says so, in words, where the processor lacks the instructions that the program was built with.
//
// Part of every executable that is built for x86-64-v3 or v4. This file alone is compiled for any x86-64 and
// without link-time optimisation (app/CMakeLists.txt), runs before all other initialisers, and uses nothing
// of the C++ library: an inline function shared with other files could be the copy that was compiled with
// AVX2 or AVX-512.

#if LIGHTVANE_X86_64_LEVEL > 1

#ifdef __clang__
#define _Bool bool  // NOLINT: C's word, in glibc's header and not in clang++
#endif
#include <cstring>

#include <sys/platform/x86.h>
#include <unistd.h>

namespace {

void print(const char* text) {
  // There is nobody to tell where even this fails.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, strlen(text));
}

// 101 is the first priority that is not reserved for the compiler's own initialisers.
[[gnu::constructor(101)]] void refuseOlderProcessor() {
  // What x86-64-v3 and v4 add (System V ABI, AMD64 supplement, table 3.1) and g++ may use anywhere. glibc's
  // list, rather than the processor's own, also knows what the system does not enable.
  const struct {
    const char* name;
    bool active;
  } features[] = {
    {"AVX2", x86_cpu_active(x86_cpu_AVX2)},
    {"FMA", x86_cpu_active(x86_cpu_FMA)},
    {"BMI1", x86_cpu_active(x86_cpu_BMI1)},
    {"BMI2", x86_cpu_active(x86_cpu_BMI2)},
    {"F16C", x86_cpu_active(x86_cpu_F16C)},
    {"LZCNT", x86_cpu_active(x86_cpu_LZCNT)},
    {"MOVBE", x86_cpu_active(x86_cpu_MOVBE)},
#if LIGHTVANE_X86_64_LEVEL >= 4
    {"AVX512F", x86_cpu_active(x86_cpu_AVX512F)},
    {"AVX512BW", x86_cpu_active(x86_cpu_AVX512BW)},
    {"AVX512CD", x86_cpu_active(x86_cpu_AVX512CD)},
    {"AVX512DQ", x86_cpu_active(x86_cpu_AVX512DQ)},
    {"AVX512VL", x86_cpu_active(x86_cpu_AVX512VL)},
#endif
  };
  for (const auto& feature : features) {
    if (feature.active) continue;
    print("lightvane: this build needs a processor with ");
    print(feature.name);
    print(LIGHTVANE_X86_64_LEVEL >= 4 ? " (x86-64-v4)" : " (x86-64-v3)");
    print(", and this machine has none. Delete the folder build/release and start ./run here: ");
    print("it builds for the machine it runs on.\n");
    _exit(2);
  }
}

}  // namespace

#endif
