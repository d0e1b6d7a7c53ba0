#include "tests/window/virtual_desktop.h"

#include <cstdlib>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include "core/base/file.h"

namespace lightvane {
namespace {

constexpr auto kLongestStart = std::chrono::seconds(30);
constexpr const char* kPackages = "are the packages xvfb, xauth and xdotool installed?";

/// What comes through a pipe, up to the end of the line.
std::string readLine(int file) {
  std::string line;
  pollfd waited{file, POLLIN, 0};
  char c = 0;
  while (poll(&waited, 1, std::chrono::milliseconds(kLongestStart).count()) == 1 && read(file, &c, 1) == 1) {
    if (c == '\n') return line;
    line += c;
  }
  return "";
}

}  // namespace

VirtualDesktop::VirtualDesktop() {
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  // The server takes a number that is free and tells it.
  server_ = std::make_unique<ChildProcess>(
      ChildProcess::Start{.words = {"Xvfb", "-displayfd", std::to_string(ends[1]), "-noreset", "-nolisten",
                                    "tcp", "-screen", "0", fmt::format("{}x{}x24", kWidth, kHeight)},
                          .environment = {},
                          .inherited = ends[1]});
  close(ends[1]);
  const std::string number = readLine(ends[0]);
  close(ends[0]);
  if (number.empty()) throw std::runtime_error(fmt::format("Xvfb did not start: {}", kPackages));
  display_ = ":" + number;
}

std::optional<std::string> VirtualDesktop::tryXdotool(const std::vector<std::string>& words) const {
  std::vector<std::string> all = {"xdotool"};
  all.insert(all.end(), words.begin(), words.end());
  std::string out = (std::filesystem::temp_directory_path() / "lightvane-xdotool-XXXXXX").string();
  close(mkstemp(out.data()));
  ChildProcess process({.words = all, .environment = {{"DISPLAY", display_}}, .out = out});
  const std::optional<int> exitCode = process.waitForExit(kLongestStart);
  const std::string printed = readFile(out).value();
  std::filesystem::remove(out);
  if (exitCode == 127) throw std::runtime_error(fmt::format("xdotool did not start: {}", kPackages));
  return exitCode == 0 ? std::optional(printed) : std::nullopt;
}

std::string VirtualDesktop::xdotool(const std::vector<std::string>& words) const {
  const auto printed = tryXdotool(words);
  if (!printed) throw std::runtime_error(fmt::format("xdotool failed: xdotool {}", fmt::join(words, " ")));
  return *printed;
}

}  // namespace lightvane
