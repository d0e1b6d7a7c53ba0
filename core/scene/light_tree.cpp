#include "core/scene/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "core/base/overloaded.h"

namespace lightvane {
namespace {

/// A group is near, and its parts are looked at, where its radius is more than this part of the distance:
/// among what is farther, 1 / d^2 differs by a factor of 2.3 at most. Of a street with 500 lights, the
/// variance of one light's contribution is 1.28 times that of a choice by each light's importance; with
/// 0.3, 1.46.
constexpr float kNear = 0.2f;
/// Of all that is near and far. What is left then is taken together, however near.
constexpr std::size_t kMostParts = 128;

/// Of what can hardly be seen, nothing is looked at: its parts are as dark.
constexpr float kWorthAPart = 0.05f;

float seenOf(LightTree::Sight sight, std::size_t group) { return sight.empty() ? 1.0f : sight[group]; }

/// What is left of a random number that chose a part of [0, 1): as random as it was.
float restOf(float u, float begin, float width) {
  return std::clamp((u - begin) / width, 0.0f, 1.0f - 0x1p-24f);
}

/// Keeps quotients finite where lights lie in one place.
constexpr float kLeastSquare = std::numeric_limits<float>::min();

/// Of what shines at all, never nothing.
float brightestOf(const Rgb& radiance, float area) {
  const float most = maxComponent(radiance);
  return most > 0.0f ? std::max(area * most, std::numeric_limits<float>::min()) : 0.0f;
}

/// Node::intensity of one light; 0 of what is infinitely far away.
float intensityOf(const Light& light) {
  return std::visit(Overloaded{[](const PointLight& l) { return brightestOf(l.intensity, 1.0f); },
                               [](const SpotLight& l) { return brightestOf(l.intensity, 1.0f); },
                               [](const DirectionalLight&) { return 0.0f; },
                               [](const VolumicSphereLight& l) {
                                 return brightestOf(l.intensity, static_cast<float>(l.points.size()));
                               },
                               [](const AreaLight& l) {
                                 // Seen from any side, half of a closed surface at most, and never more than
                                 // fills its bounds.
                                 const auto area = static_cast<float>(l.totalArea);
                                 return brightestOf(l.radiance, std::min(area, kPi * square(l.boundRadius)));
                               },
                               [](const EnvironmentLight&) { return 0.0f; }},
                    light);
}

/// Where a light is; nothing of what is infinitely far away.
std::optional<Ball> placeOf(const Light& light) {
  using Place = std::optional<Ball>;
  return std::visit(Overloaded{[](const PointLight& l) -> Place {
                                 return Ball{l.position, 0.0f};
                               },
                               [](const SpotLight& l) -> Place {
                                 return Ball{l.position, 0.0f};
                               },
                               [](const DirectionalLight&) -> Place { return std::nullopt; },
                               [](const VolumicSphereLight& l) -> Place {
                                 return ballOf(l.points, [](const Vec3& p) { return p; });
                               },
                               [](const AreaLight& l) -> Place {
                                 return Ball{l.boundCenter, l.boundRadius};
                               },
                               [](const EnvironmentLight&) -> Place { return std::nullopt; }},
                    light);
}

}  // namespace

/// What a point chooses among, and the sum of its weights.
class LightTree::Parts {
 public:
  Parts(const LightTree& tree, std::span<const Light> lights, const Vec3& point, const Vec3& normal,
        Sight sight) {
    if (tree.count_ <= kMostOneByOne) {
      for (std::uint32_t light = 0; light < tree.count_; ++light)
        add({Part::OfLight, light, lightImportance(lights[light], point, normal)});
      return;
    }
    if (!tree.distant_.empty()) {
      const float sum = tree.distantImportance(lights, point, normal);
      add({Part::Distant, 0, sum * seenOf(sight, kDistantGroup)});
    }
    if (tree.nodes_.empty()) return;
    std::array<std::uint32_t, kMostParts> open;
    std::size_t openCount = 0;
    open[openCount++] = 0;
    while (openCount > 0) {
      const std::uint32_t number = open[--openCount];
      const Node& node = tree.nodes_[number];
      const Vec3 away = node.centre - point;
      const bool isNear = square(node.radius) > square(kNear) * glm::dot(away, away);
      if (!node.isLeaf() && isNear && count_ + openCount + 2 <= kMostParts &&
          seenOf(sight, node.group) >= kWorthAPart) {
        open[openCount++] = node.right;
        open[openCount++] = node.left;
      } else {
        add({Part::OfNode, number, tree.weightOf(lights, node, point, normal, sight)});
      }
    }
  }

