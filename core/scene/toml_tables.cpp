#include "core/scene/toml_tables.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace lightvane {
namespace {

constexpr Interval kFieldOfView{0.001, 179.999, "", " from 0.001 to 179.999"};
constexpr Interval kExposure{-100.0, 100.0, "", " from -100 to 100"};
constexpr Interval kNotNegative{0.0, kLargestLength, "", " from 0 to 1e100"};
constexpr Interval kResolution{1.0, 65536.0, "whole ", " from 1 to 65536"};

/// A value as `--set key=value` would have it.
std::optional<std::string> settingText(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (node.is_boolean() || node.is_integer() || node.is_floating_point()) return describeNode(node);
  return std::nullopt;
}

/// Nested tables become dotted keys.
void collectSettings(TomlReport& report, const toml::table& table, const std::string& title,
                     const std::string& prefix,
                     std::vector<std::pair<toml::source_position, RenderSetting>>& settings) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      collectSettings(report, *inner, title, name + ".", settings);
      continue;
    }
    const std::optional<std::string> text = settingText(node);
    if (!text) {
      report.fail(node.source().begin,
                  fmt::format("{} of {}: expected a number, true, false or a string in quotes, found {}",
                              name, title, describeNode(node)));
      continue;
    }
    const toml::source_position position = key.source().begin;
    settings.push_back({position, {name, *text, report.place(position)}});
  }
}

void readProjection(TomlTable& table, CameraDescription& camera) {
  const std::array<std::string, 2> kWords = {"perspective", "orthographic"};
  std::string word;
  const bool isRead = table.readWord("projection", word, kWords);
  table.read("height", camera.orthographicHeight, kPositive);
  if (table.has("projection") && !isRead) return;  // the rest cannot be judged
  if (word != "orthographic") {
    if (table.has("height")) {
      table.fail("height", "cannot stand beside a perspective projection",
                 "add projection = \"orthographic\"; resolution is the picture's size in pixels");
    }
    return;
  }
  camera.projection = Projection::Orthographic;
  table.require("height", "the height of what the picture shows, in the scene's units");
  if (table.has("fov_y")) {
    table.fail("fov_y", "cannot stand beside an orthographic projection",
               "height says how much the picture shows");
  }
  for (const char* key : {"lens_radius", "focus_distance"}) {
    if (table.has(key)) {
      table.fail(key, "cannot stand beside an orthographic projection",
                 "leave it out: such a camera has no lens");
    }
  }
}

void readLens(TomlTable& table, CameraDescription& camera) {
  table.read("lens_radius", camera.lensRadius, kNotNegative);
  double focus = 0.0;
  if (!table.read("focus_distance", focus, kPositive)) return;
  camera.focusDistance = focus;
  if (!table.has("lens_radius")) {
    table.fail("focus_distance", "a distance to focus on without lens_radius",
               "add lens_radius; without a lens all is sharp");
  }
}

}  // namespace

CameraDescription readCamera(TomlTable& table) {
  CameraDescription camera;
  table.read("name", camera.name);
  table.read("position", camera.position);
  table.read("target", camera.target);
  table.readDirection("up", camera.up);
  table.read("fov_y", camera.fovYDegrees, kFieldOfView);
  std::array<int, 2> resolution = {camera.width, camera.height};
  table.read("resolution", resolution, kResolution);
  camera.width = resolution[0];
  camera.height = resolution[1];
  table.read("exposure", camera.exposureStops, kExposure);
  readProjection(table, camera);
  readLens(table, camera);
  if (!table.finish()) return camera;

  const Vec3d view = camera.target - camera.position;
  if (view == Vec3d(0.0)) {
    table.fail(table.has("target") ? "target" : "position",
               "the camera's position and target are the same point");
    return camera;
  }
  // Both directions may be of any length.
  const auto scaled = [](const Vec3d& v) {
    return v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  };
  const Vec3d forward = glm::normalize(scaled(view));
  const Vec3d up = glm::normalize(scaled(camera.up));
  if (glm::length(glm::cross(forward, up)) < 1e-6) {
    table.fail(table.has("up") ? "up" : "target", "up is parallel to the direction from position to target",
               "turn it to any direction that points upwards in the picture");
  }
  return camera;
}

std::vector<RenderSetting> readSettings(TomlTable& table) {
  std::vector<std::pair<toml::source_position, RenderSetting>> settings;
  collectSettings(table.report(), table.table(), table.title(), {}, settings);
  // In the order of the file, as options on a command line have one.
  std::sort(settings.begin(), settings.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<RenderSetting> render;
  std::set<std::string> keys;
  for (auto& [position, setting] : settings) {
    if (!keys.insert(setting.key).second) {
      table.report().fail(position, fmt::format("{} of {}: given twice", setting.key, table.title()));
    }
    render.push_back(std::move(setting));
  }
  return render;
}

}  // namespace lightvane
