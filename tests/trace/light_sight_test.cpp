// What trials say of which lights can be seen from where.

#include "core/trace/light_sight.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace lightvane {
namespace {

/// Two heaps of lamps, 10 apart, of 64 each.
struct TwoHeaps {
  std::vector<Light> lights;
  LightTree tree;

  TwoHeaps() {
    const RandomKey key = randomKey(31);
    for (std::uint32_t i = 0; i < 128; ++i) {
      const Vec3 place(uniform(key, i, 0) + (i < 64 ? -5.0f : 5.0f), uniform(key, i, 1), uniform(key, i, 2));
      lights.emplace_back(PointLight{place, Rgb(1.0f)});
    }
    tree = LightTree(lights);
  }

  /// From `where`, each light of the heap tried so many times.
  void add(std::vector<LightSight::Trial>& trials, const Vec3& where, int heap, int times,
           bool arrives) const {
    for (std::uint32_t i = 0; i < 64; ++i) {
      const auto group = static_cast<std::uint32_t>(tree.groupOf(i + (heap == 0 ? 0U : 64U)));
      trials.insert(trials.end(), static_cast<std::size_t>(times), {where, group, arrives});
    }
  }
  float seen(const LightSight& sight, std::uint32_t light, const Vec3& from) const {
    return sight.at(from)[tree.groupOf(light)];
  }
};

TEST(LightSight, KnowsNothingWithoutTrials) {
  const TwoHeaps heaps;
  EXPECT_TRUE(LightSight().at(Vec3(0.0f)).empty());
  std::vector<LightSight::Trial> few(50, {Vec3(0.0f), 3, true});
  EXPECT_TRUE(LightSight(heaps.tree, few).at(Vec3(0.0f)).empty());
  EXPECT_EQ(LightSight().memoryBytes(), 0u);
}

TEST(LightSight, IsOfEachPlaceItsOwn) {
  const TwoHeaps heaps;
  std::vector<LightSight::Trial> trials;
  const Vec3 left(-5, 0, 0), right(5, 0, 0);
  for (const int heap : {0, 1}) {
    heaps.add(trials, left, heap, 10, heap == 0);
    heaps.add(trials, right, heap, 10, heap == 1);
  }
  const LightSight sight(heaps.tree, trials);
  EXPECT_GT(heaps.seen(sight, 3, left), 0.9f);
  EXPECT_LT(heaps.seen(sight, 3, right), 0.01f);
  EXPECT_LT(heaps.seen(sight, 100, left), 0.01f);
  EXPECT_GT(heaps.seen(sight, 100, right), 0.9f);
  // In between nothing was tried: what is known of all of space.
  EXPECT_NEAR(heaps.seen(sight, 3, Vec3(0.0f)), 0.5f, 0.05f);
  EXPECT_NEAR(sight.at(left)[0], 0.5f, 0.05f) << "half of all can be seen";
  // Beyond what was tried, the nearest place.
  EXPECT_EQ(heaps.seen(sight, 3, Vec3(-1e6f, 3, 1e9f)), heaps.seen(sight, 3, left));
  EXPECT_GT(sight.memoryBytes(), LightTree::kGroups * sizeof(float));
}

TEST(LightSight, TakesWhatWasHardlyTriedForWhatIsAroundIt) {
  const TwoHeaps heaps;
  std::vector<LightSight::Trial> trials;
  // Of the left heap all but one light were tried, often; of the right one, all.
  heaps.add(trials, Vec3(0.0f), 0, 20, false);
  std::erase_if(trials, [&](const LightSight::Trial& trial) { return trial.group == heaps.tree.groupOf(7); });
  heaps.add(trials, Vec3(0.0f), 1, 20, true);
  const LightSight sight(heaps.tree, trials);
  EXPECT_LT(heaps.seen(sight, 7, Vec3(0.0f)), 0.02f) << "not as if it were in the open";
  EXPECT_GE(heaps.seen(sight, 7, Vec3(0.0f)), LightSight::kLeast);
}

TEST(LightSight, LeavesWhatWasNeverSeenAChance) {
  const TwoHeaps heaps;
  std::vector<LightSight::Trial> trials;
  for (const int heap : {0, 1}) heaps.add(trials, Vec3(1.0f), heap, 1000, false);
  const LightSight sight(heaps.tree, trials);
  for (const float part : sight.at(Vec3(1.0f))) EXPECT_GE(part, LightSight::kLeast);
  EXPECT_EQ(heaps.seen(sight, 9, Vec3(1.0f)), LightSight::kLeast);
}

}  // namespace
}  // namespace lightvane
