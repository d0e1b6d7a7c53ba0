#include "core/scene/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <ranges>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "core/base/math.h"

namespace lightvane {
namespace {

// Trees may be as deep as a file is long: all walks here have a stack of their own.

constexpr int kNoParent = -1;

std::string nodeName(const GltfFile& file, int node) {
  return gltfName("node", node, file.model.nodes[static_cast<std::size_t>(node)].name);
}

/// Each node's parent, or kNoParent.
Expected<std::vector<int>> parentsOf(const GltfFile& file) {
  std::vector<int> parents(file.model.nodes.size(), kNoParent);
  for (std::size_t i = 0; i < parents.size(); ++i) {
    for (const int child : file.model.nodes[i].children) {
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent != kNoParent)
        return file.error(
            fmt::format("{} has two parents: nodes {} and {}", nodeName(file, child), parent, i));
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

/// Since every node has one parent at most, those that no root leads to lie in circles or below one.
Expected<void> checkForCycles(const GltfFile& file, const std::vector<int>& parents) {
  std::vector<bool> isReached(parents.size());
  std::vector<int> open;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == kNoParent) open.push_back(static_cast<int>(i));
  }
  while (!open.empty()) {
    const auto node = static_cast<std::size_t>(open.back());
    open.pop_back();
    isReached[node] = true;
    for (const int child : file.model.nodes[node].children) open.push_back(child);
  }
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (!isReached[i])
      return file.error(fmt::format("{} is below itself: the nodes above it form a cycle",
                                    nodeName(file, static_cast<int>(i))));
  }
  return {};
}

/// The nodes at the top of the scene that is shown.
Expected<std::vector<int>> rootsOf(const GltfFile& file, const std::vector<int>& parents, GltfNotes& notes) {
  const auto& scenes = file.model.scenes;
  std::vector<int> roots;
  if (scenes.empty()) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] == kNoParent) roots.push_back(static_cast<int>(i));
    }
    return roots;
  }
  const auto shown = static_cast<std::size_t>(std::max(file.model.defaultScene, 0));
  if (scenes.size() > 1)
    notes.unused("scenes beside " + gltfName("scene", static_cast<int>(shown), scenes[shown].name));
  std::vector<bool> isNamed(parents.size());
  for (const int root : scenes[shown].nodes) {
    const auto i = static_cast<std::size_t>(root);
    if (parents[i] != kNoParent)
      return file.error(
          fmt::format("{} is at the top of the scene and below node {}", nodeName(file, root), parents[i]));
    if (isNamed[i]) return file.error(fmt::format("the scene has {} twice", nodeName(file, root)));
    isNamed[i] = true;
    roots.push_back(root);
  }
  return roots;
}

Vec3d vectorOr(const std::vector<double>& numbers, double otherwise) {
  return numbers.empty() ? Vec3d(otherwise) : Vec3d(numbers[0], numbers[1], numbers[2]);
}

/// The node's own transform; an error where its numbers are none.
Expected<glm::dmat4> localTransform(const GltfFile& file, int index) {
  const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(index)];
  const auto wrong = [&](const char* what) { return file.error(nodeName(file, index) + ": " + what); };
  const auto has = [](const std::vector<double>& numbers, std::size_t count) {
    return numbers.empty() || numbers.size() == count;
  };
  if (!node.matrix.empty()) {
    if (node.matrix.size() != 16) return wrong("its matrix is not of 16 numbers");
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    const glm::dvec4 bottom(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    // Exporters write 0 and 1; what a product of theirs leaves of these is rounding.
    if (!(glm::length(bottom - glm::dvec4(0, 0, 0, 1)) < 1e-6))
      return wrong("the last row of its matrix is not 0, 0, 0, 1");
    return matrix;
  }
  if (!has(node.translation, 3)) return wrong("its translation is not of 3 numbers");
  if (!has(node.scale, 3)) return wrong("its scale is not of 3 numbers");
  if (!has(node.rotation, 4)) return wrong("its rotation is not of 4 numbers");
  glm::dmat3 rotation(1.0);
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(glm::length(q) > 0.0) || !std::isfinite(glm::length(q))) return wrong("its rotation has no length");
    rotation = glm::mat3_cast(glm::normalize(q));
  }
  const Vec3d scale = vectorOr(node.scale, 1.0);
  glm::dmat4 matrix(1.0);
  for (int axis = 0; axis < 3; ++axis) matrix[axis] = glm::dvec4(rotation[axis] * scale[axis], 0.0);
  matrix[3] = glm::dvec4(vectorOr(node.translation, 0.0), 1.0);
  return matrix;
}

}  // namespace

Expected<std::vector<GltfPlacedNode>> placeGltfNodes(const GltfFile& file, GltfNotes& notes) {
  const Expected<std::vector<int>> parents = parentsOf(file);
  if (!parents) return tl::unexpected(parents.error());
  if (auto done = checkForCycles(file, *parents); !done) return tl::unexpected(done.error());
  const Expected<std::vector<int>> roots = rootsOf(file, *parents, notes);
  if (!roots) return tl::unexpected(roots.error());

  std::vector<GltfPlacedNode> placed;
  std::vector<GltfPlacedNode> open;  // the next one last, with its parents' transform
  for (const int root : *roots | std::views::reverse) open.push_back({root, glm::dmat4(1.0)});
  while (!open.empty()) {
    const GltfPlacedNode next = open.back();
    open.pop_back();
    const Expected<glm::dmat4> local = localTransform(file, next.node);
    if (!local) return tl::unexpected(local.error());
    placed.push_back({next.node, next.toWorld * *local});
    const std::vector<int>& children = file.model.nodes[static_cast<std::size_t>(next.node)].children;
    for (const int child : children | std::views::reverse) open.push_back({child, placed.back().toWorld});
  }
  return placed;
}

}  // namespace lightvane
