#include "app/messages.h"

#include <cstdio>

#include <fmt/format.h>

#include "core/base/text.h"

namespace lightvane {
namespace {

/// Nobody is left to tell where stderr is closed, so that a failure is passed over (fmt::print would throw).
void printLine(const std::string& line) {
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

Expected<void> printAnswer(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    return makeError("stdout", "cannot be written");
  return {};
}

void printError(const std::string& text) {
  printLine(fmt::format("lightvane: error: {}\n", withoutCommands(text)));
}
void printWarning(const std::string& text) {
  printLine(fmt::format("lightvane: warning: {}\n", withoutCommands(text)));
}
void printNote(const std::string& text) { printLine(fmt::format("lightvane: {}\n", withoutCommands(text))); }

}  // namespace lightvane
