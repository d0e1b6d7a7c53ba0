#include "core/base/number_text.h"

#include <gtest/gtest.h>

namespace lightvane {
namespace {

TEST(NumberText, DurationsRead) {
  EXPECT_EQ(durationText(0.0004), "0 ms");
  EXPECT_EQ(durationText(0.85), "850 ms");
  EXPECT_EQ(durationText(0.9999), "1.0 s");
  EXPECT_EQ(durationText(59.99), "1 min 00 s");
  EXPECT_EQ(durationText(245.0), "4 min 05 s");
  EXPECT_EQ(durationText(3599.9), "1 h 00 min");
  EXPECT_EQ(durationText(12000.0), "3 h 20 min");
}

TEST(NumberText, CountsRead) {
  EXPECT_EQ(shortCount(0), "0");
  EXPECT_EQ(shortCount(999), "999");
  EXPECT_EQ(shortCount(1000), "1.00 k");
  EXPECT_EQ(shortCount(12345), "12.3 k");
  EXPECT_EQ(shortCount(999999), "1.00 M");
  EXPECT_EQ(shortCount(4.56e9), "4.56 G");
}

TEST(NumberText, BytesRead) {
  EXPECT_EQ(byteText(0), "0 B");
  EXPECT_EQ(byteText(1024), "1.02 kB");
  EXPECT_EQ(byteText(312'000'000), "312 MB");
  EXPECT_EQ(byteText(24'000'000'000), "24.0 GB");
}

TEST(NumberText, CountsHaveTheirThousandsApart) {
  EXPECT_EQ(countText(0), "0");
  EXPECT_EQ(countText(999), "999");
  EXPECT_EQ(countText(12000), "12,000");
  EXPECT_EQ(countText(1234567), "1,234,567");
}

TEST(NumberText, NumbersAreShort) {
  EXPECT_EQ(shortNumber(0.012345), "0.01235");
  EXPECT_EQ(shortNumber(20000.0), "20000");
  EXPECT_EQ(shortNumber(-0.5), "-0.5");
  EXPECT_EQ(shortNumber(0.0), "0");
}

}  // namespace
}  // namespace lightvane
