#include "core/scene/lit_only_by.h"

#include <map>
#include <set>
#include <utility>

#include "core/base/check.h"

namespace lightvane {

SceneDescription litOnlyBy(const SceneDescription& description, const Scene& scene,
                           std::optional<std::uint32_t> light) {
  LV_CHECK(!light || *light < scene.lights.size(), "light {} of {}", *light, scene.lights.size());
  SceneDescription lit = description;
  std::set<std::pair<std::size_t, std::size_t>> shining;  // shape and material
  for (const Surface& surface : scene.surfaces) {
    if (light && surface.light == *light) shining.emplace(surface.shape, surface.material);
  }
  std::map<std::size_t, std::size_t> dark;  // by the material that they are like
  const auto darkened = [&](std::size_t shape, std::size_t material) {
    if (!lit.materials[material].emits() || shining.contains({shape, material})) return material;
    const auto [entry, isNew] = dark.try_emplace(material, lit.materials.size());
    if (isNew) {
      MaterialDescription copy = lit.materials[material];
      copy.emission = Rgb(0.0f);
      copy.textures.emission.reset();
      lit.materials.push_back(std::move(copy));
    }
    return entry->second;
  };
  for (std::size_t s = 0; s < lit.shapes.size(); ++s) {
    ShapeDescription& shape = lit.shapes[s];
    shape.material = darkened(s, shape.material);
    if (!lit.materials[shape.material].emits()) shape.light.clear();
    if (auto* mesh = std::get_if<MeshDescription>(&shape.geometry)) {
      for (std::uint32_t& material : mesh->materials)
        material = static_cast<std::uint32_t>(darkened(s, material));
    }
  }
  // Lights that are no shapes are numbered after those that are.
  const std::size_t first = scene.lights.size() - description.lights.size();
  lit.lights.clear();
  if (light && *light >= first) lit.lights.push_back(description.lights[*light - first]);
  return lit;
}

}  // namespace lightvane
