#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/panels/overlay_settings.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/record_ref.h"
#include "core/render/parameters.h"
#include "core/scene/description.h"

namespace lightvane {

// Everything that a user may change, as values. Panels edit them and nothing else; the window's loop compares
// them with what it sent to the session last, and sends what differs.

/// What is done to one light while looking.
struct LightSetting {
  bool muted = false;
  bool soloed = false;
  Rgb tint{1.0f};      ///< linear; 1 leaves the light's own colour
  float stops = 0.0f;  ///< its intensity times 2^stops

  bool operator==(const LightSetting&) const = default;
};

/// What a light's direct part is to be multiplied with: black where it is muted, or where others are soloed
/// and it is not. Lights beyond `settings` are left alone.
Rgb lightFactor(std::span<const LightSetting> settings, std::size_t light);

/// How radiance becomes what a screen shows.
struct Brightness {
  float exposureStops = 0.0f;  ///< beside the camera's own
  ToneMap toneMapping = ToneMap::Clip;

  bool operator==(const Brightness&) const = default;
};

/// All that a picture is made of and that undo takes back.
struct Setup {
  Parameters parameters;
  Brightness brightness;
  CameraDescription camera;          ///< in the scene's units, as a file would have it
  std::vector<LightSetting> lights;  ///< one for each of Scene::lights
  std::vector<Rgb> indirectFactors;  ///< of the lights, with which ILVs are computed; empty: all 1
  bool cacheLocked = false;          ///< interpolate only
  int threads = 0;                   ///< 0: as many as the machine has cores
  int memoryLimitMegabytes = 0;      ///< of what is rendered, 10^6 bytes each; 0: none
  std::uint64_t recordState = 0;     ///< of RecordHistory: what was done to vectors by hand

  bool operator==(const Setup&) const = default;
};

/// Where the picture is on the screen.
struct PicturePlacement {
  bool fit = true;       ///< as large as its place allows, in its middle; zoom and pan are unused
  float zoom = 1.0f;     ///< screen pixels a picture pixel
  Vec2 pan{0.0f, 0.0f};  ///< of the picture's middle from the middle of its place, screen pixels

  bool operator==(const PicturePlacement&) const = default;
};

enum class CompareMode : std::uint8_t { Off, SideBySide, Wipe, Difference };
inline constexpr std::array kCompareModeNames{
    Choice{CompareMode::Off, "one picture"}, Choice{CompareMode::SideBySide, "side by side"},
    Choice{CompareMode::Wipe, "wipe"}, Choice{CompareMode::Difference, "difference"}};
/// What the picture is held against.
enum class CompareWith : std::uint8_t {
  Kept,       ///< the picture kept as B
  Reference,  ///< path traced, or a picture from elsewhere
  Point       ///< of the Trade panel, the one that was clicked
};
inline constexpr std::array kCompareWithNames{Choice{CompareWith::Kept, "picture B"},
                                              Choice{CompareWith::Reference, "reference"},
                                              Choice{CompareWith::Point, "point of a trade"}};

struct Comparison {
  CompareMode mode = CompareMode::Off;
  CompareWith with = CompareWith::Kept;
  bool flipped = false;  ///< B is shown in A's place
  float wipe = 0.5f;     ///< the part of the picture's width that shows A

  bool operator==(const Comparison&) const = default;
};

enum class Theme : std::uint8_t { Dark, Bright };

/// The parts of the side bars, as tabs.
enum class PanelTab : std::uint8_t { Parameters, View, Overlays, Lights, Inspector, Trade };
inline constexpr std::size_t kPanelTabs = 6;
/// On the left is what is shown, on the right how it is made and why it looks so.
constexpr bool isLeftTab(PanelTab tab) {
  return tab == PanelTab::View || tab == PanelTab::Overlays || tab == PanelTab::Lights;
}

/// Everything that says how things are shown, and restarts nothing.
struct Display {
  PictureView view = PictureView::Beauty;
  std::optional<ErrorSource> source;  ///< of the view ErrorSources: the one that is shown
  bool smooth = false;                ///< magnified pixels are blended instead of squares
  ScaleOverride scale;
  OverlaySettings overlays;
  PicturePlacement placement;
  Comparison comparison;
  bool legend = true;
  bool sideBars = true;
  float leftWidth = 290.0f;  ///< at UI scale 1
  float rightWidth = 330.0f;
  Theme theme = Theme::Dark;
  float uiScale = 1.0f;  ///< beside the monitor's own
  bool reloads = false;  ///< the scene by itself, when its file changes
  bool fullScreen = false;

  bool operator==(const Display&) const = default;
};

struct PixelRef {
  int x = 0;
  int y = 0;

  bool operator==(const PixelRef&) const = default;
};

/// What is asked about. Picture, overlay and inspector show the same.
struct Selection {
  std::optional<PixelRef> pixel;
  std::vector<RecordRef> records;  ///< the first is the one that is reported on
  RecordRef hoveredRecord;         ///< by the mouse on the picture, or on a row of the inspector

  bool operator==(const Selection&) const = default;
};

struct Workspace {
  Setup setup;
  Display display;
  Selection selection;

  PictureLook look() const {
    const bool isOfSources = display.view == PictureView::ErrorSources;
    return {display.view, setup.brightness.exposureStops, setup.brightness.toneMapping, display.scale,
            isOfSources ? display.source : std::nullopt};
  }
  bool operator==(const Workspace&) const = default;
};

}  // namespace lightvane
