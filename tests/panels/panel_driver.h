#pragma once

#include <string>
#include <string_view>

#include "app/panels/panels.h"
#include "app/panels/widgets.h"

namespace lightvane {

/// All panels on a screen that nobody sees, driven by the mouse and the keyboard as a user would: one state
/// of the input a frame, widgets found by their names. ImGui asserts where panels misuse it.
class PanelDriver {
 public:
  struct Screen {
    float width = 1280.0f, height = 800.0f;
    float scale = 1.0f;
    Theme theme = Theme::Dark;
  };

  PanelDriver();
  explicit PanelDriver(const Screen& screen);
  ~PanelDriver();
  PanelDriver(const PanelDriver&) = delete;
  PanelDriver& operator=(const PanelDriver&) = delete;

  /// Draws `count` frames, a sixtieth of a second each; `output` is that of the last.
  void frames(int count = 1);

  /// Brings a widget into sight by the wheel where it is not, and returns its place; fails the test where
  /// there is none of that name.
  WidgetPlace require(std::string_view name);
  void moveTo(std::string_view name);
  void click(std::string_view name);
  void doubleClick(std::string_view name);
  /// Presses on the widget's middle, moves by `dx` pixels in some frames, and releases.
  void drag(std::string_view name, float dx);
  /// Rests on a widget until its tooltip would be shown.
  void hover(std::string_view name);
  void type(std::string_view text);
  void press(ImGuiKey key);
  void action(ActionId id);

  Workspace workspace;
  PanelInput input;
  PanelState state;
  PanelOutput output;
  PanelLayout layout;
  PanelOutput asked;  ///< everything that was asked of the loop so far
  int gestures = 0;   ///< frames in which a control was held

 private:
  void putMouse(const ImVec2& at);
  void putButton(bool down);
  void release();
  void putKey(ImGuiKey key, bool down);
  void remember(const PanelOutput& told);

  ImGuiContext* context_;
  KeyMap keys_;
};

/// A scene with everything that panels look at: lights with vectors and without, two cameras, mirrors.
SceneSummary richScene();
/// An input with all of its parts: a scene, a status, a view with a scale, an overlay, notices.
PanelInput richInput(const OverlayBatch& overlay);
/// Four points of ilv.n_min, twice each: slower and nearer to the reference, and one that is neither.
TradeStatus someTrade();
OverlayBatch someOverlay();

}  // namespace lightvane
