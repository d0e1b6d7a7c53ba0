#include "app/window.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>

namespace lightvane {
namespace {

constexpr int kSmallestWidth = 640;
constexpr int kSmallestHeight = 400;

/// GLFW's last complaint, in its own words.
std::string lastError() {
  const char* description = nullptr;
  return glfwGetError(&description) != GLFW_NO_ERROR && description != nullptr ? description
                                                                               : "no reason is given";
}

std::optional<Key> specialKey(int key) {
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return functionKey(1 + key - GLFW_KEY_F1);
  switch (key) {
    case GLFW_KEY_SPACE:
      return Key::Space;
    case GLFW_KEY_ESCAPE:
      return Key::Escape;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return Key::Enter;
    case GLFW_KEY_TAB:
      return Key::Tab;
    case GLFW_KEY_BACKSPACE:
      return Key::Backspace;
    case GLFW_KEY_INSERT:
      return Key::Insert;
    case GLFW_KEY_DELETE:
      return Key::Delete;
    case GLFW_KEY_RIGHT:
      return Key::Right;
    case GLFW_KEY_LEFT:
      return Key::Left;
    case GLFW_KEY_DOWN:
      return Key::Down;
    case GLFW_KEY_UP:
      return Key::Up;
    case GLFW_KEY_PAGE_UP:
      return Key::PageUp;
    case GLFW_KEY_PAGE_DOWN:
      return Key::PageDown;
    case GLFW_KEY_HOME:
      return Key::Home;
    case GLFW_KEY_END:
      return Key::End;
    case GLFW_KEY_KP_ADD:
      return keyOf('=');
    case GLFW_KEY_KP_SUBTRACT:
      return keyOf('-');
    default:
      break;
  }
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9)
    return keyOf(static_cast<char>('0' + key - GLFW_KEY_KP_0));
  return std::nullopt;
}

/// The key by what is printed on it; GLFW's codes are those of a US keyboard.
Key printedKey(int key, int scancode) {
  if (const auto special = specialKey(key)) return *special;
  if (const char* name = glfwGetKeyName(key, scancode);
      name != nullptr && name[0] != '\0' && name[1] == '\0') {
    return keyOf(static_cast<char>(std::toupper(static_cast<unsigned char>(name[0]))));
  }
  return key > 0 && key < 128 ? keyOf(static_cast<char>(key)) : Key::None;
}

/// What of the wanted size fits on the monitor beside the desktop's bars; some have no window manager to see
/// to it.
std::pair<int, int> fittingSize(int width, int height) {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return {width, height};
  int x = 0, y = 0, freeWidth = 0, freeHeight = 0;
  glfwGetMonitorWorkarea(monitor, &x, &y, &freeWidth, &freeHeight);
  float scaleX = 1.0f, scaleY = 1.0f;  // by which the window grows when it is made
  glfwGetMonitorContentScale(monitor, &scaleX, &scaleY);
  const auto fitting = [](int wanted, int room, float scale) {
    const auto most = static_cast<int>(static_cast<float>(room) / scale);
    return most > 0 ? std::min(wanted, most) : wanted;
  };
  return {fitting(width, freeWidth, scaleX), fitting(height, freeHeight, scaleY)};
}

GLFWwindow* createWindow(const std::string& title, int width, int height, int contextApi) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, contextApi);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  // All drawing is done in a framebuffer of our own, which is copied as it is.
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SAMPLES, 0);
  return glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
}

}  // namespace

/// GLFW calls plain functions; these find the window again.
struct WindowCallbacks {
  static Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

  static void key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    // Of Ctrl and S, Ctrl often goes first: until it is let go, S is not a key by itself.
    if (action == GLFW_RELEASE) of(window).ofChords_.erase(key);
    if (action == GLFW_RELEASE) return;
    if (action == GLFW_PRESS && (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0)
      of(window).ofChords_.insert(key);
    KeyChord chord{printedKey(key, scancode), (modifiers & GLFW_MOD_CONTROL) != 0,
                   (modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_ALT) != 0};
    if (chord.key == Key::None) return;
    of(window).input_.keys.push_back(chord);
    if (action == GLFW_REPEAT) of(window).input_.held.insert(chord);
  }
  static void imGuiKey(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    of(window).typed(Window::KeyEvent{key, scancode, action, modifiers});
  }
  static void imGuiCharacter(GLFWwindow* window, unsigned character) { of(window).typed(character); }
  static void drop(GLFWwindow* window, int count, const char** paths) {
    for (int i = 0; i < count; ++i) of(window).input_.dropped.emplace_back(paths[i]);
  }
  static void close(GLFWwindow* window) { of(window).input_.wantsClose = true; }
};

