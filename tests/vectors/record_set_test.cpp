#include <gtest/gtest.h>

#include "core/vectors/snapshot.h"

namespace lightvane {
namespace {

float reachOf(const IndirectLightVector& r) { return r.harmonicMean; }

/// Vectors whose `birth.order` is their number, with keys 0 to 2.
std::vector<IndirectLightVector> vectors(std::uint32_t first, std::uint32_t count) {
  const RandomKey key = randomKey(81);
  std::vector<IndirectLightVector> made;
  for (std::uint32_t i = first; i < first + count; ++i) {
    IndirectLightVector r;
    r.point.position = {uniform(key, i, 0), uniform(key, i, 1), uniform(key, i, 2)};
    r.point.key = static_cast<SurfaceKey>(3.0f * uniform(key, i, 3));
    r.harmonicMean = 0.1f * uniform(key, i, 4);
    r.birth.order = i;
    made.push_back(r);
  }
  return made;
}

using Set = RecordSet<IndirectLightVector>;

void expectLikeTheLoop(const Set& set) {
  const RandomKey key = randomKey(82);
  std::vector<std::uint32_t> found;
  for (std::uint32_t q = 0; q < 30; ++q) {
    const Vec3 centre(uniform(key, q, 0), uniform(key, q, 1), uniform(key, q, 2));
    const float radius = 0.1f * uniform(key, q, 3);
    for (SurfaceKey surface = 0; surface < 4; ++surface) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < set.size(); ++i) {
        if (set[i].point.key != surface) continue;
        const Vec3 difference = set[i].point.position - centre;
        if (glm::dot(difference, difference) <= square(radius + reachOf(set[i]))) expected.push_back(i);
      }
      set.query(surface, centre, radius, found);
      ASSERT_EQ(found, expected) << set.size() << " vectors, query " << q << ", key " << surface;
    }
  }
}

TEST(RecordSet, KeepsNumbersAndAnswersLikeALoopHoweverItGrew) {
  Set set;
  EXPECT_TRUE(set.empty());
  expectLikeTheLoop(set);
  std::uint32_t count = 0;
  for (const std::uint32_t added : {1u, 1u, 1u, 100u, 1u, 50u, 0u, 7u, 400u, 3u, 3u}) {
    set = set.with(vectors(count, added), reachOf);
    count += added;
    ASSERT_EQ(set.size(), count);
    for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(set[i].birth.order, i);
    expectLikeTheLoop(set);
  }
}

TEST(RecordSet, LeavesTheOlderOneAsItWas) {
  const Set before = Set().with(vectors(0, 20), reachOf);
  const Set after = before.with(vectors(20, 20), reachOf);
  EXPECT_EQ(before.size(), 20u);
  EXPECT_EQ(after.size(), 40u);
  for (std::uint32_t i = 0; i < 20; ++i) EXPECT_EQ(before[i].birth.order, i);
  expectLikeTheLoop(before);
  expectLikeTheLoop(after);
}

// Each chunk holds more than twice the next one, so that there are at most log2 of them, and every vector is
// copied at most about that often.
TEST(RecordSet, MergesChunksSoThatTheirNumberIsLogarithmic) {
  Set set;
  std::size_t most = 0;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    set = set.with(vectors(i, 1), reachOf);
    most = std::max(most, set.chunkCount());
    ASSERT_LE(set.chunkCount(), 1 + static_cast<std::size_t>(std::log2(static_cast<double>(i + 1))));
  }
  EXPECT_GT(most, 2u) << "one chunk, copied each time, would be quadratic";
  for (std::uint32_t i = 0; i < 4000; ++i) ASSERT_EQ(set[i].birth.order, i);
  // Chunks that are shared are not copied: the great one stays where it is.
  const Set big = Set().with(vectors(0, 1000), reachOf);
  const Set bigger = big.with(vectors(1000, 10), reachOf);
  EXPECT_EQ(&big[0], &bigger[0]);
  EXPECT_EQ(bigger.chunkCount(), 2u);
}

}  // namespace
}  // namespace lightvane
