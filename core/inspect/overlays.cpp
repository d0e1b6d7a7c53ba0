#include "core/inspect/overlays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>

#include "core/base/number_text.h"
#include "core/inspect/record_names.h"
#include "core/inspect/units.h"
#include "core/inspect/validity_zone.h"

namespace lightvane {
namespace {

// Diameters and widths at scale 1, in pixels: a marker covers what a few thousand of them leave room for in a
// picture of 512 pixels.
constexpr float kMarkerPixels = 6.0f;
constexpr float kSelectedScale = 1.8f;
constexpr float kLinePixels = 1.5f;

// An arrow at full scale, as a part of the scene's diagonal: about the spacing of vectors.
constexpr float kGlyphLength = 0.04f;
// Arrows end at this multiple of full scale: a bright vector must not cross the picture.
constexpr float kLongestGlyph = 2.0f;

Color8 withOpacity(Color8 color, const OverlayLook& look) {
  color.a = static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(look.opacity, 0.0f, 1.0f)));
  return color;
}

// Gradients are read beside the markers of their vectors.
constexpr Color8 kGradientColor{245, 245, 245};

// ILVs by what they serve, DLVs by their light.
Color8 keyColor(SurfaceKey key) { return categoryColor(ColorFamily::Warm, key); }
Color8 lightMarkColor(std::uint32_t light) { return categoryColor(ColorFamily::Cool, light); }

/// Answers for many records: a selected region may have thousands.
class IsSelected {
 public:
  explicit IsSelected(const OverlayStyle& style) : records_(style.selected.begin(), style.selected.end()) {}
  bool operator()(const RecordRef& record) const { return records_.contains(record); }

 private:
  std::set<RecordRef> records_;
};

bool isBorn(const OverlayStyle& style, const Birth& birth) {
  return !style.until || BirthTime{birth.pass, birth.order} <= *style.until;
}

/// The vectors of one kind that a style shows.
struct Shown {
  std::vector<RecordRef> records;  ///< by light, then by number
  std::size_t born = 0;
  std::size_t total = 0;
  std::size_t step = 1;
  bool onlySelected = false;  ///< which need no legend: they are what the inspector is about

  /// "every 4th of 12,000 ILVs shown"; "" where there is nothing to say.
  std::string count(const char* kind) const {
    if (total == 0 || onlySelected) return {};
    if (born == 0) return fmt::format("none of {} {} computed by then", countText(total), kind);
    std::string text =
        born < total ? fmt::format("{} of {} {} computed by then", countText(born), countText(total), kind)
                     : fmt::format("{} {}", countText(total), kind);
    if (step == 1) return text;
    // Steps are powers of two: 2nd, 4th, 8th, 16th, 32nd, ...
    const bool isSecond = step % 10 == 2 && step % 100 != 12;
    return fmt::format("every {}{} of {} shown", step, isSecond ? "nd" : "th", text);
  }
};

/// Every step-th number, the step a power of two: more vectors never bring back one that was left out, and a
/// number that is shown at a step is shown at all smaller ones. The step goes by all vectors, born or not, so
/// that a moving time changes no choice.
template <class RecordsOf>
Shown choose(const RenderFrame& frame, const OverlayStyle& style, const std::vector<std::uint32_t>& lights,
             const RecordsOf& recordsOf) {
  Shown shown;
  if (!frame.snapshot) return shown;
  const IsSelected isSelected(style);
  for (const std::uint32_t light : lights) shown.total += recordsOf(light).size();
  const std::size_t most = std::max<std::size_t>(1, style.mostShown);
  while (shown.total > most * shown.step) shown.step *= 2;
  for (const std::uint32_t light : lights) {
    const auto& records = recordsOf(light);
    for (std::uint32_t number = 0; number < records.size(); ++number) {
      if (!isBorn(style, records[number].birth) || !isFinite(records[number].point.position)) continue;
      ++shown.born;
      const RecordRef ref{light, number};
      if (number % shown.step == 0 || isSelected(ref)) shown.records.push_back(ref);
    }
  }
  return shown;
}

Shown chooseIndirect(const RenderFrame& frame, const OverlayStyle& style) {
  return choose(frame, style, {kNone},
                [&](std::uint32_t) -> const auto& { return frame.snapshot->indirect; });
}