  std::span<const Part> parts() const { return {parts_.data(), count_}; }
  float total() const { return total_; }

 private:
  void add(const Part& part) {
    total_ += part.weight;
    parts_[count_++] = part;
  }

  std::array<Part, kMostParts> parts_;  // not cleared: that would be 1.5 kB for every vertex of a path
  std::size_t count_ = 0;
  float total_ = 0.0f;
};

LightTree::LightTree(std::span<const Light> lights)
    : places_(lights.size(), kNoPlace), count_(lights.size()) {
  std::vector<Ball> balls(lights.size());
  for (std::uint32_t light = 0; light < lights.size(); ++light) {
    const std::optional<Ball> place = placeOf(lights[light]);
    if (place) balls[light] = *place;
    (place ? order_ : distant_).push_back(light);
  }
  if (order_.empty() || count_ <= kMostOneByOne) return;
  nodes_.reserve(2 * order_.size());
  build(balls, 0, static_cast<std::uint32_t>(order_.size()), 0);
  for (std::uint32_t i = 0; i < order_.size(); ++i) places_[order_[i]] = i;
  relight(lights);
}

std::uint32_t LightTree::build(std::span<const Ball> balls, std::uint32_t first, std::uint32_t last,
                               std::uint32_t group) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  const auto begin = order_.begin() + first, end = order_.begin() + last;
  Bounds bounds;
  for (auto light = begin; light != end; ++light) {
    const Ball& ball = balls[*light];
    bounds.add(ball.centre - Vec3(ball.radius));
    bounds.add(ball.centre + Vec3(ball.radius));
  }
  Node node;
  node.first = first;
  node.last = last;
  node.group = group;
  node.centre = bounds.centre();
  for (auto light = begin; light != end; ++light) {
    const Ball& ball = balls[*light];
    node.radius = std::max(node.radius, glm::length(ball.centre - node.centre) + ball.radius);
  }
  node.radius *= 1.0f + 0x1p-20f;
  if (last - first > 1) {
    const Vec3 extent = bounds.upper - bounds.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::uint32_t middle = first + (last - first) / 2;
    // Lights at the same place stay in the order of their numbers, so that the tree is the same everywhere.
    std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(balls[a].centre[axis], a) < std::pair(balls[b].centre[axis], b);
    });
    constexpr std::uint32_t kFirstOfLastLevel = kGroups / 2 - 1;
    const bool isDeepest = group >= kFirstOfLastLevel;
    node.left = build(balls, first, middle, isDeepest ? group : 2 * group + 1);
    node.right = build(balls, middle, last, isDeepest ? group : 2 * group + 2);
  }
  nodes_[number] = node;
  return number;
}

void LightTree::relight(std::span<const Light> lights) {
  groupIntensities_.assign(kGroups, 0.0f);
  // Children come after their parents, so that a group is left with what its own node has.
  for (std::size_t number = nodes_.size(); number-- > 0;) {
    Node& node = nodes_[number];
    node.intensity = node.isLeaf() ? intensityOf(lights[order_[node.first]])
                                   : nodes_[node.left].intensity + nodes_[node.right].intensity;
    groupIntensities_[node.group] = node.intensity;
  }
}

