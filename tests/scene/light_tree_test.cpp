#include "core/scene/light_tree.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

// How a tree chooses among lights, held against what it says of its choices and against each light's
// importance.

namespace lightvane {
namespace {

Vec3 placeInBox(RandomKey key, std::uint32_t i, const Vec3& extent) {
  return extent * (Vec3(uniform(key, i, 0), uniform(key, i, 1), uniform(key, i, 2)) - Vec3(0.5f));
}

/// Lights of all kinds along a street, each of its own brightness.
std::vector<Light> street(std::uint32_t count, float length = 40.0f) {
  std::vector<Light> lights;
  const RandomKey key = randomKey(11);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 place = placeInBox(key, i, {length, 1.0f, 2.0f});
    const Rgb power = Rgb(1.0f, 0.5f, 0.2f) * (0.1f + uniform(key, i, 3));
    AreaLight area;
    switch (i % 6) {
      case 0:
        lights.emplace_back(PointLight{place, power});
        break;
      case 1:
        lights.emplace_back(SpotLight{place, {0, -1, 0}, power, 0.9f, 0.5f});
        break;
      case 2:
        lights.emplace_back(VolumicSphereLight{{place, place + Vec3(0.1f)}, power});
        break;
      case 3:
        area.spheres.push_back({place, 0.05f});
        break;
      case 4:
        area.discs.push_back({place, {0, -1, 0}, 0.1f});
        break;
      default:
        area.triangles.push_back(
            {place, place + Vec3(0.2f, 0, 0), place + Vec3(0, 0, 0.2f), {0, -1, 0}, 0.02f});
        break;
    }
    if (i % 6 < 3) continue;
    area.radiance = 10.0f * power;
    area.finish();
    lights.emplace_back(std::move(area));
  }
  if (count > 100) {
    lights.emplace_back(DirectionalLight{glm::normalize(Vec3(0.2f, 1, 0)), Rgb(0.3f), 1.0});
    lights.emplace_back(DirectionalLight{glm::normalize(Vec3(-0.2f, 1, 0)), Rgb(0.1f), 0.99});
  }
  return lights;
}

struct Receiver {
  Vec3 point, normal;
};
std::vector<Receiver> receivers(std::uint32_t count) {
  std::vector<Receiver> all;
  for (std::uint32_t i = 0; i < count; ++i) {
    const RandomKey key = randomKey(12);
    all.push_back({placeInBox(key, i, {40, 2, 4}), glm::normalize(placeInBox(key.with(1U), i, Vec3(1.0f)))});
  }
  return all;
}

TEST(LightTree, ChoosesAsOftenAsItSays) {
  for (const std::uint32_t count : {1U, 20U, 33U, 300U}) {
    const std::vector<Light> lights = street(count);
    const LightTree tree(lights);
    for (const auto& [point, normal] : receivers(20)) {
      constexpr std::uint32_t kDraws = 20'000;
      std::vector<int> drawn(lights.size());
      for (std::uint32_t i = 0; i < kDraws; ++i) {
        // Strata: a light's number of draws is within two or so a stretch of u that it has.
        const auto choice =
            tree.choose(lights, point, normal, (static_cast<float>(i) + 0.5f) / static_cast<float>(kDraws));
        if (!choice) continue;
        ++drawn[choice->light];
        const float said = tree.probability(lights, choice->light, point, normal);
        ASSERT_NEAR(choice->probability, said, 1e-5f * said) << count << " lights, light " << choice->light;
      }
      double sum = 0.0;
      for (std::uint32_t light = 0; light < lights.size(); ++light) {
        const double probability = static_cast<double>(tree.probability(lights, light, point, normal));
        sum += probability;
        EXPECT_NEAR(drawn[light], kDraws * probability, 3.0 + 0.01 * kDraws * probability)
            << count << " lights, light " << light;
      }
      EXPECT_LT(sum, 1.0 + 1e-5);
    }
  }
}

/// Of each group some part can be seen.
std::vector<float> anySight(std::uint32_t seed) {
  std::vector<float> sight;
  for (std::uint32_t group = 0; group < LightTree::kGroups; ++group)
    sight.push_back(square(square(uniform(randomKey(13), seed, group))) + 1.0f / 256.0f);
  return sight;
}

TEST(LightTree, ChoosesByWhatCanBeSeenAsOftenAsItSays) {
  const std::vector<Light> lights = street(300);
  const LightTree tree(lights);
  std::uint32_t seed = 0;
  int differ = 0;
  for (const auto& [point, normal] : receivers(10)) {
    const std::vector<float> sight = anySight(++seed);
    constexpr std::uint32_t kDraws = 20'000;
    std::vector<int> drawn(lights.size());
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      const auto choice = tree.choose(lights, point, normal,
                                      (static_cast<float>(i) + 0.5f) / static_cast<float>(kDraws), sight);
      if (choice) ++drawn[choice->light];
    }
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
      const double probability = static_cast<double>(tree.probability(lights, light, point, normal, sight));
      EXPECT_NEAR(drawn[light], kDraws * probability, 3.0 + 0.01 * kDraws * probability) << "light " << light;
      const float blind = tree.probability(lights, light, point, normal);
      EXPECT_EQ(probability > 0.0, blind > 0.0f) << "what can hardly be seen keeps its chance";
      differ += std::abs(probability - static_cast<double>(blind)) > 0.3 * static_cast<double>(blind) ? 1 : 0;
    }
  }
  EXPECT_GT(differ, 300) << "it is heeded";
}