Shown chooseDirect(const RenderFrame& frame, const OverlayStyle& style) {
  std::vector<std::uint32_t> lights;
  if (frame.snapshot) {
    for (std::uint32_t l = 0; l < frame.snapshot->direct.size(); ++l) lights.push_back(l);
  }
  return choose(frame, style, lights,
                [&](std::uint32_t light) -> const auto& { return frame.snapshot->direct[light]; });
}

/// The selected ones of one kind, for overlays that are drawn for these alone.
Shown selectedOf(Shown shown, const OverlayStyle& style) {
  const IsSelected isSelected(style);
  shown.onlySelected = true;
  std::erase_if(shown.records, [&](const RecordRef& record) { return !isSelected(record); });
  return shown;
}

void addOnce(std::vector<std::string>& texts, std::string text) {
  if (!text.empty() && std::find(texts.begin(), texts.end(), text) == texts.end())
    texts.push_back(std::move(text));
}
void addCount(OverlayBatch& batch, const Shown& shown, const char* kind) {
  addOnce(batch.counts, shown.count(kind));
}

/// The value below which 95 % of the positive finite values lie; 0 where there is none.
float typicalMost(std::vector<float> values) {
  std::erase_if(values, [](float v) { return !(v > 0.0f) || !std::isfinite(v); });
  if (values.empty()) return 0.0f;
  const auto rank = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

OverlayLegendEntry diamondEntry() {
  return {"computed for a mirror or glass", {200, 200, 200}, MarkerShape::Diamond};
}

MarkerShape shapeOf(const Birth& birth, bool occluded) {
  if (birth.throughSpecular) return occluded ? MarkerShape::HollowDiamond : MarkerShape::Diamond;
  return occluded ? MarkerShape::Ring : MarkerShape::Disc;
}

/// Selected markers last: they must not be covered.
void putSelectedLast(OverlayBatch& batch, const OverlayStyle& style) {
  const IsSelected isSelected(style);
  std::stable_partition(batch.markers.begin(), batch.markers.end(),
                        [&](const OverlayMarker& marker) { return !isSelected(marker.record); });
}

// ---- colours of ILVs ----

/// Colours of all vectors that are shown, with the legend that explains them.
class VectorColors {
 public:
  VectorColors(const RenderFrame& frame, const OverlayStyle& style, const Shown& shown)
      : frame_(frame), coloring_(style.coloring) {
    if (coloring_ == VectorColoring::Key) {
      nameKeys(shown);
      return;
    }
    for (const RecordRef& ref : shown.records) {
      const float value = valueOf(ref.number);
      if (!std::isfinite(value) || (isLogarithmic() && !(value > 0.0f))) continue;
      low_ = std::min(low_, value);
      high_ = std::max(high_, value);
    }
    if (!shown.records.empty()) scaleLegend();
  }

  Color8 of(std::uint32_t number) const {
    if (coloring_ == VectorColoring::Key) return keyColor(frame_.snapshot->indirect[number].point.key);
    const float value = valueOf(number);
    // Beyond the scale on either side: dark is what has no value, and what sees nothing is infinitely far.
    return colorAt(ColorMap::Viridis, positionOf(value));
  }

  const std::vector<OverlayLegendEntry>& legend() const { return legend_; }

 private:
  bool isLogarithmic() const {
    return coloring_ == VectorColoring::Cost || coloring_ == VectorColoring::Energy ||
           coloring_ == VectorColoring::Distance;
  }

  float valueOf(std::uint32_t number) const {
    const IndirectLightVector& record = frame_.snapshot->indirect[number];
    switch (coloring_) {
      case VectorColoring::Key:
        break;
      case VectorColoring::Pass:
        return static_cast<float>(record.birth.pass);
      case VectorColoring::Age:
        return static_cast<float>(number);
      case VectorColoring::Cost:
        return static_cast<float>(record.birth.rays);
      case VectorColoring::Energy:
        return luminance(record.irradiance) * frame_.scene->normalisation.radianceScale();
      case VectorColoring::Distance:
        return record.harmonicMean;
    }
    return 0.0f;
  }

  float positionOf(float value) const {
    if (!(value > low_)) return 0.0f;
    if (!(value < high_)) return 1.0f;
    return isLogarithmic() ? std::log(value / low_) / std::log(high_ / low_)
                           : (value - low_) / (high_ - low_);
  }

  std::string textOf(float value) const {
    switch (coloring_) {
      case VectorColoring::Pass:
        return value == 0.0f ? "ILV: seed" : fmt::format("ILV: pass {}", value);
      case VectorColoring::Age:
        return fmt::format("ILV {}", countText(static_cast<std::size_t>(value)));
      case VectorColoring::Cost:
        return fmt::format("ILV: {} rays", countText(static_cast<std::size_t>(value)));
      case VectorColoring::Energy:
        return fmt::format("ILV: irradiance {} {}", numberText(value), kIrradianceUnit);
      case VectorColoring::Distance:
        return "ILV: mean distance " + lengthText(*frame_.scene, value);
      case VectorColoring::Key:
        break;
    }
    return {};
  }

  void nameKeys(const Shown& shown) {
    std::map<SurfaceKey, bool> keys;
    for (const RecordRef& ref : shown.records) keys[frame_.snapshot->indirect[ref.number].point.key] = true;
    for (const auto& [key, present] : keys) {
      legend_.push_back({"ILV: " + surfaceKeyName(*frame_.scene, key, frame_.parameters.vectors.ilv.store),
                         keyColor(key), MarkerShape::Disc});
    }
  }

  void scaleLegend() {
    constexpr int kEntries = 5;
    if (!(low_ <= high_)) return;  // no value was one
    const bool isWhole = coloring_ == VectorColoring::Pass || coloring_ == VectorColoring::Age ||
                         coloring_ == VectorColoring::Cost;
    for (int i = 0; i < kEntries; ++i) {
      const float part = static_cast<float>(i) / (kEntries - 1);
      float value = isLogarithmic() ? low_ * std::pow(high_ / low_, part) : low_ + part * (high_ - low_);
      if (isWhole) value = std::round(value);
      std::string text = textOf(value);
      if (!legend_.empty() && legend_.back().text == text) continue;
      legend_.push_back({std::move(text), colorAt(ColorMap::Viridis, positionOf(value)), MarkerShape::Disc});
    }
  }

  const RenderFrame& frame_;
  VectorColoring coloring_;
  float low_ = kInfinity;
  float high_ = -kInfinity;
  std::vector<OverlayLegendEntry> legend_;
};

void addLegendOfLights(const RenderFrame& frame, const Shown& shown, MarkerShape shape, OverlayBatch& batch) {
  std::uint32_t last = kNone;
  if (shown.onlySelected) return;
  for (const RecordRef& ref : shown.records) {
    if (ref.light == last) continue;
    last = ref.light;
    batch.legend.push_back({"DLV: " + lightName(*frame.scene, last), lightMarkColor(last), shape});
  }
}

// ---- kinds ----

/// Leaves out zones whose centres lie in zones that stay, the largest first: what stays covers the same
/// ground and can be told apart. Selected ones stay.
void thinZones(std::vector<OverlayZone>& zones, const OverlayStyle& style, const char* kind,
               OverlayBatch& batch) {
  const std::size_t all = zones.size();
  const IsSelected isSelected(style);
  const auto radius = [](const OverlayZone& zone) { return glm::length(zone.axisU); };
  std::stable_sort(zones.begin(), zones.end(), [&](const OverlayZone& a, const OverlayZone& b) {
    const bool aSelected = isSelected(a.record), bSelected = isSelected(b.record);
    return aSelected != bSelected ? aSelected : radius(a) > radius(b);
  });
  // Cells as large as the largest radius: what covers a centre is in one of its neighbours.
  float largest = 0.0f;
  for (const OverlayZone& zone : zones) largest = std::max(largest, radius(zone));
  const float cell = std::max(largest, 1e-6f);
  std::map<std::array<int, 3>, std::vector<std::size_t>> cells;
  const auto cellOf = [&](const Vec3& p) {
    const Vec3 at = glm::floor(p / cell);
    return std::array{static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)};
  };
  std::vector<OverlayZone> kept;
  const auto isCovered = [&](const OverlayZone& zone) {
    const Vec3 normal = glm::normalize(glm::cross(zone.axisU, zone.axisV));
    const std::array<int, 3> own = cellOf(zone.centre);
    for (int n = 0; n < 27; ++n) {
      const auto found = cells.find({own[0] + n % 3 - 1, own[1] + n / 3 % 3 - 1, own[2] + n / 9 - 1});
      if (found == cells.end()) continue;
      for (const std::size_t i : found->second) {
        const OverlayZone& other = kept[i];
        const Vec3 apart = zone.centre - other.centre;
        const Vec3 otherNormal = glm::normalize(glm::cross(other.axisU, other.axisV));
        if (glm::dot(normal, otherNormal) > 0.9f &&
            std::abs(glm::dot(apart, otherNormal)) < 0.1f * radius(other) &&
            zoneContains(other, zoneCoordinates(other, zone.centre)))
          return true;
      }
    }
    return false;
  };
  for (const OverlayZone& zone : zones) {
    if (!isSelected(zone.record) && isCovered(zone)) continue;
    cells[cellOf(zone.centre)].push_back(kept.size());
    kept.push_back(zone);
  }
  zones = std::move(kept);
  if (zones.size() < all)
    addOnce(batch.notes,
            fmt::format("zones of {} {}: the others' centres lie in these", countText(zones.size()), kind));
}

