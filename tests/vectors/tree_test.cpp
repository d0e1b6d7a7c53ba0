#include "core/vectors/tree.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"

// The tree against a loop over all entries, with the same arithmetic: equal, not similar.

namespace lightvane {
namespace {

std::vector<std::uint32_t> ask(const RecordTree& tree, const Vec3& centre, float radius) {
  std::vector<std::uint32_t> found;
  tree.query(centre, radius, [&](std::uint32_t i) { found.push_back(i); });
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::uint32_t> loop(const std::vector<TreeEntry>& entries, const Vec3& centre, float radius) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const Vec3 difference = entries[i].position - centre;
    if (glm::dot(difference, difference) <= square(radius + entries[i].radius)) found.push_back(i);
  }
  return found;
}

Vec3 randomPoint(RandomKey key, std::uint32_t i, std::uint32_t dimension) {
  return {uniform(key, i, dimension), uniform(key, i, dimension + 1), uniform(key, i, dimension + 2)};
}

/// Balls in and about the unit cube, points among them, and some that sit on an entry.
void expectLikeTheLoop(const std::vector<TreeEntry>& entries, const char* what) {
  const RecordTree tree(entries);
  EXPECT_EQ(tree.size(), entries.size());
  const RandomKey key = randomKey(31);
  std::size_t total = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    Vec3 centre = 1.4f * randomPoint(key, i, 0) - 0.2f;
    if (i % 5 == 0 && !entries.empty()) centre = entries[i % entries.size()].position;
    const float radius = i % 3 == 0 ? 0.0f : 0.2f * square(uniform(key, i, 3));
    const std::vector<std::uint32_t> expected = loop(entries, centre, radius);
    ASSERT_EQ(ask(tree, centre, radius), expected) << what << ", query " << i;
    total += expected.size();
  }
  if (!entries.empty()) {
    EXPECT_GT(total, 0u) << what;
  }
}

std::vector<TreeEntry> randomEntries(std::uint32_t count, std::uint64_t seed) {
  std::vector<TreeEntry> entries;
  const RandomKey key = randomKey(seed);
  for (std::uint32_t i = 0; i < count; ++i) {
    // Radii over three decades: a few reach far beyond their leaf.
    entries.push_back({randomPoint(key, i, 0), 0.3f * std::pow(10.0f, -3.0f * uniform(key, i, 3))});
  }
  return entries;
}

TEST(RecordTree, GivesWhatALoopGives) {
  for (const std::uint32_t count : {1u, 2u, 8u, 9u, 17u, 100u, 3000u}) {
    expectLikeTheLoop(randomEntries(count, count), "random");
  }
}

TEST(RecordTree, OfNothingFindsNothing) {
  EXPECT_EQ(RecordTree().size(), 0u);
  EXPECT_TRUE(ask(RecordTree(), Vec3(0.0f), kInfinity).empty());
  expectLikeTheLoop({}, "empty");
}

TEST(RecordTree, BearsPointsThatAreAllEqualOrInLine) {
  std::vector<TreeEntry> equal = randomEntries(500, 5);
  for (TreeEntry& entry : equal) entry.position = Vec3(0.25f, 0.5f, 0.75f);
  expectLikeTheLoop(equal, "all equal");
  std::vector<TreeEntry> line = randomEntries(500, 6);
  for (TreeEntry& entry : line) entry.position = entry.position.x * Vec3(1.0f, 0.5f, 0.25f);
  expectLikeTheLoop(line, "collinear");
  std::vector<TreeEntry> plane = randomEntries(500, 7);
  for (TreeEntry& entry : plane) entry.position.y = 0.5f;
  expectLikeTheLoop(plane, "coplanar");
  std::vector<TreeEntry> twice = randomEntries(300, 8);
  twice.insert(twice.end(), twice.begin(), twice.end());
  expectLikeTheLoop(twice, "each twice");
}

TEST(RecordTree, BearsRadiiOfZeroAndInfinity) {
  std::vector<TreeEntry> zero = randomEntries(300, 9);
  for (TreeEntry& entry : zero) entry.radius = 0.0f;
  expectLikeTheLoop(zero, "zero");
  std::vector<TreeEntry> mixed = randomEntries(300, 10);
  for (std::size_t i = 0; i < mixed.size(); i += 50) mixed[i].radius = kInfinity;
  expectLikeTheLoop(mixed, "some infinite");
  EXPECT_EQ(ask(RecordTree(mixed), Vec3(1e6f), 0.0f).size(), 6u) << "an infinite radius reaches anywhere";
  for (TreeEntry& entry : mixed) entry.radius = kInfinity;
  expectLikeTheLoop(mixed, "all infinite");
}

TEST(RecordTree, IsAFunctionOfItsEntries) {
  const std::vector<TreeEntry> entries = randomEntries(1000, 11);
  const RecordTree one(entries), other(entries);
  for (std::uint32_t i = 0; i < 50; ++i) {
    std::vector<std::uint32_t> a, b;
    const Vec3 centre = randomPoint(randomKey(12), i, 0);
    one.query(centre, 0.1f, [&](std::uint32_t n) { a.push_back(n); });
    other.query(centre, 0.1f, [&](std::uint32_t n) { b.push_back(n); });
    EXPECT_EQ(a, b) << "even in the order of visits";
  }
}

}  // namespace
}  // namespace lightvane
