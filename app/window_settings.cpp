#include "app/window_settings.h"

#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "app/session_file.h"
#include "app/user_files.h"
#include "core/base/file.h"

namespace lightvane {
namespace {

// Whoever drags a side bar changes its width in every frame.
constexpr double kSecondsBetweenWrites = 1.0;

}  // namespace

WindowSettings windowSettings(const Display& display) {
  return {display.leftWidth, display.rightWidth, display.theme, display.uiScale, display.reloads};
}

void applySettings(const WindowSettings& settings, Display& display) {
  const auto& [leftWidth, rightWidth, theme, uiScale, reloads] = settings;
  display.leftWidth = leftWidth;
  display.rightWidth = rightWidth;
  display.theme = theme;
  display.uiScale = uiScale;
  display.reloads = reloads;
}

WindowSettingsFile::WindowSettingsFile(std::filesystem::path file)
    : file_(std::move(file)),
      isLeftAlone_(file_.empty()),
      writtenAt_(-std::numeric_limits<double>::infinity()),
      job_({}) {
  if (!file_.empty()) read();
  written_ = settings_;
}

WindowSettingsFile::~WindowSettingsFile() {
  job_.wait();
  if (isBehind()) (void)writeUserFile(file_, windowSettingsText(settings_));
}

void WindowSettingsFile::read() {
  std::error_code error;
  if (!std::filesystem::exists(file_, error)) return;
  std::optional<Error> wrong;
  if (const auto text = readFile(file_)) {
    ReadSettings found = parseWindowSettings(*text, file_);
    settings_ = found.settings;
    wrong = std::move(found.error);
  } else {
    wrong = text.error();
  }
  if (!wrong) return;
  isLeftAlone_ = true;
  problem_ = wrong->message() + ". The file is left as it is, and settings are not kept until it is mended.";
}

void WindowSettingsFile::keep(const WindowSettings& before, const WindowSettings& after) {
  const auto follow = [&](auto field) {
    if (before.*field != after.*field) settings_.*field = after.*field;
  };
  follow(&WindowSettings::leftWidth);
  follow(&WindowSettings::rightWidth);
  follow(&WindowSettings::theme);
  follow(&WindowSettings::uiScale);
  follow(&WindowSettings::reloads);
}

void WindowSettingsFile::update(double seconds) {
  if (const auto done = job_.take(); done && !*done) {
    isLeftAlone_ = true;
    problem_ = done->error().message() + ". Settings are not kept.";
  }
  if (!isBehind() || job_.isBusy() || seconds - writtenAt_ < kSecondsBetweenWrites) return;
  writtenAt_ = seconds;
  written_ = settings_;
  job_.start([file = file_, text = windowSettingsText(settings_)](const StopFlag&) {
    return writeUserFile(file, text);
  });
}

std::optional<std::string> WindowSettingsFile::takeProblem() { return std::exchange(problem_, std::nullopt); }

}  // namespace lightvane