OverlayBatch zonesOf(const RenderFrame& frame, const OverlayStyle& style, const Shown& shown,
                     const VectorColors& colors) {
  OverlayBatch batch;
  const IlvRules rules(frame.parameters.vectors.ilv, frame.scene->diagonal);
  for (const RecordRef& ref : shown.records) {
    std::optional<OverlayZone> zone = validityZone(frame.snapshot->indirect[ref.number], rules);
    if (!zone) continue;
    zone->color = withOpacity(colors.of(ref.number), style.zones);
    zone->record = ref;
    batch.zones.push_back(*zone);
  }
  if (batch.zones.empty()) return batch;
  if (!shown.onlySelected) batch.legend = colors.legend();
  addCount(batch, shown, "ILVs");
  addOnce(batch.notes, "rims of zones: wider where ilv.S_curv lets the surface turn further");
  if (frame.parameters.vectors.ilv.gradientTest != IlvGradientTest::Off)
    addOnce(batch.notes, "zones are cut where the gradient test refuses");
  if (style.thinZones) thinZones(batch.zones, style, "ILVs", batch);
  return batch;
}

OverlayBatch directZonesOf(const RenderFrame& frame, const OverlayStyle& style, const Shown& shown) {
  OverlayBatch batch;
  const DlvParameters& dlv = frame.parameters.vectors.dlv;
  const float rMax = dlvRadius(dlv, *frame.scene);
  for (const RecordRef& ref : shown.records) {
    std::optional<OverlayZone> zone = directZone(frame.snapshot->direct[ref.light][ref.number], dlv, rMax);
    if (!zone) continue;
    zone->color = withOpacity(lightMarkColor(ref.light), style.directZones);
    zone->record = ref;
    batch.zones.push_back(*zone);
  }
  if (batch.zones.empty()) return batch;
  addLegendOfLights(frame, shown, MarkerShape::Ring, batch);
  addCount(batch, shown, "DLVs");
  addOnce(batch.notes, "zones of DLVs: r_max = " + lengthText(*frame.scene, rMax));
  if (style.thinZones) thinZones(batch.zones, style, "DLVs", batch);
  return batch;
}

