#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "core/inspect/overlay_style.h"

namespace lightvane {

/// Kinds of overlay that are switched one by one: the looks of an OverlayStyle.
enum class OverlayKind : std::uint8_t {
  Ilv,            ///< where ILVs are
  IlvZones,       ///< where they are valid
  IlvGradients,   ///< how their light changes along the surface
  Dlv,            ///< where DLVs are
  DlvRadius,      ///< r_max about them
  DlvDirections,  ///< where their light comes from, and how much
  MirrorImages    ///< both, as mirrors show them
};
inline constexpr std::size_t kOverlayKinds = 7;

/// OverlayLook as a value that can be compared.
struct OverlaySwitch {
  bool shown = false;
  float size = 1.0f;
  float opacity = 1.0f;

  bool operator==(const OverlaySwitch&) const = default;
};
/// What each kind looks like before anybody touches it: the style's own defaults.
std::array<OverlaySwitch, kOverlayKinds> usualLayers();

/// Which vectors are shown by when they were computed. Moments count the orders of births, pass after pass.
struct GrowthTime {
  bool all = true;           ///< whatever is computed is shown at once
  std::uint64_t moment = 0;  ///< otherwise the vectors of the first so many moments
  bool playing = false;

  bool operator==(const GrowthTime&) const = default;
};
/// The moments of all passes, where `passLengths` has for each pass the number of its births' orders.
std::uint64_t momentsOf(std::span<const std::uint32_t> passLengths);
/// The last birth that is seen at a moment, counted from 1. `moment` is within momentsOf.
BirthTime birthAt(std::span<const std::uint32_t> passLengths, std::uint64_t moment);
/// "pass 3, 120 of 4,512"
std::string momentText(std::span<const std::uint32_t> passLengths, std::uint64_t moment);

/// What is drawn over the picture.
struct OverlaySettings {
  bool shown = true;  ///< all of them; each kind has its own switch beside
  std::array<OverlaySwitch, kOverlayKinds> layers = usualLayers();
  VectorColoring coloring = OverlayStyle{}.coloring;
  /// Of a kind, where the picture covers kUsualArea; of more, every n-th is shown.
  int mostRecords = static_cast<int>(OverlayStyle{}.mostShown);
  GrowthTime growth;

  OverlaySwitch& layer(OverlayKind kind) { return layers[static_cast<std::size_t>(kind)]; }
  const OverlaySwitch& layer(OverlayKind kind) const { return layers[static_cast<std::size_t>(kind)]; }
  bool operator==(const OverlaySettings&) const = default;
};

/// In points: pixels of a screen whose text is at scale 1.
inline constexpr double kUsualArea = 640.0 * 640.0;
/// The settings for a picture that covers so much of the screen: as many vectors to an area, in steps of two,
/// so that markers leave something of a small picture and a magnified one shows what was left out.
OverlaySettings fittedTo(OverlaySettings settings, double areaInPoints);

/// The settings as buildOverlay takes them. With everything hidden, the selected vectors stay: they are asked
/// about.
OverlayStyle overlayStyle(const OverlaySettings& settings, std::span<const std::uint32_t> passLengths,
                          const std::vector<RecordRef>& selected);

}  // namespace lightvane