TEST(LightTree, DividesWhatLightsMayGiveAsItChooses) {
  for (const std::uint32_t count : {5U, 33U, 300U}) {
    const std::vector<Light> lights = street(count);
    const LightTree tree(lights);
    std::uint32_t seed = 0;
    for (const auto& [point, normal] : receivers(20)) {
      const std::vector<float> sight = anySight(++seed);
      std::vector<LightTree::Part> parts;
      constexpr float kLeast = 0.02f;
      tree.share(lights, point, normal, kLeast, sight, parts);
      std::vector<double> shares(lights.size());
      std::vector<bool> alone(lights.size());
      double sum = 0.0;
      for (const LightTree::Part& part : parts) {
        sum += static_cast<double>(part.weight);
        constexpr std::uint32_t kDraws = 4096;
        for (std::uint32_t i = 0; i < kDraws; ++i) {
          const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(kDraws);
          const auto choice = tree.chooseOf(part, lights, point, normal, u, sight);
          if (!choice) continue;
          alone[choice->light] = part.kind == LightTree::Part::OfLight;
          shares[choice->light] = static_cast<double>(part.weight * choice->probability);
        }
      }
      if (parts.empty()) continue;
      // Less where a group is met of which no light can reach the point.
      EXPECT_LT(sum, 1.0 + 1e-4);
      for (std::uint32_t light = 0; light < lights.size(); ++light) {
        const double probability = static_cast<double>(tree.probability(lights, light, point, normal, sight));
        if (probability >= static_cast<double>(kLeast)) {
          EXPECT_TRUE(alone[light]) << count << " lights, light " << light;
        }
        sum -= probability;
        // What is too rare may not have been drawn.
        if (shares[light] > 0.0 || probability > 1e-3) {
          EXPECT_NEAR(shares[light], probability, 1e-4 * probability) << count << " lights, light " << light;
        }
      }
      EXPECT_GT(sum, -1e-4);
    }
  }
}