Expected<std::unique_ptr<Window>> Window::open(const std::string& title, int width, int height) {
  if (glfwInit() != GLFW_TRUE) {
    return makeError(
        "", fmt::format("no window can be opened: {}", lastError()),
        "without a display, lightvane render SCENE -o FILE writes a picture, and xvfb-run gives a window "
        "that nobody sees");
  }
  std::tie(width, height) = fittingSize(width, height);
  GLFWwindow* window = createWindow(title, width, height, GLFW_NATIVE_CONTEXT_API);
  std::string reason = window == nullptr ? lastError() : "";
  // X servers without GLX can have EGL.
  if (window == nullptr) window = createWindow(title, width, height, GLFW_EGL_CONTEXT_API);
  if (window == nullptr) {
    reason += "; " + lastError();
    glfwTerminate();
    return makeError(
        "", fmt::format("the window needs OpenGL 3.3 and cannot have it: {}", reason),
        "install libgl1-mesa-dri, which also draws without a graphics card (LIBGL_ALWAYS_SOFTWARE=1)");
  }
  return std::unique_ptr<Window>(new Window(window));
}

Window::Window(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, this);
  glfwSetWindowSizeLimits(window, kSmallestWidth, kSmallestHeight, GLFW_DONT_CARE, GLFW_DONT_CARE);
  // Before ImGui's own, which call these: with 1.86 a press and its release within one frame are lost there.
  glfwSetKeyCallback(window, &WindowCallbacks::key);
  glfwSetDropCallback(window, &WindowCallbacks::drop);
  glfwSetWindowCloseCallback(window, &WindowCallbacks::close);
  glfwMakeContextCurrent(window);
  glfwSwapInterval(1);
}

Window::~Window() {
  detachImGui();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::attachImGui() {
  hasImGui_ = ImGui_ImplGlfw_InitForOpenGL(window_, true);
  if (!hasImGui_) return;
  glfwSetKeyCallback(window_, &WindowCallbacks::imGuiKey);
  glfwSetCharCallback(window_, &WindowCallbacks::imGuiCharacter);
}

void Window::detachImGui() {
  if (hasImGui_) ImGui_ImplGlfw_Shutdown();
  hasImGui_ = false;
}

void Window::beginImGuiFrame() {
  ImGui_ImplGlfw_NewFrame();
  pressedSinceFrame_.clear();
}

void (*Window::glFunction(const char* name))() { return glfwGetProcAddress(name); }

std::pair<int, int> Window::framebufferSize() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {width, height};
}

float Window::contentScale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return x;
}

bool Window::isMinimised() const { return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE; }

// ImGui 1.86 knows of a key what its state is at a frame, and of Ctrl the same: a tap that began and ended
// since the last one was none, and text typed after it was text with Ctrl.
void Window::typed(const TypedEvent& event) {
  if (!typed_.empty() || !fitsFrame(event)) {
    typed_.push_back(event);
  } else {
    passOn(event);
  }
}

bool Window::fitsFrame(const TypedEvent& event) const {
  const auto* key = std::get_if<KeyEvent>(&event);
  return key == nullptr || key->action != GLFW_RELEASE || !pressedSinceFrame_.contains(key->key);
}

void Window::passOn(const TypedEvent& event) {
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    if (key->action == GLFW_PRESS) pressedSinceFrame_.insert(key->key);
    ImGui_ImplGlfw_KeyCallback(window_, key->key, key->scancode, key->action, key->modifiers);
  } else {
    ImGui_ImplGlfw_CharCallback(window_, std::get<unsigned>(event));
  }
}

void Window::wait(double seconds) {
  while (!typed_.empty() && fitsFrame(typed_.front())) {
    passOn(typed_.front());
    typed_.pop_front();
  }
  if (seconds > 0.0 && typed_.empty()) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void Window::wakeUp() { glfwPostEmptyEvent(); }

WindowInput Window::takeInput() { return std::exchange(input_, {}); }

bool Window::isHeld(Key place) const {
  // Letters, digits and signs have GLFW's codes.
  const auto key = static_cast<int>(place);
  return glfwGetKey(window_, key) == GLFW_PRESS && !ofChords_.contains(key);
}

void Window::show() { glfwSwapBuffers(window_); }

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::setFullScreen(bool fullScreen) {
  if (fullScreen == fullScreen_) return;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (fullScreen && mode == nullptr) return;
  fullScreen_ = fullScreen;
  if (fullScreen) {
    glfwGetWindowPos(window_, &windowedX_, &windowedY_);
    glfwGetWindowSize(window_, &windowedWidth_, &windowedHeight_);
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  } else {
    glfwSetWindowMonitor(window_, nullptr, windowedX_, windowedY_, windowedWidth_, windowedHeight_,
                         GLFW_DONT_CARE);
  }
}

void Window::setClipboard(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

}  // namespace lightvane
