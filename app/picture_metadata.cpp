#include "app/picture_metadata.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/settings.h"
#include "app/version.h"

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

std::string commandLine(const PictureIdentity& picture, const std::string& extension) {
  std::vector<std::string> words = {"lightvane", "render", picture.scenePath.string(), "-o",
                                    "picture" + extension};
  const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
  if (!picture.isDefaultCamera) add({"--camera", picture.cameraName});
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
  if (!picture.complete) add({"--passes", std::to_string(picture.passes)});
  for (std::string& word : words) word = shellQuoted(word);
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace

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
      {"command", validUtf8(commandLine(picture, extension))},
  };
  if (isCropped(picture.region)) metadata["crop"] = cropText(picture.region);
  if (picture.cache) metadata["cache"] = validUtf8(picture.cache->string());
  return metadata;
}

}  // namespace lightvane