OverlayBatch gradientsOf(const RenderFrame& frame, const OverlayStyle& style, const Shown& shown) {
  OverlayBatch batch;
  const IlvRules rules(frame.parameters.vectors.ilv, frame.scene->diagonal);
  for (const RecordRef& ref : shown.records) {
    const IndirectLightVector& record = frame.snapshot->indirect[ref.number];
    const IlvCandidate a = makeCandidate(record, rules);
    const Vec3 inPlane = a.gradient - record.point.normal * glm::dot(record.point.normal, a.gradient);
    const float steepness = glm::length(inPlane);
    const float change = steepness * a.radius / a.brightness;
    // Black vectors, vectors without a gradient, and those valid nowhere.
    if (!(change > 0.0f) || !std::isfinite(change)) continue;
    const Vec3 arrow = inPlane * (std::min(change, kLongestGlyph) * a.radius / steepness);
    if (!isFinite(arrow)) continue;
    batch.lines.push_back({a.position, a.position + style.gradients.size * arrow, kLinePixels,
                           withOpacity(kGradientColor, style.gradients), true});
  }
  if (batch.lines.empty()) return batch;
  addCount(batch, shown, "ILVs");
  addOnce(batch.scales,
          fmt::format("gradients (light arrows) point to where it is brighter: {} long for 100 % over the "
                      "radius, up to {} %",
                      style.gradients.size == 1.0f ? "a radius" : numberText(style.gradients.size) + " radii",
                      100.0f * kLongestGlyph));
  return batch;
}

