#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/inspect/color_map.h"
#include "core/inspect/record_ref.h"

namespace lightvane {

// Overlays as plain data, in world space and normalised units; app/gl draws them and adds nothing. What lies
// behind a surface is dimmed by the drawing side, which has the frame's depth.

enum class MarkerShape : std::uint8_t {
  Disc,
  Ring,     ///< hollow: an occluded DLV
  Diamond,  ///< a vector that was computed for a mirror or glass, where it is
  HollowDiamond,
  Square,   ///< hollow: about a pinned vector
  Cross,    ///< over one that is stale
  Triangle  ///< an image in a mirror
};

/// A record's place, of a constant size on the screen.
struct OverlayMarker {
  Vec3 position;
  float sizePixels;  ///< diameter at scale 1
  Color8 color;
  MarkerShape shape;
  RecordRef record;
  /// An image in a mirror: `position` lies behind the mirror's surface, which must not dim it.
  bool inMirror = false;
};

/// A line of constant width on the screen, with a head at `to` or without.
struct OverlayLine {
  Vec3 from;
  Vec3 to;
  float widthPixels;
  Color8 color;
  bool head;
};

/// Where a vector may be used: in the plane through `centre` that `axisU` and `axisV` span, the points centre
/// + u axisU + v axisV with u^2 + v^2 <= 1 and cutLow <= cutU u + cutV v <= cutHigh. At true size.
struct OverlayZone {
  Vec3 centre;
  Vec3 axisU;  ///< as long as the radius, in the tangent plane
  Vec3 axisV;
  float cutU = 0.0f, cutV = 0.0f;  ///< the gradient's bound; no cut where both are 0
  float cutLow = -1.0f, cutHigh = 1.0f;
  float rim =
      0.0f;  ///< width of the rim as a part of the radius: the angle that S_curv allows over 90 degrees
  Color8 color;
  RecordRef record;
};

struct OverlayLegendEntry {
  std::string text;  ///< with the unit
  Color8 color;
  MarkerShape shape;
};

/// Everything of one kind that is drawn together.
struct OverlayBatch {
  std::vector<OverlayZone> zones;      ///< drawn first
  std::vector<OverlayLine> lines;      ///< then these
  std::vector<OverlayMarker> markers;  ///< on top
  std::vector<OverlayLegendEntry> legend;
  std::vector<std::string> counts;  ///< what is shown of how many: "every 4th of 12,000 ILVs shown"
  std::vector<std::string> scales;  ///< of glyphs: "arrows: 10 % change over their length"
  std::vector<std::string> notes;   ///< how to read the rest
};

}  // namespace lightvane
