#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels/controls.h"
#include "app/panels/trade_io.h"
#include "app/panels/workspace.h"
#include "core/measure/sweep_values.h"

namespace lightvane {

// What panels remember from frame to frame and nobody else needs: what is open, half-typed, or folded. Not
// saved, not undone.

struct ParametersPanelState {
  std::string filter;
  std::set<std::string> openGroups{"method", "ilv"};  ///< by their prefixes
  std::optional<std::string> focus;  ///< a key to scroll to, to mark and to type in: asked for by the palette
  std::string marked;                ///< the key that was asked for last
  double markedUntil = 0.0;          ///< on PanelInput's clock
  std::set<std::string> inSceneUnits;  ///< keys of lengths that are shown in the scene's unit, not in metres
};

struct PaletteState {
  bool open = false;
  bool takeFocus = false;
  std::string text = {};
  int chosen = 0;
};

struct OpenDialogState {
  bool open = false;
  bool takeFocus = false;
  std::string text = {};
  std::string error = {};
};

struct ExportDialogState {
  bool open = false;
  bool takeFocus = false;
  std::string path = {};
  std::size_t format = 0;
  bool withOverlay = false;
  std::string error = {};
};

struct NoticesState {
  bool listOpen = false;
};

struct HelpState {
  bool open = false;
  bool takeFocus = false;
  std::string filter = {};
};

struct InspectorState {
  /// Names of the lines that are unfolded; they hold from pixel to pixel.
  std::set<std::string> unfolded{"inspector.point.0.indirect.0"};
  bool distances = false;  ///< the hemisphere shows distances instead of light
  bool byShare = false;    ///< candidates that were used alone, by what they gave
  RecordRef shown;         ///< to whose row the list was scrolled last, since its marker was under the mouse
};

/// What the Trade panel is set to.
struct TradePanelState {
  /// As --vary has them. The usual ones trade most: where vectors may be used, and how much each of them
  /// sees.
  std::array<std::string, kMostTradeParameters> varied{"ilv.radius_scale=0.2:0.8:4", "ilv.rows=6,9,12", ""};
  float seeds = 3.0f;
  int reduction = 4;
  bool fromFile = false;  ///< the reference
  std::string path;
  float noise = kTradeNoise;
  bool waits = true;      ///< for the picture of the window
  bool setupOpen = true;  ///< unfolded
  std::string error;      ///< of what was typed, when Start was clicked
  std::string metric = "beauty.relative";
  bool limitsTime = false;                 ///< "at most 2 s"; otherwise "at most 1 % error"
  std::map<std::string, float> mostError;  ///< by metric, in the unit that is read
  float mostSeconds = 2.0f;
  std::optional<std::size_t> selected;  ///< a point
  std::shared_ptr<const Sweep> listed;  ///< of which `metrics` are
  std::vector<ReportMetric> metrics;    ///< those of which less is better
};

struct PanelState {
  ControlState controls;
  ParametersPanelState parameters;
  PaletteState palette;
  OpenDialogState openDialog;
  ExportDialogState exportDialog;
  NoticesState notices;
  HelpState help;
  InspectorState inspector;
  TradePanelState trade;
  // The tabs in front. Where the window is too narrow for two side bars, `onlyTab` is that of the one.
  PanelTab leftTab = PanelTab::View;
  PanelTab rightTab = PanelTab::Parameters;
  PanelTab onlyTab = PanelTab::Parameters;
  double lastFrame = 0.0;  ///< PanelInput's clock, for what plays
};

}  // namespace lightvane