/// Appends what is to be drawn later; legends without saying anything twice.
void append(OverlayBatch& batch, const OverlayBatch& later) {
  batch.zones.insert(batch.zones.end(), later.zones.begin(), later.zones.end());
  batch.lines.insert(batch.lines.end(), later.lines.begin(), later.lines.end());
  batch.markers.insert(batch.markers.end(), later.markers.begin(), later.markers.end());
  for (const OverlayLegendEntry& entry : later.legend) {
    const auto known =
        std::find_if(batch.legend.begin(), batch.legend.end(), [&](const OverlayLegendEntry& other) {
          return other.text == entry.text && other.color == entry.color;
        });
    if (known == batch.legend.end()) {
      batch.legend.push_back(entry);
    } else if (entry.shape == MarkerShape::Disc) {
      // A mark says more than the rim around it: rings are those of occluded vectors, too.
      known->shape = entry.shape;
    }
  }
  for (const std::string& count : later.counts) addOnce(batch.counts, count);
  for (const std::string& scale : later.scales) addOnce(batch.scales, scale);
  for (const std::string& note : later.notes) addOnce(batch.notes, note);
}

// ---- mirrors ----

/// Where the camera sees a place in a planar mirror: the place's image behind the mirror's plane. Nothing
/// where the line of sight misses the mirror's outline, or something stands before or after the mirror.
std::optional<Vec3> imageInMirror(const RenderFrame& frame, const PlanarMirror& mirror, const Vec3& place) {
  const Vec3& origin = mirror.outline.front();
  const float height = glm::dot(place - origin, mirror.normal);
  const Vec3 image = place - 2.0f * height * mirror.normal;
  if (!(frame.camera.distanceTo(image) > 0.0f)) return std::nullopt;
  const Vec3 eye = frame.camera.eyeOf(image);
  const float eyeHeight = glm::dot(eye - origin, mirror.normal);
  // On one side of the plane, both off it: what touches the mirror is its own image.
  const float least = 0x1p-16f * frame.scene->diagonal;
  if (!(height * eyeHeight > 0.0f) || std::abs(height) < least || std::abs(eyeHeight) < least)
    return std::nullopt;
  const Vec3 sight = image - eye;
  const Vec3 crossing = eye + sight * (eyeHeight / (eyeHeight + height));
  int side = 0;
  for (std::size_t i = 0; i < mirror.outline.size(); ++i) {
    const Vec3& from = mirror.outline[i];
    const Vec3& to = mirror.outline[(i + 1) % mirror.outline.size()];
    const int turn = glm::dot(glm::cross(to - from, crossing - from), mirror.normal) >= 0.0f ? 1 : -1;
    if (side != 0 && turn != side) return std::nullopt;
    side = turn;
  }
  const Ray ray{eye, glm::normalize(sight), 0.0f, kInfinity};
  const Hit hit = frame.tracer->intersect(ray);
  if (!hit.found()) return std::nullopt;
  const SurfacePoint point = frame.tracer->surfaceAt(ray, hit);
  if (point.surface != mirror.surface) return std::nullopt;
  const Vec3 from = point.originTowards(place - point.position);
  const Vec3 way = place - from;
  const float length = glm::length(way);
  // Short of the place by as much as a vector on a curved or grazing surface may lie below it.
  const float reach = length * (1.0f - 0x1p-10f) - 8.0f * point.offset;
  if (reach > 0.0f && frame.tracer->occluded({from, way / length, 0.0f, reach})) return std::nullopt;
  return image;
}