std::size_t LightTree::groupOf(std::uint32_t light) const {
  if (nodes_.empty()) return distant_.empty() || count_ <= kMostOneByOne ? 0 : kDistantGroup;
  const std::uint32_t place = places_[light];
  if (place == kNoPlace) return kDistantGroup;
  const Node* node = &nodes_.front();
  while (!node->isLeaf()) {
    const Node& left = nodes_[node->left];
    node = place < left.last ? &left : &nodes_[node->right];
  }
  return node->group;
}

float LightTree::weightOf(std::span<const Light> lights, const Node& node, const Vec3& point,
                          const Vec3& normal, Sight sight) const {
  const float seen = seenOf(sight, node.group);
  if (node.isLeaf()) return seen * lightImportance(lights[order_[node.first]], point, normal);
  const Vec3 away = node.centre - point;
  const float distance = glm::length(away);
  // Within it, or nearly: nothing is known of where its lights are.
  if (!(distance > node.radius)) return seen * node.intensity / std::max(square(node.radius), kLeastSquare);
  const float sine = node.radius / distance;
  const float cosine =
      greatestCosineInCone(glm::dot(away, normal) / distance, sine, std::sqrt(1.0f - square(sine)));
  // What is just below the horizon may be above it but for rounding.
  constexpr float kRounding = 1e-3f;
  return cosine < -kRounding
             ? 0.0f
             : seen * std::max(cosine, kRounding) * node.intensity / std::max(square(distance), kLeastSquare);
}

float LightTree::distantImportance(std::span<const Light> lights, const Vec3& point,
                                   const Vec3& normal) const {
  float sum = 0.0f;
  for (const std::uint32_t light : distant_) sum += lightImportance(lights[light], point, normal);
  return sum;
}

LightTree::Fork LightTree::forkOf(std::span<const Light> lights, const Node& node, const Vec3& point,
                                  const Vec3& normal, Sight sight) const {
  const float left = weightOf(lights, nodes_[node.left], point, normal, sight);
  const float right = weightOf(lights, nodes_[node.right], point, normal, sight);
  const float sum = left + right;
  return sum > 0.0f ? Fork{left / sum, right / sum} : Fork{};
}

std::optional<LightTree::Choice> LightTree::choose(std::span<const Light> lights, const Vec3& point,
                                                   const Vec3& normal, float u, Sight sight) const {
  const Parts parts(*this, lights, point, normal, sight);
  if (!(parts.total() > 0.0f)) return std::nullopt;
  float threshold = u * parts.total();
  const Part* chosen = nullptr;
  for (const Part& part : parts.parts()) {
    if (part.weight <= 0.0f) continue;
    chosen = &part;
    if (threshold < part.weight) break;
    threshold -= part.weight;
  }
  if (chosen == nullptr) return std::nullopt;
  auto choice = chooseOf(*chosen, lights, point, normal, restOf(threshold, 0.0f, chosen->weight), sight);
  if (choice) choice->probability *= chosen->weight / parts.total();
  if (!choice || !(choice->probability > 0.0f)) return std::nullopt;
  return choice;
}

std::optional<LightTree::Choice> LightTree::chooseOf(const Part& part, std::span<const Light> lights,
                                                     const Vec3& point, const Vec3& normal, float u,
                                                     Sight sight) const {
  switch (part.kind) {
    case Part::OfLight:
      return Choice{part.number, 1.0f};
    case Part::Distant:
      return chooseDistant(lights, point, normal, u);
    case Part::OfNode:
      break;
  }
  return chooseInNode(part.number, lights, point, normal, u, sight);
}

std::optional<LightTree::Choice> LightTree::chooseDistant(std::span<const Light> lights, const Vec3& point,
                                                          const Vec3& normal, float u) const {
  const float sum = distantImportance(lights, point, normal);
  float threshold = u * sum;
  std::optional<Choice> choice;
  for (const std::uint32_t light : distant_) {
    const float here = lightImportance(lights[light], point, normal);
    if (here <= 0.0f) continue;
    choice = {light, here / sum};
    if (threshold < here) break;
    threshold -= here;
  }
  return choice;
}

