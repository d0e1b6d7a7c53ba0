#include "tests/browser/browser.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Where the browser reads and writes with --remote-debugging-pipe.
constexpr int kCommands = 3, kAnswers = 4;
constexpr int kNotFound = 127;  // a shell's exit code where there is no such program
// Pictures beyond some thousand pixels below the window's end are not loaded before someone scrolls there.
constexpr int kPageWidth = 1200, kPageHeight = 12000;

/// By way of a shell, which puts the socket where the browser looks for it.
std::vector<std::string> browserWords(const fs::path& home, int socket) {
  return {"bash", "-c", fmt::format("exec \"$@\" {}<&{} {}>&{}", kCommands, socket, kAnswers, socket), "bash",
          "chromium", "--headless=new",
          "--no-sandbox",             // there is none for root, nor in most containers
          "--disable-dev-shm-usage",  // which is small in containers
          "--disable-gpu", "--remote-debugging-pipe", "--user-data-dir=" + home.string(), "--no-first-run",
          // Neither the page nor the browser itself finds anyone.
          "--disable-background-networking", "--disable-component-update",
          "--host-resolver-rules=MAP * ~NOTFOUND", "about:blank"};
}

/// The parent, by /proc/ID/stat; 0 where the process is gone.
pid_t parentOf(const fs::path& process) {
  std::ifstream file(process / "stat");
  std::string line;
  std::getline(file, line);
  // The second field is the program's name, which may have spaces and brackets.
  const std::size_t name = line.rfind(')');
  if (name == std::string::npos) return 0;
  std::istringstream fields(line.substr(name + 1));
  std::string state;
  pid_t parent = 0;
  fields >> state >> parent;
  return parent;
}

/// What a long text ends with.
std::string endOf(const std::string& text) {
  constexpr std::size_t kMost = 2000;
  return text.size() > kMost ? text.substr(text.size() - kMost) : text;
}

}  // namespace

std::vector<pid_t> childProcesses() {
  std::vector<pid_t> children;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (parentOf(entry.path()) == getpid()) children.push_back(std::stoi(name));
  }
  return children;
}

Browser::Browser() : deadline_(Clock::now() + kPatience) {
  try {
    start();
    attach();
  } catch (...) {
    end();
    throw;
  }
}

Browser::~Browser() { end(); }

void Browser::start() {
  // Whatever the browser starts becomes ours when its own parent ends: some of it leaves the browser's
  // session.
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("no socket can be made");
  socket_ = ends[0];
  ChildProcess::Start start;
  start.words = browserWords(home_.path(), ends[1]);
  for (const char* name : {"HOME", "TMPDIR", "XDG_CONFIG_HOME", "XDG_CACHE_HOME"})
    start.environment[name] = home_.path();
  // No window may open on the desktop of whoever runs the tests.
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) start.environment[name] = "";
  start.err = home_ / "err";
  start.inherited = ends[1];
  process_ = std::make_unique<ChildProcess>(start);
  close(ends[1]);
}

