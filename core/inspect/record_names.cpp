#include "core/inspect/record_names.h"

#include <fmt/format.h>

namespace lightvane {

std::string surfaceKeyName(const Scene& scene, SurfaceKey key, VectorStore store) {
  if (key == kLambertKey) return "diffuse surfaces";
  for (const Material& material : scene.materials) {
    if (brdfSurfaceKey(material.brdfKey) == key)
      return (store == VectorStore::Split ? "lobe of " : "") + material.name;
  }
  return fmt::format("BRDF {}", key - 1);
}

std::string lightName(const Scene& scene, std::uint32_t light) {
  return light < scene.lightNames.size() && !scene.lightNames[light].empty()
             ? scene.lightNames[light]
             : fmt::format("light {}", light + 1);
}

std::string recordName(const Scene& scene, const RecordRef& record) {
  if (record.isNone()) return "no vector";
  if (record.isIndirect()) return fmt::format("ILV {}", record.number);
  return fmt::format("DLV {} of {}", record.number, lightName(scene, record.light));
}

const IndirectLightVector* findIndirect(const RenderFrame& frame, const RecordRef& record) {
  if (!frame.snapshot || !record.isIndirect() || record.number >= frame.snapshot->indirect.size())
    return nullptr;
  return &frame.snapshot->indirect[record.number];
}

const DirectLightVector* findDirect(const RenderFrame& frame, const RecordRef& record) {
  if (!frame.snapshot || record.light >= frame.snapshot->direct.size() ||
      record.number >= frame.snapshot->direct[record.light].size()) {
    return nullptr;
  }
  return &frame.snapshot->direct[record.light][record.number];
}

}  // namespace lightvane
