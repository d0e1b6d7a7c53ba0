#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "app/command_line.h"
#include "core/render/renderer.h"

namespace lightvane {

/// What a picture is a function of, in the words of the command line.
struct PictureIdentity {
  std::filesystem::path scenePath;  ///< as given
  std::string sceneHash;
  std::span<const RenderSetting> sceneSettings;  ///< the scene's `[render]`
  Parameters parameters;
  std::string cameraName;  ///< empty for a camera without one
  bool isDefaultCamera = true;
  bool isDefaultSize = true;
  CameraChanges cameraChanges;
  std::vector<LightChange> lights;
  std::vector<LightChange> indirectLights;  ///< of reflected light; empty: as `lights`
  PictureRegion region;
  std::optional<std::filesystem::path> cache;
  bool lockedCache = false;
  int passes = 0;
  bool complete = true;                       ///< otherwise the picture is that after `passes` passes
  std::optional<double> targetError;          ///< RenderArguments::targetError
  std::optional<ErrorSourceRequest> explain;  ///< RenderArguments::explain, and tellsError
  bool tellsError = false;
  // Of files for screens (PNG) alone.
  PictureLook look;
  std::optional<std::filesystem::path> reference;  ///< that the Error view compares with
};

struct View;

/// Of a whole picture that the arguments ask for, in the scene's own look: nothing of caches and passes.
PictureIdentity identityOfView(const RenderArguments& arguments, const SceneDescription& description,
                               const Scene& scene, const View& view, const Parameters& parameters);

/// The entries of LayeredImage::metadata: lightvane_version, scene, scene_hash, method, seed, parameters
/// (those that are not at their defaults, as "key=value key=value"), camera, size, crop (where there is one),
/// lights (those that were changed), indirect_lights (where they differ from these), passes, complete, cache
/// (where there is one), and `command`, a line for a shell that renders the same pixels.
///
/// The same picture has the same entries, whatever its files were called, whoever rendered it on how many
/// threads, and whether or not it was stopped on the way. `extension` is of the file they are for.
std::map<std::string, std::string> pictureMetadata(const PictureIdentity& picture,
                                                   const std::string& extension);

/// The options of the command line that make these changes, each with its value.
std::vector<std::pair<std::string, std::string>> cameraOptions(const CameraChanges& changes);

/// The options that make a picture look so, each with its value; none for the default look.
std::vector<std::pair<std::string, std::string>> lookOptions(const PictureLook& look);

/// The command that renders the picture, to a file of this extension in the folder where it is given.
std::string renderCommand(const PictureIdentity& picture, const std::string& extension,
                          const std::string& program = "lightvane");
/// The same for this very machine: with the path of the running program, and of all files from the root.
std::string renderCommandHere(const PictureIdentity& picture, const std::string& extension);

/// A word as a POSIX shell reads it back: in single quotes where that is needed.
std::string shellQuoted(const std::string& word);

}  // namespace lightvane