/// Makes a page of its own, and asks to be told of what is on it.
void Browser::attach() {
  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ =
      call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}}).at("sessionId");
  for (const char* domain : {"Runtime", "Log", "Network", "Page"})
    call(std::string(domain) + ".enable", Json::object());
  call("Emulation.setDeviceMetricsOverride",
       {{"width", kPageWidth}, {"height", kPageHeight}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

void Browser::end() {
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  for (std::vector<pid_t> left = childProcesses(); !left.empty(); left = childProcesses()) {
    for (const pid_t child : left) {
      kill(child, SIGKILL);
      while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
    }
  }
}

void Browser::fail(const std::string& what) const {
  throw std::runtime_error(fmt::format("the browser: {}. Its last words:\n{}", what,
                                       endOf(readFile(home_ / "err").value_or(std::string()))));
}

/// It closed its end, and so it is about to be over.
void Browser::failAtItsEnd() const {
  if (process_->waitForExit(kPatience) == kNotFound) {
    throw std::runtime_error(
        "there is no chromium, in which this test looks at pages. ./check installs it; by hand: apt-get "
        "install --no-install-recommends chromium");
  }
  fail("it ended");
}

Browser::Json Browser::receive() {
  for (;;) {
    const std::size_t length = received_.find('\0');
    if (length != std::string::npos) {
      Json message = Json::parse(received_.substr(0, length));
      received_.erase(0, length + 1);
      return message;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now());
    pollfd waiting{socket_, POLLIN, 0};
    const int ready = left.count() > 0 ? poll(&waiting, 1, static_cast<int>(left.count())) : 0;
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) fail("no answer in time");
    std::array<char, 65536> part{};
    const ssize_t count = read(socket_, part.data(), part.size());
    if (count <= 0) failAtItsEnd();
    received_.append(part.data(), static_cast<std::size_t>(count));
  }
}

Browser::Json Browser::call(const std::string& method, const Json& parameters) {
  Json message = {{"id", ++calls_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump();
  // With the zero that ends a message.
  for (std::size_t sent = 0; sent <= text.size();) {
    const ssize_t count = send(socket_, text.c_str() + sent, text.size() + 1 - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) break;  // it ended, as receive() finds out
    sent += static_cast<std::size_t>(count);
  }
  for (;;) {
    const Json answer = receive();
    if (answer.value("id", 0) != calls_) {
      note(answer);
      continue;
    }
    if (answer.contains("error")) fail(method + ": " + answer["error"].dump());
    return answer.at("result");
  }
}

void Browser::note(const Json& event) {
  const std::string method = event.value("method", "");
  if (event.value("sessionId", "") != session_) return;
  const Json& about = event.at("params");
  if (method == "Page.loadEventFired") isLoaded_ = true;
  if (method == "Network.requestWillBeSent") requests_.push_back(about.at("request").at("url"));
  if (method == "Network.webSocketCreated") requests_.push_back(about.at("url"));
  if (method == "Runtime.exceptionThrown") {
    const Json& details = about.at("exceptionDetails");
    const Json thrown = details.value("exception", Json::object());
    errors_.push_back(details.at("text").get<std::string>() + " " +
                      thrown.value("description", thrown.value("value", Json()).dump()));
  }
  if (method == "Runtime.consoleAPICalled" && about.at("type") == "error")
    errors_.push_back("console.error " + about.at("args").dump());
  if (method == "Log.entryAdded" && about.at("entry").at("level") == "error")
    errors_.push_back(about["entry"].at("text").get<std::string>() + " " + about["entry"].value("url", ""));
}

void Browser::open(const fs::path& page, std::chrono::milliseconds patience) {
  deadline_ = Clock::now() + patience;
  errors_.clear();
  requests_.clear();
  isLoaded_ = false;
  const Json answer = call("Page.navigate", {{"url", "file://" + page.string()}});
  if (answer.contains("errorText")) fail(page.string() + ": " + answer["errorText"].dump());
  while (!isLoaded_) note(receive());
  // Pictures that are to be loaded when they come into sight are not waited for by the page. A last turn of
  // its loop is for what scripts put off.
  valueOf(R"js(
    Promise.all(Array.from(document.images, image => image.decode().catch(() => 0)))
      .then(() => new Promise(done => setTimeout(done, 0)))
      .then(() => true))js");
}

Browser::Json Browser::evaluate(const std::string& expression) {
  deadline_ = Clock::now() + kPatience;
  return valueOf(expression);
}

Browser::Json Browser::valueOf(const std::string& expression) {
  const Json answer =
      call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails")) fail(answer["exceptionDetails"].dump());
  return answer.at("result").value("value", Json());
}

void Browser::mouse(const char* type, PagePlace place, int buttons) {
  deadline_ = Clock::now() + kPatience;
  call("Input.dispatchMouseEvent", {{"type", type},
                                    {"x", place.x},
                                    {"y", place.y},
                                    {"button", buttons > 0 ? "left" : "none"},
                                    {"clickCount", buttons}});
}

void Browser::moveTo(PagePlace place) { mouse("mouseMoved", place, 0); }

void Browser::click(PagePlace place) {
  moveTo(place);
  mouse("mousePressed", place, 1);
  mouse("mouseReleased", place, 1);
}

}  // namespace lightvane
