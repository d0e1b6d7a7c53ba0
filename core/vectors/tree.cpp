#include "core/vectors/tree.h"

#include <algorithm>
#include <numeric>

namespace lightvane {
namespace {

constexpr std::uint32_t kLeafSize = 8;

}  // namespace

RecordTree::RecordTree(std::span<const TreeEntry> entries) {
  if (entries.empty()) return;
  indices_.resize(entries.size());
  std::iota(indices_.begin(), indices_.end(), 0u);
  nodes_.reserve(entries.size() / kLeafSize * 4 + 4);
  nodes_.emplace_back();
  struct Task {
    std::uint32_t node, begin, end;
  };
  std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(entries.size())}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Bounds bounds;
    float largest = 0.0f;
    for (std::uint32_t i = task.begin; i < task.end; ++i) {
      bounds.add(entries[indices_[i]].position);
      largest = std::max(largest, entries[indices_[i]].radius);
    }
    const std::uint32_t count = task.end - task.begin;
    if (count <= kLeafSize) {
      nodes_[task.node] = {bounds.lower, bounds.upper, largest, task.begin, count};
      continue;
    }
    const Vec3 extent = bounds.upper - bounds.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::uint32_t middle = task.begin + count / 2;
    // Split by number, not by place: equal and collinear points still halve. Ties go by index, so that the
    // tree is a function of its entries.
    std::nth_element(indices_.begin() + task.begin, indices_.begin() + middle, indices_.begin() + task.end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const float pa = entries[a].position[axis];
                       const float pb = entries[b].position[axis];
                       return pa < pb || (pa == pb && a < b);
                     });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[task.node] = {bounds.lower, bounds.upper, largest, left, 0};
    nodes_.resize(nodes_.size() + 2);
    tasks.push_back({left, task.begin, middle});
    tasks.push_back({left + 1, middle, task.end});
  }
  entries_.reserve(entries.size());
  for (const std::uint32_t index : indices_) entries_.push_back(entries[index]);
}

}  // namespace lightvane