/// What of the markers the frame's camera sees in planar mirrors: behind the mirror.
OverlayBatch imagesOf(const RenderFrame& frame, const OverlayStyle& style,
                      std::span<const OverlayMarker> markers) {
  OverlayBatch batch;
  if (!frame.snapshot || frame.scene->planarMirrors.empty() || markers.empty()) return batch;
  const FlushDenormals flush;
  for (const PlanarMirror& mirror : frame.scene->planarMirrors) {
    for (const OverlayMarker& marker : markers) {
      const std::optional<Vec3> image = imageInMirror(frame, mirror, marker.position);
      if (!image || !isFinite(*image)) continue;
      batch.markers.push_back({*image, style.mirrorImages.size * marker.sizePixels,
                               withOpacity(marker.color, style.mirrorImages), MarkerShape::Triangle,
                               marker.record, true});
    }
  }
  return batch;
}

}  // namespace

OverlayBatch directMarkers(const RenderFrame& frame, const OverlayStyle& style) {
  OverlayBatch batch;
  const Shown shown = chooseDirect(frame, style);
  const IsSelected isSelected(style);
  bool hasOccluded = false, hasDiamond = false;
  for (const RecordRef& ref : shown.records) {
    const DirectLightVector& record = frame.snapshot->direct[ref.light][ref.number];
    const float scale = isSelected(ref) ? kSelectedScale : 1.0f;
    hasOccluded = hasOccluded || record.occluded;
    hasDiamond = hasDiamond || record.birth.throughSpecular;
    batch.markers.push_back({record.point.position, scale * style.directMarkers.size * kMarkerPixels,
                             withOpacity(lightMarkColor(ref.light), style.directMarkers),
                             shapeOf(record.birth, record.occluded), ref});
  }
  putSelectedLast(batch, style);
  addLegendOfLights(frame, shown, MarkerShape::Disc, batch);
  if (hasOccluded) batch.legend.push_back({"DLV: no light arrives", {200, 200, 200}, MarkerShape::Ring});
  if (hasDiamond) batch.legend.push_back(diamondEntry());
  addCount(batch, shown, "DLVs");
  return batch;
}

OverlayBatch directGlyphs(const RenderFrame& frame, const OverlayStyle& style) {
  OverlayBatch batch;
  const Shown shown = chooseDirect(frame, style);
  const auto energyOf = [&](const RecordRef& ref) {
    return luminance(frame.snapshot->direct[ref.light][ref.number].energy);
  };
  std::vector<float> energies;
  for (const RecordRef& ref : shown.records) energies.push_back(energyOf(ref));
  const float full = typicalMost(std::move(energies));
  if (!(full > 0.0f)) return batch;
  const float length = style.directGlyphs.size * kGlyphLength * frame.scene->diagonal;
  for (const RecordRef& ref : shown.records) {
    const DirectLightVector& record = frame.snapshot->direct[ref.light][ref.number];
    const float part = energyOf(ref) / full;
    if (record.occluded || !(part > 0.0f) || !std::isfinite(part) || !isFinite(record.direction)) continue;
    batch.lines.push_back({record.point.position,
                           record.point.position + length * std::min(part, kLongestGlyph) * record.direction,
                           kLinePixels, withOpacity(lightMarkColor(ref.light), style.directGlyphs), true});
  }
  addLegendOfLights(frame, shown, MarkerShape::Disc, batch);
  addCount(batch, shown, "DLVs");
  const bool split = frame.parameters.vectors.dlv.store == VectorStore::Split;
  addOnce(batch.scales,
          fmt::format("arrows of DLVs: {} long at {} {} {}", lengthText(*frame.scene, length),
                      split ? "an irradiance of" : "P =",
                      numberText(full * frame.scene->normalisation.radianceScale()), kIrradianceUnit));
  return batch;
}

