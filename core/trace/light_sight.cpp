#include "core/trace/light_sight.h"

#include <algorithm>
#include <array>

namespace lightvane {
namespace {

/// Cells along an edge, from all of space down to the fine ones.
constexpr std::array<std::size_t, 3> kLevels = {1, 4, 16};
constexpr std::size_t kFine = kLevels.back();
/// A cell with fewer trials says nothing: a coarser one is asked.
constexpr std::uint32_t kEnoughTrials = 128;

std::size_t cube(std::size_t x) { return x * x * x; }

/// A fine cell's place along each axis.
struct CellPlace {
  std::size_t x, y, z;

  static CellPlace ofFine(std::size_t number) {
    return {number % kFine, number / kFine % kFine, number / (kFine * kFine)};
  }
  /// The number of the cell of a level, with so many along an edge, that holds it.
  std::size_t numberIn(std::size_t edge) const {
    return (z * edge / kFine * edge + y * edge / kFine) * edge + x * edge / kFine;
  }
};

/// What a cell's trials came to, by group.
struct Tally {
  std::vector<std::uint32_t> tried, arrived;

  void add(std::uint32_t group, bool hasArrived) {
    if (tried.empty()) {
      tried.assign(LightTree::kGroups, 0);
      arrived.assign(LightTree::kGroups, 0);
    }
    ++tried[group];
    if (hasArrived) ++arrived[group];
  }
  std::uint32_t trials() const {
    std::uint32_t sum = 0;
    for (const std::uint32_t n : tried) sum += n;
    return sum;
  }
};

constexpr std::size_t parentOf(std::size_t group) { return (group - 1) / 2; }

/// What part of each group can be seen from a cell with such a tally, of larger groups only as far as their
/// own trials tell. What was seen of a group is counted as one trial more that came out as is to be expected:
/// as the larger group's did, in which each group that was tried counts once, for bright ones are tried more;
/// and no better than the group's own where more is known of it, in the `coarser` cell, which may be empty.
std::vector<float> partsSeen(const Tally& tally, std::span<const float> coarser) {
  std::vector<float> groups(LightTree::kGroups, 0.0f), seen(LightTree::kGroups, 0.0f);
  for (std::size_t group = LightTree::kDistantGroup; group-- > 0;) {
    if (tally.tried[group] > 0) {
      groups[group] += 1.0f;
      seen[group] += static_cast<float>(tally.arrived[group]) / static_cast<float>(tally.tried[group]);
    }
    if (group == 0) continue;
    groups[parentOf(group)] += groups[group];
    seen[parentOf(group)] += seen[group];
  }
  std::vector<float> parts(LightTree::kGroups);
  for (std::size_t group = 0; group < LightTree::kGroups; ++group) {
    const bool hasLarger = group > 0 && group != LightTree::kDistantGroup;
    const float asLarger = hasLarger ? parts[parentOf(group)] : 1.0f;
    const float expected = coarser.empty() ? asLarger : std::min(asLarger, coarser[group]);
    parts[group] = tally.tried[group] > 0 ? (static_cast<float>(tally.arrived[group]) + expected) /
                                                (static_cast<float>(tally.tried[group]) + 1.0f)
                                          : (seen[group] + expected) / (groups[group] + 1.0f);
  }
  return parts;
}

/// What LightSight::at says: of a larger group what its own have, by what they send.
std::vector<float> sightOf(std::vector<float> parts, std::span<const float> intensities) {
  constexpr std::size_t kFirstDeepest = LightTree::kGroups / 2 - 1;
  for (std::size_t group = kFirstDeepest; group-- > 0;) {
    const std::size_t left = 2 * group + 1, right = left + 1;
    const float sum = intensities[left] + intensities[right];
    if (sum > 0.0f)
      parts[group] = (intensities[left] * parts[left] + intensities[right] * parts[right]) / sum;
  }
  for (float& part : parts) part = std::clamp(part, LightSight::kLeast, 1.0f);
  return parts;
}

}  // namespace

LightSight::LightSight(const LightTree& tree, std::span<const Trial> trials) {
  if (trials.size() < kEnoughTrials || tree.groupIntensities().empty()) return;
  Bounds bounds;
  for (const Trial& trial : trials) bounds.add(trial.from);
  origin_ = bounds.lower;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = bounds.upper[axis] - bounds.lower[axis];
    perUnit_[axis] = extent > 0.0f ? static_cast<float>(kFine) / extent : 0.0f;
  }
  std::array<std::vector<Tally>, kLevels.size()> tallies;
  for (std::size_t level = 0; level < kLevels.size(); ++level) tallies[level].resize(cube(kLevels[level]));
  for (const Trial& trial : trials) {
    const CellPlace place = CellPlace::ofFine(cellAt(trial.from));
    for (std::size_t level = 0; level < kLevels.size(); ++level)
      tallies[level][place.numberIn(kLevels[level])].add(trial.group, trial.arrived);
  }
  // Fine cells, as the coarsest has it, and then as each finer one does that knows enough.
  constexpr std::uint32_t kUnknown = 0xffffffffU;
  cells_.assign(cube(kFine), kUnknown);
  std::vector<std::vector<float>> parts;  // of each of sights_
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    std::vector<std::uint32_t> numbers(tallies[level].size(), kUnknown);
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      const std::size_t here = CellPlace::ofFine(cell).numberIn(kLevels[level]);
      const Tally& tally = tallies[level][here];
      if (level > 0 && tally.trials() < kEnoughTrials) continue;
      if (numbers[here] == kUnknown) {
        const std::uint32_t coarser = cells_[cell];
        numbers[here] = static_cast<std::uint32_t>(sights_.size());
        parts.push_back(partsSeen(tally, coarser == kUnknown ? std::span<const float>() : parts[coarser]));
        sights_.push_back(sightOf(parts.back(), tree.groupIntensities()));
      }
      cells_[cell] = numbers[here];
    }
  }
}

std::size_t LightSight::cellAt(const Vec3& place) const {
  constexpr auto kLast = static_cast<float>(kFine - 1);
  const Vec3 cell = glm::clamp((place - origin_) * perUnit_, Vec3(0.0f), Vec3(kLast));
  return (static_cast<std::size_t>(cell.z) * kFine + static_cast<std::size_t>(cell.y)) * kFine +
         static_cast<std::size_t>(cell.x);
}

LightTree::Sight LightSight::at(const Vec3& place) const {
  if (cells_.empty()) return {};
  return sights_[cells_[cellAt(place)]];
}

std::size_t LightSight::memoryBytes() const {
  return cells_.size() * sizeof(cells_[0]) + sights_.size() * LightTree::kGroups * sizeof(float);
}

}  // namespace lightvane
