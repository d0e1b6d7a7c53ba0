#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace lightvane {

/// A sphere in which something is valid.
struct TreeEntry {
  Vec3 position;
  float radius;

  bool meets(const Ball& ball) const {
    const Vec3 away = position - ball.centre;
    const float together = ball.radius + radius;
    return glm::dot(away, away) <= together * together;
  }
};

/// A kd-tree (the paper's [Ben75]) over points that each reach as far as their own radius: every node knows
/// the box of its points and the largest of their radii. Immutable; the same entries give the same tree.
class RecordTree {
 public:
  RecordTree() = default;
  explicit RecordTree(std::span<const TreeEntry> entries);

  std::size_t size() const { return entries_.size(); }

  /// Calls visit(index) for every entry whose sphere meets the ball (centre, radius), in no particular order.
  /// Cost: logarithmic in the number of entries, linear in the number found.
  template <class Visit>
  void query(const Vec3& centre, float radius, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::uint32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      const Vec3 outside = glm::max(glm::max(node.lower - centre, centre - node.upper), Vec3(0.0f));
      const float reach = radius + node.largestRadius;
      if (glm::dot(outside, outside) > reach * reach) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          if (entries_[i].meets({centre, radius})) visit(indices_[i]);
        }
      } else {
        stack[depth++] = node.first;
        stack[depth++] = node.first + 1;
      }
    }
  }

 private:
  struct Node {
    Vec3 lower;
    Vec3 upper;
    float largestRadius;
    std::uint32_t first;  ///< of its entries, or its left child; the right one follows
    std::uint32_t count;  ///< 0 for an inner node
  };
  std::vector<Node> nodes_;
  std::vector<TreeEntry> entries_;  ///< in the order of the leaves
  std::vector<std::uint32_t> indices_;
};

}  // namespace lightvane