std::optional<LightTree::Choice> LightTree::chooseInNode(std::uint32_t number, std::span<const Light> lights,
                                                         const Vec3& point, const Vec3& normal, float u,
                                                         Sight sight) const {
  const Node* node = &nodes_[number];
  float probability = 1.0f;
  while (!node->isLeaf()) {
    const Fork fork = forkOf(lights, *node, point, normal, sight);
    if (!(fork.left + fork.right > 0.0f)) return std::nullopt;
    const bool goesLeft = u < fork.left;
    const float share = goesLeft ? fork.left : fork.right;
    u = restOf(u, goesLeft ? 0.0f : fork.left, share);
    probability *= share;
    node = &nodes_[goesLeft ? node->left : node->right];
  }
  if (!(probability > 0.0f)) return std::nullopt;
  return Choice{order_[node->first], probability};
}

float LightTree::probability(std::span<const Light> lights, std::uint32_t light, const Vec3& point,
                             const Vec3& normal, Sight sight) const {
  const float importance = lightImportance(lights[light], point, normal);
  if (!(importance > 0.0f)) return 0.0f;
  const Parts parts(*this, lights, point, normal, sight);
  if (!(parts.total() > 0.0f)) return 0.0f;
  const std::uint32_t place = places_[light];
  const auto holds = [&](const Node& node) { return node.first <= place && place < node.last; };
  for (const Part& part : parts.parts()) {
    const float ofPart = part.weight / parts.total();
    if (part.kind == Part::OfLight && part.number == light) return ofPart;
    if (part.kind == Part::Distant && place == kNoPlace)
      return ofPart * importance / distantImportance(lights, point, normal);
    if (part.kind != Part::OfNode || !holds(nodes_[part.number])) continue;
    float probability = ofPart;
    const Node* node = &nodes_[part.number];
    while (!node->isLeaf()) {
      const Fork fork = forkOf(lights, *node, point, normal, sight);
      const bool goesLeft = holds(nodes_[node->left]);
      probability *= goesLeft ? fork.left : fork.right;
      node = &nodes_[goesLeft ? node->left : node->right];
    }
    return probability;
  }
  return 0.0f;
}

void LightTree::share(std::span<const Light> lights, const Vec3& point, const Vec3& normal, float least,
                      Sight sight, std::vector<Part>& shares) const {
  shares.clear();
  const Parts parts(*this, lights, point, normal, sight);
  if (!(parts.total() > 0.0f)) return;
  for (const Part& part : parts.parts()) {
    const float ofPart = part.weight / parts.total();
    if (part.kind == Part::Distant && ofPart >= least) {
      const float sum = distantImportance(lights, point, normal);
      for (const std::uint32_t light : distant_) {
        const float here = lightImportance(lights[light], point, normal);
        if (here > 0.0f) shares.push_back({Part::OfLight, light, ofPart * here / sum});
      }
    } else if (part.kind == Part::OfNode) {
      divide(part.number, ofPart, lights, point, normal, least, sight, shares);
    } else if (ofPart > 0.0f) {
      shares.push_back({part.kind, part.number, ofPart});
    }
  }
}

void LightTree::divide(std::uint32_t number, float whole, std::span<const Light> lights, const Vec3& point,
                       const Vec3& normal, float least, Sight sight, std::vector<Part>& shares) const {
  if (!(whole > 0.0f)) return;
  const Node& node = nodes_[number];
  if (node.isLeaf()) {
    shares.push_back({Part::OfLight, order_[node.first], whole});
  } else if (whole < least) {
    shares.push_back({Part::OfNode, number, whole});
  } else {
    const Fork fork = forkOf(lights, node, point, normal, sight);
    divide(node.left, whole * fork.left, lights, point, normal, least, sight, shares);
    divide(node.right, whole * fork.right, lights, point, normal, least, sight, shares);
  }
}

}  // namespace lightvane
