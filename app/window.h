#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/panels/key_chord.h"
#include "core/base/error.h"

struct GLFWwindow;

namespace lightvane {

/// What happened since it was asked for last, beside what ImGui is told.
struct WindowInput {
  std::vector<KeyChord> keys;  ///< pressed, or repeated while held; letters as the keyboard prints them
  std::set<KeyChord> held;     ///< of these, those that only repeat
  std::vector<std::filesystem::path> dropped;
  bool wantsClose = false;
};

/// The window of the desktop, with an OpenGL context of version 3.3 that is current on the thread that made
/// it. One at a time, and all of it on the main thread, but for wakeUp.
class Window {
 public:
  /// Errors say what to do where there is no display or no usable OpenGL.
  static Expected<std::unique_ptr<Window>> open(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Feeds ImGui's current context with the mouse and the keyboard; until the window closes or detachImGui.
  void attachImGui();
  void detachImGui();
  void beginImGuiFrame();

  /// OpenGL's functions, for app/gl.
  static void (*glFunction(const char* name))();

  std::pair<int, int> framebufferSize() const;
  /// How large the monitor wants text to be; 1 at 96 dots per inch.
  float contentScale() const;
  bool isMinimised() const;

  /// Sleeps until something happens or the time is over; 0 only looks.
  void wait(double seconds);
  /// Ends a wait. From any thread; does nothing where there is no window.
  static void wakeUp();

  WindowInput takeInput();
  /// Whether the key at this place of a US keyboard is held, and was not pressed with Ctrl or Alt: for keys
  /// that lie well, whatever is printed on them.
  bool isHeld(Key place) const;

  void show();  ///< what was drawn into the default framebuffer
  void setTitle(const std::string& title);
  void setFullScreen(bool fullScreen);
  void setClipboard(const std::string& text);

 private:
  struct KeyEvent {
    int key, scancode, action, modifiers;  ///< as GLFW has them
  };
  using TypedEvent = std::variant<KeyEvent, unsigned>;  ///< or a character

  explicit Window(GLFWwindow* window);
  /// Passes it on to ImGui, at once or once a frame has seen what was passed on before.
  void typed(const TypedEvent& event);
  /// A key's release waits for a frame that has seen it down.
  bool fitsFrame(const TypedEvent& event) const;
  void passOn(const TypedEvent& event);

  GLFWwindow* window_;
  WindowInput input_;
  std::deque<TypedEvent> typed_;     ///< not passed on yet, in order
  std::set<int> pressedSinceFrame_;  ///< of what was passed on, in GLFW's codes
  std::set<int> ofChords_;           ///< held keys, in GLFW's codes, that were pressed with Ctrl or Alt
  bool hasImGui_ = false;
  bool fullScreen_ = false;
  int windowedX_ = 0, windowedY_ = 0, windowedWidth_ = 0, windowedHeight_ = 0;

  friend struct WindowCallbacks;
};

}  // namespace lightvane
