#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "core/scene/lights.h"

namespace lightvane {

/// A tree over many lights, which chooses one of them by what it may give a point: lightImportance() of
/// lights that are near, and of far ones that of the group they belong to, so that the time grows as the
/// logarithm of the lights where these lie apart. Whatever light can reach the point has a chance. Up to
/// kMostOneByOne lights are all taken as near.
///
/// Where walls stand is told it by `sight`: for each of kGroups groups of lights, what part of them can be
/// seen from about the point (LightSight). That changes how likely a light is, never whether it has a chance.
/// Empty: all of them.
///
/// Immutable but for relight(); any thread. Refers to no light: those that it was made of are given again.
class LightTree {
 public:
  static constexpr std::size_t kMostOneByOne = 8;

  /// Levels of nodes that are groups of their own: what lies deeper belongs to the one above it.
  static constexpr std::uint32_t kGroupLevels = 9;
  /// Group i holds 2 i + 1 and 2 i + 2; the last one has the lights that are infinitely far away.
  static constexpr std::size_t kGroups = std::size_t{1} << kGroupLevels;
  static constexpr std::size_t kDistantGroup = kGroups - 1;
  /// The part of a group that can be seen; in (0, 1].
  using Sight = std::span<const float>;

  LightTree() = default;
  explicit LightTree(std::span<const Light> lights);

  /// The same tree for lights that differ from the tree's in their radiance alone.
  void relight(std::span<const Light> lights);

  struct Choice {
    std::uint32_t light = 0;
    float probability = 0.0f;  ///< above 0
  };
  /// By `u` in [0, 1). Nothing where no light can reach a surface at `point` of this unit normal; also, and
  /// rarely, where none of the group can that was chosen.
  std::optional<Choice> choose(std::span<const Light> lights, const Vec3& point, const Vec3& normal, float u,
                               Sight sight = {}) const;
  /// The probability with which choose() takes this light.
  float probability(std::span<const Light> lights, std::uint32_t light, const Vec3& point, const Vec3& normal,
                    Sight sight = {}) const;

  /// What is chosen among: a node, a light, or all lights that are infinitely far away.
  struct Part {
    enum Kind : std::uint8_t { OfNode, OfLight, Distant } kind;
    std::uint32_t number;  ///< of the node or the light
    float weight;
  };
  /// Divides what all lights may give the point among lights with a share of at least `least` of it, each by
  /// itself, and groups of those with less. `shares`: first emptied; their weights, which add up to 1 or
  /// less, are the probabilities that choose() takes the light, or one of the group.
  void share(std::span<const Light> lights, const Vec3& point, const Vec3& normal, float least, Sight sight,
             std::vector<Part>& shares) const;
  /// One light of such a part, as choose() would; `probability` is that among the part's.
  std::optional<Choice> chooseOf(const Part& part, std::span<const Light> lights, const Vec3& point,
                                 const Vec3& normal, float u, Sight sight = {}) const;

  /// The group that a light belongs to; also of lights that the tree takes one by one (0).
  std::size_t groupOf(std::uint32_t light) const;
  /// Of each group: W sr^-1 that its lights send to one side at most; 0 where it has none.
  std::span<const float> groupIntensities() const { return groupIntensities_; }

 private:
  /// Of lights with a place, order_[first] up to order_[last].
  struct Node {
    Vec3 centre{0.0f};
    float radius = 0.0f;     ///< all that shines lies within it
    float intensity = 0.0f;  ///< W sr^-1 that its lights send to one side at most, in the strongest colour
    std::uint32_t first = 0, last = 0;
    std::uint32_t left = 0;  ///< number of a child; 0 of a leaf, which has one light
    std::uint32_t right = 0;
    std::uint32_t group = 0;

    bool isLeaf() const { return left == 0; }
  };
  class Parts;
  /// What the lights that are infinitely far away may give together.
  float distantImportance(std::span<const Light> lights, const Vec3& point, const Vec3& normal) const;
  static constexpr std::uint32_t kNoPlace = 0xffffffffU;

  /// `balls` has that of each light with a place, by the light's number.
  std::uint32_t build(std::span<const Ball> balls, std::uint32_t first, std::uint32_t last,
                      std::uint32_t group);
  /// What the node's lights may give the point, by bound or, of one, by importance.
  float weightOf(std::span<const Light> lights, const Node& node, const Vec3& point, const Vec3& normal,
                 Sight sight) const;
  /// The shares of a node's children in what it has.
  struct Fork {
    float left = 0.0f, right = 0.0f;
  };
  Fork forkOf(std::span<const Light> lights, const Node& node, const Vec3& point, const Vec3& normal,
              Sight sight) const;
  void divide(std::uint32_t number, float whole, std::span<const Light> lights, const Vec3& point,
              const Vec3& normal, float least, Sight sight, std::vector<Part>& shares) const;
  std::optional<Choice> chooseInNode(std::uint32_t number, std::span<const Light> lights, const Vec3& point,
                                     const Vec3& normal, float u, Sight sight) const;
  std::optional<Choice> chooseDistant(std::span<const Light> lights, const Vec3& point, const Vec3& normal,
                                      float u) const;

  std::vector<Node> nodes_;  ///< the root first; children come after their parents
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> places_;   ///< for each light where order_ has it; kNoPlace where it has none
  std::vector<std::uint32_t> distant_;  ///< lights without a place
  std::vector<float> groupIntensities_;
  std::size_t count_ = 0;
};

}  // namespace lightvane
