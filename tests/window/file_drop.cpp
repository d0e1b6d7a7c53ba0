#include "tests/window/file_drop.h"

#include <array>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>

#include <X11/Xatom.h>
#include <X11/Xlib.h>

namespace lightvane {
namespace {

// What takes milliseconds on an idle machine.
constexpr auto kLongestDrop = std::chrono::seconds(20);
constexpr long kProtocolVersion = 5;

/// The side of the protocol that has a file.
class DropSource {
 public:
  DropSource(const std::string& display, Window target, const std::filesystem::path& file)
      : display_(XOpenDisplay(display.c_str()), XCloseDisplay),
        target_(target),
        text_("file://" + file.string() + "\r\n") {
    if (!display_) throw std::runtime_error("no display " + display);
    source_ = XCreateSimpleWindow(display_.get(), DefaultRootWindow(display_.get()), 0, 0, 1, 1, 0, 0, 0);
    XSetSelectionOwner(display_.get(), atom("XdndSelection"), source_, CurrentTime);
  }

  void run(int x, int y) {
    const auto own = static_cast<long>(source_);
    send("XdndEnter", {own, kProtocolVersion << 24, static_cast<long>(atom("text/uri-list")), 0, 0});
    send("XdndPosition",
         {own, 0, (static_cast<long>(x) << 16) | y, CurrentTime, static_cast<long>(atom("XdndActionCopy"))});
    waitFor("XdndStatus");
    send("XdndDrop", {own, 0, CurrentTime, 0, 0});
    waitFor("XdndFinished");
  }

 private:
  Atom atom(const char* name) const { return XInternAtom(display_.get(), name, False); }

  void send(const char* message, const std::array<long, 5>& data) const {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.display = display_.get();
    event.xclient.window = target_;
    event.xclient.message_type = atom(message);
    event.xclient.format = 32;
    for (std::size_t i = 0; i < data.size(); ++i) event.xclient.data.l[i] = data[i];
    XSendEvent(display_.get(), target_, False, NoEventMask, &event);
    XFlush(display_.get());
  }

  /// Hands the file's name to whoever asks for it.
  void answer(const XSelectionRequestEvent& asked) const {
    XChangeProperty(display_.get(), asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(text_.data()), static_cast<int>(text_.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.display = asked.display;
    event.xselection.requestor = asked.requestor;
    event.xselection.selection = asked.selection;
    event.xselection.target = asked.target;
    event.xselection.property = asked.property;
    event.xselection.time = asked.time;
    XSendEvent(display_.get(), asked.requestor, False, NoEventMask, &event);
    XFlush(display_.get());
  }

  void waitFor(const char* message) const {
    const auto end = std::chrono::steady_clock::now() + kLongestDrop;
    while (std::chrono::steady_clock::now() < end) {
      if (XPending(display_.get()) == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        continue;
      }
      XEvent event{};
      XNextEvent(display_.get(), &event);
      if (event.type == SelectionRequest) answer(event.xselectionrequest);
      if (event.type == ClientMessage && event.xclient.message_type == atom(message)) return;
    }
    throw std::runtime_error(std::string("the window sends no ") + message);
  }

  std::unique_ptr<Display, int (*)(Display*)> display_;
  Window target_;
  Window source_ = 0;
  std::string text_;
};

}  // namespace

void dropFile(const std::string& display, const std::string& window, const std::filesystem::path& file, int x,
              int y) {
  DropSource(display, std::stoul(window), file).run(x, y);
}

}  // namespace lightvane
