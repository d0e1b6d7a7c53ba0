#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/architecture/command.h"

namespace {

/// Starts the probe on this machine less one of its features: glibc hides from programs what this variable of
/// its own names, which is as near to an older processor as a test gets without one.
CommandOutcome startProbeWithout(const std::string& feature) {
  const std::string hidden = feature.empty() ? "" : "GLIBC_TUNABLES=glibc.cpu.hwcaps=-" + feature + " ";
  return runCommand(hidden + "'" LIGHTVANE_CPU_GUARD_PROBE "' 2>&1");
}

TEST(CpuGuard, LetsTheMachineItWasBuiltOnPass) {
  const CommandOutcome outcome = startProbeWithout("");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.output, "initialised\n");
}

class CpuGuardWithout : public testing::TestWithParam<std::string> {};

TEST_P(CpuGuardWithout, SaysSoAndExitsBeforeAnythingElseRuns) {
#if LIGHTVANE_X86_64_LEVEL == 1
  GTEST_SKIP() << "built for any x86-64: there is nothing to guard";
#endif
  if (GetParam().starts_with("AVX512") && LIGHTVANE_X86_64_LEVEL < 4)
    GTEST_SKIP() << "built without AVX-512: there is nothing to guard";
  const CommandOutcome outcome = startProbeWithout(GetParam());
  EXPECT_EQ(outcome.exitCode, 2) << outcome.output;
  EXPECT_THAT(outcome.output,
              testing::StartsWith("lightvane: this build needs a processor with " + GetParam() + " "));
  EXPECT_THAT(outcome.output, testing::Not(testing::HasSubstr("initialised")));
}

// F16C is missing here alone: glibc 2.36 cannot hide it.
INSTANTIATE_TEST_SUITE_P(EachFeature, CpuGuardWithout,
                         testing::Values("AVX2", "FMA", "BMI1", "BMI2", "LZCNT", "MOVBE", "AVX512F",
                                         "AVX512BW", "AVX512CD", "AVX512DQ", "AVX512VL"),
                         [](const auto& feature) { return feature.param; });

}  // namespace
