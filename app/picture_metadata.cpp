#include "app/picture_metadata.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/settings.h"
#include "app/version.h"
#include "app/view.h"
#include "core/image/image_file.h"

namespace lightvane {
namespace {

/// The text with what is not UTF-8 replaced: paths may be any bytes, metadata may not.
std::string validUtf8(const std::string& text) {
  using Json = nlohmann::json;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

bool isCropped(const PictureRegion& region) {
  return region.width != region.fullWidth || region.height != region.fullHeight;
}

std::string sizeText(const PictureRegion& region) {
  return fmt::format("{}x{}", region.fullWidth, region.fullHeight);
}

std::string cropText(const PictureRegion& region) {
  return fmt::format("{},{},{},{}", region.x, region.y, region.width, region.height);
}

/// The shortest text that reads back as the same numbers.
std::string pointOption(const Vec3d& p) { return fmt::format("{},{},{}", p.x, p.y, p.z); }

std::string lightOption(const LightChange& change) {
  const Rgb& f = change.factor;
  return f.r == f.g && f.g == f.b ? fmt::format("{}={}", change.light, f.r)
                                  : fmt::format("{}={},{},{}", change.light, f.r, f.g, f.b);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> cameraOptions(const CameraChanges& changes) {
  std::vector<std::pair<std::string, std::string>> options;
  if (changes.position) options.emplace_back("--from", pointOption(*changes.position));
  if (changes.target) options.emplace_back("--at", pointOption(*changes.target));
  if (changes.up) options.emplace_back("--up", pointOption(*changes.up));
  for (const auto& [option, value] :
       {std::pair("--fov-y", changes.fovYDegrees), std::pair("--orthographic", changes.orthographicHeight),
        std::pair("--lens-radius", changes.lensRadius),
        std::pair("--focus-distance", changes.focusDistance)}) {
    if (value) options.emplace_back(option, fmt::format("{}", *value));
  }
  return options;
}

std::vector<std::pair<std::string, std::string>> lookOptions(const PictureLook& look) {
  const PictureLook plain;
  std::vector<std::pair<std::string, std::string>> options;
  if (look.view != plain.view) options.emplace_back("--view", pictureViewInfo(look.view).name);
  if (look.source) options.emplace_back("--source", choiceName(kErrorSourceNames, *look.source));
  if (look.exposureStops != plain.exposureStops)
    options.emplace_back("--exposure", fmt::format("{}", look.exposureStops));
  if (look.toneMap != plain.toneMap)
    options.emplace_back("--tone-map", choiceName(kToneMapWords, look.toneMap));
  if (look.scale.map) options.emplace_back("--color-map", choiceName(kColorMapWords, *look.scale.map));
  if (look.scale.fixedRange)
    options.emplace_back("--range", fmt::format("{},{}", look.scale.low, look.scale.high));
  return options;
}

std::string renderCommandHere(const PictureIdentity& picture, const std::string& extension) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  PictureIdentity here = picture;
  const auto fromRoot = [&](const fs::path& path) {
    fs::path absolute = fs::absolute(path, failed).lexically_normal();
    return failed ? path : absolute;
  };
  here.scenePath = fromRoot(here.scenePath);
  if (here.cache) here.cache = fromRoot(*here.cache);
  if (here.reference) here.reference = fromRoot(*here.reference);
  return renderCommand(here, extension, program.empty() ? "lightvane" : program.string());
}

std::string renderCommand(const PictureIdentity& picture, const std::string& extension,
                          const std::string& program) {
  std::vector<std::string> words = {program, "render", picture.scenePath.string(), "-o",
                                    "picture" + extension};
  const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
  if (!picture.isDefaultCamera) add({"--camera", picture.cameraName});
  // With =, since a coordinate may begin with a minus.
  for (const auto& [option, value] : cameraOptions(picture.cameraChanges))
    add({fmt::format("{}={}", option, value)});
  for (const LightChange& change : picture.lights) add({"--light=" + lightOption(change)});
  for (const LightChange& change : picture.indirectLights) add({"--indirect-light=" + lightOption(change)});
  if (!picture.isDefaultSize) add({"--size", sizeText(picture.region)});
  if (isCropped(picture.region)) add({"--crop", cropText(picture.region)});
  for (const auto& [key, value] : reproducingSettings(picture.sceneSettings, picture.parameters)) {
    if (key == "method.name") {
      add({"--method", value});
    } else if (key == "seed") {
      add({"--seed", value});
    } else {
      add({"--set", fmt::format("{}={}", key, value)});
    }
  }
  if (picture.cache) add({"--cache", picture.cache->string()});
  if (picture.lockedCache) add({"--lock-cache"});
  if (isForScreens(extension)) {
    for (const auto& [option, value] : lookOptions(picture.look)) add({fmt::format("{}={}", option, value)});
    if (picture.reference) add({"--reference", picture.reference->string()});
  }
  if (picture.explain) {
    const ErrorSourceRequest usual;
    if (picture.tellsError) add({"--explain"});
    if (picture.explain->samples != usual.samples)
      add({"--explain-samples", std::to_string(picture.explain->samples)});
    if (picture.explain->stride != usual.stride)
      add({"--explain-stride", std::to_string(picture.explain->stride)});
  }
  if (picture.targetError) add({"--target-error", fmt::format("{:.12g}%", 100.0 * *picture.targetError)});
  if (!picture.complete) add({"--passes", std::to_string(picture.passes)});
  for (std::string& word : words) word = shellQuoted(word);
  return fmt::format("{}", fmt::join(words, " "));
}

std::string shellQuoted(const std::string& word) {
  const bool isPlain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-+=:,./%@").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (isPlain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

PictureIdentity identityOfView(const RenderArguments& arguments, const SceneDescription& description,
                               const Scene& scene, const View& view, const Parameters& parameters) {
  PictureIdentity identity;
  identity.scenePath = arguments.scene;
  identity.sceneHash = scene.hash;
  identity.sceneSettings = description.render;
  identity.parameters = parameters;
  identity.cameraName = view.cameraName;
  identity.isDefaultCamera = view.isDefaultCamera;
  identity.isDefaultSize = view.isDefaultSize;
  identity.cameraChanges = view.changes;
  identity.lights = arguments.lights;
  identity.indirectLights = arguments.indirectLights;
  identity.region = view.region;
  return identity;
}

std::map<std::string, std::string> pictureMetadata(const PictureIdentity& picture,
                                                   const std::string& extension) {
  const std::map<std::string, std::string> parameters = parametersAsText(picture.parameters);
  std::map<std::string, std::string> metadata = {
      {"lightvane_version", versionText()},
      {"scene", validUtf8(picture.scenePath.string())},
      {"scene_hash", picture.sceneHash},
      {"method", parameters.at("method.name")},
      {"seed", parameters.at("seed")},
      {"parameters", nonDefaultParameters(picture.parameters)},
      {"camera", picture.cameraName},
      {"size", sizeText(picture.region)},
      {"passes", std::to_string(picture.passes)},
      {"complete", picture.complete ? "true" : "false"},
      {"command", validUtf8(renderCommand(picture, extension))},
  };
  if (isCropped(picture.region)) metadata["crop"] = cropText(picture.region);
  const auto addLights = [&](const char* key, const std::vector<LightChange>& changes) {
    std::vector<std::string> lights;
    for (const LightChange& change : changes) lights.push_back(lightOption(change));
    if (!lights.empty()) metadata[key] = validUtf8(fmt::format("{}", fmt::join(lights, " ")));
  };
  addLights("lights", picture.lights);
  addLights("indirect_lights", picture.indirectLights);
  std::string changes;
  for (const auto& [option, value] : cameraOptions(picture.cameraChanges))
    changes += fmt::format("{}{}={}", changes.empty() ? "" : " ", option.substr(2), value);
  if (!changes.empty()) metadata["camera_changes"] = changes;
  if (picture.cache) metadata["cache"] = validUtf8(picture.cache->string());
  return metadata;
}

}  // namespace lightvane
