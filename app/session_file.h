#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/document.h"
#include "app/panels/workspace.h"
#include "app/window_settings.h"
#include "core/base/error.h"

namespace lightvane {

/// What is done to a light, by its name: numbers change when a scene does.
struct SessionLight {
  std::string name;
  int number = 1;  ///< among the scene's lights of this name, counted from 1
  LightSetting setting;

  bool operator==(const SessionLight&) const = default;
};

/// What somebody looked at and how: what a session file says (docs/manual.md, Session files).
///
/// Pictures and light vectors are no part of it; they are computed again. So what is about them stays
/// behind: the selection, the comparison and the moment of the vectors' growth. Full screen and undo are of
/// the moment, too.
struct SessionFile {
  std::filesystem::path scene;              ///< absolute, or as the current folder has it
  std::optional<CameraDescription> camera;  ///< otherwise the scene's first
  std::optional<Parameters> parameters;     ///< otherwise those that the scene asks for
  std::vector<SessionLight> lights;         ///< the others are as the scene has them
  bool cacheLocked = false;
  int threads = 0;               ///< 0: as many as the machine has cores
  int memoryLimitMegabytes = 0;  ///< 0: none
  Brightness brightness;
  Display display;  ///< what stays behind has its default

  bool operator==(const SessionFile&) const = default;
};

inline constexpr std::string_view kSessionEnding = ".lvsession";

/// The text of a session file that is to lie at `where`. Every value comes back from it to the last bit. The
/// scene's path is relative where the scene lies near, so that both can be moved together.
std::string sessionText(const SessionFile& session, const std::filesystem::path& where);

/// Reads a session file's text; `where` is what messages name and what the scene's path is relative to. What
/// is missing has its default; that of the window's settings is `usual`. Errors name file, line and key: a
/// file that is no session or of a later version, TOML that cannot be parsed, an unknown key (with the
/// nearest), a value of another type or out of its range.
Expected<SessionFile> parseSession(std::string_view text, const std::filesystem::path& where,
                                   const WindowSettings& usual = {});

/// Writes a session file, at once or not at all. Refuses what could not be read again, such as names that are
/// not UTF-8, which TOML cannot hold.
Expected<void> saveSession(const SessionFile& session, const std::filesystem::path& where);
Expected<SessionFile> loadSession(const std::filesystem::path& where, const WindowSettings& usual = {});

/// What is looked at now, and how.
SessionFile sessionOf(const Workspace& workspace, const Document& document);

struct RestoredSession {
  Workspace workspace;
  std::vector<std::string> warnings;  ///< a sentence for each thing that this scene has no place for
};
/// The workspace of a session on its scene, which may have changed since. Whether the screen is full is left
/// as `current` has it.
RestoredSession applySession(const SessionFile& session, const Document& document, const Display& current);

/// The window's settings as a file of their own, with the keys and values of a session's `[display.window]`.
std::string windowSettingsText(const WindowSettings& settings);

struct ReadSettings {
  WindowSettings settings;  ///< what is missing or wrong has its default; all of it in a later version's file
  std::optional<Error> error;  ///< as parseSession's: the first thing that is wrong
};
ReadSettings parseWindowSettings(std::string_view text, const std::filesystem::path& where);

}  // namespace lightvane
