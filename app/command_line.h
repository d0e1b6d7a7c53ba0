#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "app/settings.h"
#include "core/base/error.h"
#include "core/inspect/error_sources.h"
#include "core/inspect/picture_style.h"
#include "core/measure/sweep.h"

namespace lightvane {

struct PictureSize {
  int width = 0;
  int height = 0;

  bool operator==(const PictureSize&) const = default;
};

/// A rectangle of the full picture, in pixels from its top left.
struct PictureCrop {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  bool operator==(const PictureCrop&) const = default;
};

/// A camera other than the scene's own, in the scene's units: what is given replaces that of the camera
/// chosen.
struct CameraChanges {
  std::optional<Vec3d> position;
  std::optional<Vec3d> target;
  std::optional<Vec3d> up;
  std::optional<double> fovYDegrees;         ///< makes the camera a perspective one
  std::optional<double> orthographicHeight;  ///< makes it an orthographic one; not beside fovYDegrees
  std::optional<double> lensRadius;
  std::optional<double> focusDistance;

  bool operator==(const CameraChanges&) const = default;
  bool any() const { return *this != CameraChanges{}; }
};

/// A light whose radiance is multiplied, colour by colour.
struct LightChange {
  std::string light;
  Rgb factor{1.0f};

  bool operator==(const LightChange&) const = default;
};

/// `lightvane render`: what was written, read as numbers, not yet held against a scene.
struct RenderArguments {
  std::filesystem::path scene;
  std::vector<std::filesystem::path> outputs;  ///< at least one
  CommandLineSettings settings;
  std::optional<std::string> camera;
  CameraChanges cameraChanges;
  std::vector<LightChange> lights;
  std::vector<LightChange> indirectLights;  ///< of reflected light; empty: as `lights`
  std::optional<PictureSize> size;
  std::optional<PictureCrop> crop;
  int threads = 0;            ///< 0: as many as the machine has cores
  std::optional<int> passes;  ///< ends after so many
  std::optional<double> timeLimitSeconds;
  bool resume = false;
  /// `lightvane reference`: ends where the picture's noise (pictureNoise) is no larger, and keeps the
  /// checkpoint for a smaller one.
  std::optional<double> targetNoise;
  /// Computes vectors until the error that they tell of (targetErrorOf) is no larger.
  std::optional<double> targetError;
  /// Finds out where the error of the complete picture comes from: for the view that shows it and, with
  /// `tellsError`, for a table.
  std::optional<ErrorSourceRequest> explain;
  bool tellsError = false;
  bool quiet = false;
  std::optional<std::filesystem::path> stats;
  std::optional<std::filesystem::path> saveCache;
  std::optional<std::filesystem::path> cache;
  bool lockCache = false;
  // Of pictures for screens.
  PictureLook look;
  std::optional<std::filesystem::path> reference;  ///< that the Error view compares with
};

/// `lightvane scene`.
struct SceneArguments {
  std::filesystem::path scene;
  bool json = false;
  bool asToml = false;  ///< the scene itself, in place of what there is to say about it
};

/// `lightvane parameters`: all of them, or those named by a key or by the part of it before a dot.
struct ParametersArguments {
  std::vector<std::string> keys;
  bool markdown = false;
};

/// `lightvane paper`.
struct PaperArguments {
  std::filesystem::path folder = "paper";  ///< for the pictures
  std::vector<int> figures;                ///< 3, 4 and 5; empty: all
  double scale = 1.0;                      ///< of the pictures' width and height
  int referenceSamples = 256;              ///< paths a pixel; 0: no errors
  int threads = 0;                         ///< as RenderArguments
  bool quiet = false;
};

/// `lightvane compare`.
struct CompareArguments {
  std::filesystem::path picture, reference;
  std::vector<std::string> metrics;  ///< names that findMetric knows; empty: all
  std::vector<std::string> layers;   ///< as ComparisonRequest
  bool withoutEdges = false, withoutLights = false;
  float exposureStops = 0.0f;
  std::optional<std::filesystem::path> map;  ///< of the only metric
  ScaleOverride scale;                       ///< of a map for screens
  bool json = false;
  bool quiet = false;
};

/// `lightvane sweep`.
struct SweepArguments {
  RenderArguments view;  ///< of the scene, the view, the settings that all points share, and the work
  std::filesystem::path folder, reference;
  std::vector<VariedParameter> varied;
  bool around = false;        ///< one parameter at a time; otherwise all combinations, or
  std::optional<int> random;  ///< so many of these
  int seeds = 1;
  std::vector<std::string> rivals = {"direct", "path", "naive"};  ///< methods that are put on the same axes
  bool withoutEdges = false, withoutLights = false;
  /// The other half of a reference that was path traced twice (meanOfHalves).
  std::optional<std::filesystem::path> secondReference;
};

/// `lightvane sweep --study NAME`.
struct StudyArguments {
  std::string study;  ///< a name that findStudy knows
  /// As for a sweep of one scene, but for the scene; `folder` and `reference` are of all, the latter empty
  /// for a folder within the former. Pictures fit into the size.
  SweepArguments sweep;
  std::vector<std::filesystem::path> scenes;  ///< empty: all that ship
  int referencePaths = 1024;                  ///< a pixel, of each half of a reference
  bool markdown = false;
};

/// No command: a scene or a session to look at, or nothing.
struct OpenArguments {
  std::optional<std::filesystem::path> file;
};

/// --help and --version: text for stdout.
struct TextAnswer {
  std::string text;
};

using CommandLine = std::variant<RenderArguments, SceneArguments, ParametersArguments, PaperArguments,
                                 CompareArguments, SweepArguments, StudyArguments, OpenArguments, TextAnswer>;

/// Reads the words after the program's name. Touches no file. Errors name the option, what it takes, and the
/// nearest option or command where there is none of that name.
Expected<CommandLine> parseCommandLine(std::span<const std::string> words);

/// "90", "90s", "1.5m", "2h" -> seconds, above 0.
Expected<double> parseDuration(const std::string& text, const std::string& where);
/// "0.5%" or "0.005" -> a part of 1, above 0.
Expected<double> parsePercentage(const std::string& text, const std::string& where);
/// "640x480"
Expected<PictureSize> parseSize(const std::string& text, const std::string& where);
/// "X,Y,W,H"
Expected<PictureCrop> parseCrop(const std::string& text, const std::string& where);
/// "X,Y,Z"
Expected<Vec3d> parsePoint(const std::string& text, const std::string& where);
/// "LOW,HIGH", finite and rising
Expected<ScaleOverride> parseScaleRange(const std::string& text, const std::string& where);
/// "NAME=0.5" or "NAME=0.5,0.4,0.3"
Expected<LightChange> parseLight(const std::string& text, const std::string& where);

}  // namespace lightvane