OverlayBatch indirectMarkers(const RenderFrame& frame, const OverlayStyle& style) {
  OverlayBatch batch;
  const Shown shown = chooseIndirect(frame, style);
  const VectorColors colors(frame, style, shown);
  const IsSelected isSelected(style);
  bool hasDiamond = false;
  for (const RecordRef& ref : shown.records) {
    const IndirectLightVector& record = frame.snapshot->indirect[ref.number];
    const float scale = isSelected(ref) ? kSelectedScale : 1.0f;
    hasDiamond = hasDiamond || record.birth.throughSpecular;
    batch.markers.push_back({record.point.position, scale * style.indirectMarkers.size * kMarkerPixels,
                             withOpacity(colors.of(ref.number), style.indirectMarkers),
                             shapeOf(record.birth, false), ref});
  }
  putSelectedLast(batch, style);
  batch.legend = colors.legend();
  if (hasDiamond) batch.legend.push_back(diamondEntry());
  addCount(batch, shown, "ILVs");
  return batch;
}

OverlayBatch validityZones(const RenderFrame& frame, const OverlayStyle& style) {
  if (!frame.snapshot) return {};
  const Shown shown = chooseIndirect(frame, style);
  return zonesOf(frame, style, shown, VectorColors(frame, style, shown));
}

OverlayBatch directZones(const RenderFrame& frame, const OverlayStyle& style) {
  if (!frame.snapshot) return {};
  return directZonesOf(frame, style, chooseDirect(frame, style));
}

OverlayBatch gradientGlyphs(const RenderFrame& frame, const OverlayStyle& style) {
  if (!frame.snapshot) return {};
  const Shown shown = chooseIndirect(frame, style);
  return gradientsOf(frame, style, shown);
}

OverlayBatch solidAngleCone(const RenderFrame& frame, const RecordRef& record, const OverlayStyle& style) {
  constexpr int kSegments = 32;
  constexpr int kEdgeEvery = 8;
  OverlayBatch batch;
  const DirectLightVector* vector = findDirect(frame, record);
  if (vector == nullptr || vector->occluded || !isFinite(vector->direction) ||
      !isFinite(vector->point.position) || !std::isfinite(vector->solidAngle)) {
    return batch;
  }
  const float norm = glm::length(vector->direction);
  if (!(norm > 0.0f)) return batch;
  // A cap of solid angle 2 pi (1 - cos): the light's own shape is not known to the vector.
  const float cosine = std::clamp(1.0f - vector->solidAngle / kTwoPi, -1.0f, 1.0f);
  const float sine = std::sqrt(1.0f - cosine * cosine);
  const Frame axes = Frame::aboutNormal(vector->direction / norm);
  const float length = 2.0f * style.directGlyphs.size * kGlyphLength * frame.scene->diagonal;
  const Color8 color = withOpacity(lightMarkColor(record.light), style.directGlyphs);
  const Vec3& apex = vector->point.position;
  const auto rim = [&](int i) {
    const float angle = kTwoPi * static_cast<float>(i % kSegments) / kSegments;
    return apex + length * axes.toWorld({sine * std::cos(angle), sine * std::sin(angle), cosine});
  };
  for (int i = 0; i < kSegments; ++i) {
    batch.lines.push_back({rim(i), rim(i + 1), kLinePixels, color, false});
    if (i % kEdgeEvery == 0) batch.lines.push_back({apex, rim(i), kLinePixels, color, false});
  }
  addOnce(batch.notes, fmt::format("{} subtends {} sr at {}", lightName(*frame.scene, record.light),
                                   numberText(vector->solidAngle), recordName(*frame.scene, record)));
  return batch;
}

OverlayBatch mirrorImages(const RenderFrame& frame, const OverlayStyle& style) {
  OverlayBatch markers;
  if (style.directMarkers.shown) append(markers, directMarkers(frame, style));
  if (style.indirectMarkers.shown) append(markers, indirectMarkers(frame, style));
  OverlayBatch batch = imagesOf(frame, style, markers.markers);
  if (!batch.markers.empty())
    batch.legend.push_back({fmt::format("seen in a mirror: {}", countText(batch.markers.size())),
                            {200, 200, 200},
                            MarkerShape::Triangle});
  return batch;
}