TEST(LightTree, GroupsLightsThatAreNearEachOther) {
  const std::vector<Light> lights = street(900);
  const LightTree tree(lights);
  std::vector<float> intensities(LightTree::kGroups, 0.0f);
  for (std::uint32_t light = 0; light < lights.size(); ++light) {
    const bool isDistant = std::holds_alternative<DirectionalLight>(lights[light]);
    EXPECT_EQ(tree.groupOf(light) == LightTree::kDistantGroup, isDistant);
    if (isDistant) continue;
    // 900 lights do not all have groups of their own: all are on the last level.
    EXPECT_GE(tree.groupOf(light), LightTree::kGroups / 2 - 1);
    intensities[tree.groupOf(light)] += 1.0f;
  }
  const std::span<const float> told = tree.groupIntensities();
  for (std::size_t group = 0; group < LightTree::kDistantGroup; ++group) {
    if (2 * group + 2 < LightTree::kDistantGroup) {
      EXPECT_FLOAT_EQ(told[group], told[2 * group + 1] + told[2 * group + 2]) << "group " << group;
    } else {
      EXPECT_EQ(told[group] > 0.0f, intensities[group] > 0.0f) << "group " << group;
    }
  }
}

TEST(LightTree, GivesEveryLightThatReachesAChance) {
  const std::vector<Light> lights = street(500);
  const LightTree tree(lights);
  double worst = 0.0, sum = 0.0;
  int reaching = 0, lit = 0;
  for (const auto& [point, normal] : receivers(200)) {
    double total = 0.0;
    for (const Light& light : lights) total += static_cast<double>(lightImportance(light, point, normal));
    lit += total > 0.0 ? 1 : 0;
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
      const double share = static_cast<double>(lightImportance(lights[light], point, normal)) / total;
      if (!(share > 0.0)) continue;
      const double probability = static_cast<double>(tree.probability(lights, light, point, normal));
      ASSERT_GT(probability, 0.0) << "light " << light << " with a share of " << share;
      worst = std::max(worst, share / probability);
      sum += share * share / probability;
      ++reaching;
    }
  }
  EXPECT_GT(reaching, 10'000);
  // 1 where each light had its share exactly: what the choice adds to the noise.
  EXPECT_LT(sum / lit, 1.35);
  EXPECT_LT(worst, 30.0);
}

TEST(LightTree, TakesFewLightsByTheirShares) {
  const std::vector<Light> lights = street(LightTree::kMostOneByOne);
  const LightTree tree(lights);
  for (const auto& [point, normal] : receivers(50)) {
    float total = 0.0f;
    for (const Light& light : lights) total += lightImportance(light, point, normal);
    if (total == 0.0f) continue;
    for (std::uint32_t light = 0; light < lights.size(); ++light)
      EXPECT_FLOAT_EQ(tree.probability(lights, light, point, normal),
                      lightImportance(lights[light], point, normal) / total);
  }
}

TEST(LightTree, IsThatOfItsLightsWhenTheyAreDimmed) {
  std::vector<Light> lights = street(300);
  LightTree tree(lights);
  for (std::size_t i = 0; i < lights.size(); i += 2) {
    if (auto* point = std::get_if<PointLight>(&lights[i])) point->intensity *= 0.0f;
    if (auto* area = std::get_if<AreaLight>(&lights[i])) area->radiance *= 3.0f;
  }
  tree.relight(lights);
  const LightTree fresh(lights);
  for (const auto& [point, normal] : receivers(20)) {
    for (std::uint32_t light = 0; light < lights.size(); ++light)
      EXPECT_EQ(tree.probability(lights, light, point, normal),
                fresh.probability(lights, light, point, normal));
  }
}

TEST(LightTree, StandsLightsInOnePlaceAndNone) {
  EXPECT_FALSE(LightTree().choose({}, Vec3(0.0f), Vec3(0, 1, 0), 0.5f));
  const std::vector<Light> heap(100, PointLight{Vec3(0.25f), Rgb(1.0f)});
  const LightTree tree(heap);
  double sum = 0.0;
  for (std::uint32_t light = 0; light < heap.size(); ++light)
    sum += static_cast<double>(tree.probability(heap, light, Vec3(0.0f), glm::normalize(Vec3(1.0f))));
  EXPECT_NEAR(sum, 1.0, 1e-4);
}

}  // namespace
}  // namespace lightvane