OverlayBatch pinnedMarks(const RenderFrame& frame, const OverlayStyle& style) {
  constexpr float kPinPixels = 15.0f;
  constexpr Color8 kPinColor{255, 255, 255};
  OverlayBatch batch;
  const auto add = [&](const auto* vector, const RecordRef& record) {
    if (vector != nullptr && isBorn(style, vector->birth) && isFinite(vector->point.position))
      batch.markers.push_back(
          {vector->point.position, kPinPixels, kPinColor, MarkerShape::Square, record, false});
  };
  for (const RecordRef& record : style.pinned) {
    add(findIndirect(frame, record), record);
    add(findDirect(frame, record), record);
  }
  if (!batch.markers.empty()) batch.legend.push_back({"pinned", kPinColor, MarkerShape::Square});
  return batch;
}

OverlayBatch staleMarks(const RenderFrame& frame, const OverlayStyle& style) {
  constexpr float kStalePixels = 9.0f;
  constexpr Color8 kStaleColor{255, 255, 255};
  OverlayBatch batch;
  const auto add = [&](const Shown& shown, const auto& pointOf, const char* kind) {
    for (const RecordRef& record : shown.records)
      batch.markers.push_back(
          {pointOf(record).position, kStalePixels, kStaleColor, MarkerShape::Cross, record});
    if (!shown.records.empty())
      batch.legend.push_back(
          {fmt::format("{}: stale after this change", kind), kStaleColor, MarkerShape::Cross});
    addCount(batch, shown, kind);
  };
  if (style.stale.indirect) {
    const auto pointOf = [&](const RecordRef& r) { return frame.snapshot->indirect[r.number].point; };
    add(chooseIndirect(frame, style), pointOf, "ILVs");
  }
  if (style.stale.direct) {
    const auto pointOf = [&](const RecordRef& r) { return frame.snapshot->direct[r.light][r.number].point; };
    add(chooseDirect(frame, style), pointOf, "DLVs");
  }
  return batch;
}

OverlayBatch buildOverlay(const RenderFrame& frame, const OverlayStyle& style) {
  OverlayBatch batch;
  if (!frame.snapshot) return batch;
  const Shown indirect = chooseIndirect(frame, style);
  const Shown direct = chooseDirect(frame, style);
  const VectorColors colors(frame, style, indirect);
  // Of a whole region, zones and cones would hide each other and all else.
  constexpr std::size_t kMostDetailed = 8;
  const bool areFew = style.selected.size() <= kMostDetailed;
  const IsSelected isSelected(style);
  const auto orSelected = [&](const Shown& all, bool shown) {
    return shown ? all : areFew ? selectedOf(all, style) : Shown{};
  };
  append(batch, directZonesOf(frame, style, orSelected(direct, style.directZones.shown)));
  append(batch, zonesOf(frame, style, orSelected(indirect, style.zones.shown), colors));
  append(batch, gradientsOf(frame, style, orSelected(indirect, style.gradients.shown)));
  if (style.directGlyphs.shown) append(batch, directGlyphs(frame, style));
  for (const RecordRef& ref : style.selected) {
    const DirectLightVector* record = findDirect(frame, ref);
    if (areFew && record != nullptr && isBorn(style, record->birth))
      append(batch, solidAngleCone(frame, ref, style));
  }
  const auto markersOf = [&](OverlayBatch markers, bool shown) {
    if (shown) return markers;
    // The selected ones alone, which need no legend.
    std::erase_if(markers.markers, [&](const OverlayMarker& m) { return !isSelected(m.record); });
    markers.legend.clear();
    markers.counts.clear();
    markers.scales.clear();
    markers.notes.clear();
    return markers;
  };
  append(batch, pinnedMarks(frame, style));
  append(batch, markersOf(directMarkers(frame, style), style.directMarkers.shown));
  append(batch, markersOf(indirectMarkers(frame, style), style.indirectMarkers.shown));
  if (style.mirrorImages.shown) {
    append(batch, mirrorImages(frame, style));
  } else if (areFew) {
    // A row of a report that was seen in a mirror points at something there.
    std::vector<OverlayMarker> selected = batch.markers;
    std::erase_if(selected, [&](const OverlayMarker& m) { return !isSelected(m.record); });
    append(batch, imagesOf(frame, style, selected));
  }
  append(batch, staleMarks(frame, style));
  return batch;
}

}  // namespace lightvane
