#include "app/scene_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/base/overloaded.h"
#include "core/render/renderer.h"
#include "core/render/vectors_of_lights.h"
#include "core/scene/light_facts.h"

namespace lightvane {
namespace {

std::string shapeKind(const GeometryDescription& geometry) {
  return std::visit(
      Overloaded{[](const PolygonDescription&) { return "polygon"; },
                 [](const SphereDescription&) { return "sphere"; },
                 [](const BoxDescription&) { return "box"; }, [](const DiscDescription&) { return "disc"; },
                 [](const MeshDescription&) { return "mesh"; }},
      geometry);
}

std::string vectorsReason(DlvMode mode, bool hasVectors, int rays) {
  switch (mode) {
    case DlvMode::Always:
      return "dlv.mode is always";
    case DlvMode::Never:
      return "dlv.mode is never";
    case DlvMode::Auto:
      break;
  }
  if (isBeyondVectors(rays))
    return fmt::format("{} shadow rays a point leave less noise than vectors have errors", rays);
  return fmt::format("{} shadow ray{} a point {} a look-up of vectors", rays, rays == 1 ? "" : "s",
                     hasVectors  ? "cost more than"
                     : rays == 1 ? "costs no more than"
                                 : "cost no more than");
}

std::vector<SceneReport::Light> reportLights(const Scene& scene, const Parameters& parameters) {
  const std::vector<bool> hasVectors = lightsWithVectors(scene, parameters);
  // Normalised radiance times normalised area, in W.
  const double watts =
      static_cast<double>(scene.normalisation.radianceScale()) * square(scene.metresPerNormalisedUnit());
  const DlvMode mode = parameters.vectors.dlv.mode;
  std::vector<SceneReport::Light> lights;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const int rays = shadowRaysOf(light, parameters.transport.lightSamples);
    lights.push_back({scene.lightNames[i], lightKind(light),
                      watts * static_cast<double>(lightPower(light, 0.5f * scene.diagonal)), rays,
                      hasVectors[i], vectorsReason(mode, hasVectors[i], rays)});
  }
  return lights;
}

std::vector<SceneReport::Material> reportMaterials(const SceneDescription& description, const Scene& scene) {
  std::vector<std::set<std::uint32_t>> shapesOf(scene.materials.size());
  for (const Surface& surface : scene.surfaces) shapesOf[surface.material].insert(surface.shape);
  std::vector<SceneReport::Material> materials;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Brdf& brdf = scene.materials[i].brdf;
    SceneReport::Material material{description.materials[i].name, {}, shapesOf[i].size()};
    const std::pair<bool, const char*> parts[] = {{brdf.hasDiffuse(), "diffuse"},
                                                  {brdf.hasLobe(), "lobe"},
                                                  {brdf.hasSpecular() && !brdf.isGlass(), "specular"},
                                                  {brdf.isGlass(), "glass"},
                                                  {brdf.isAnisotropic(), "anisotropic"},
                                                  {description.materials[i].emits(), "emission"}};
    for (const auto& [has, name] : parts) {
      if (has) material.parts.emplace_back(name);
    }
    materials.push_back(std::move(material));
  }
  return materials;
}

std::string bytesText(std::size_t bytes) {
  constexpr const char* kUnits[] = {"B", "KiB", "MiB", "GiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (value >= 1024.0 && unit + 1 < std::size(kUnits)) {
    value /= 1024.0;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", value, unit == 0 ? 0 : 1, kUnits[unit]);
}

std::string counted(std::size_t count, const std::string& kind) {
  const char* plural = kind == "box" || kind == "mesh" ? "es" : "s";
  return fmt::format("{} {}{}", count, kind, count == 1 ? "" : plural);
}

std::string nameOr(const std::string& name, const char* otherwise) { return name.empty() ? otherwise : name; }

using Cells = std::vector<std::vector<std::string>>;

/// Rows under a title, indented, in columns.
std::string section(const std::string& title, const Cells& rows) {
  if (rows.empty()) return fmt::format("\n{}: none\n", title);
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text = fmt::format("\n{}:\n", title);
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format(" {:<{}} ", row[i], widths[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

SceneReport::Camera reportCamera(const CameraDescription& description) {
  SceneReport::Camera camera;
  camera.name = description.name;
  camera.width = description.width;
  camera.height = description.height;
  if (description.projection == Projection::Orthographic) {
    camera.orthographicHeight = description.orthographicHeight;
  } else {
    camera.fovYDegrees = description.fovYDegrees;
    camera.lensRadius = description.lensRadius;
    camera.focusDistance = description.resolvedFocusDistance();
  }
  return camera;
}

std::string sightInWords(const SceneReport::Camera& camera, const std::string& units) {
  if (camera.orthographicHeight)
    return fmt::format("orthographic, {:.6g} {} high", *camera.orthographicHeight, units);
  std::string words = fmt::format("{:.6g} degrees high", camera.fovYDegrees.value_or(0.0));
  if (camera.lensRadius > 0.0) {
    words += fmt::format(", a lens of radius {:.6g} {}, sharp at {:.6g} {}", camera.lensRadius, units,
                         camera.focusDistance, units);
  }
  return words;
}

}  // namespace

SceneReport reportScene(const SceneDescription& description, const std::shared_ptr<const Scene>& scene,
                        const Parameters& parameters, LoadWatch& watch) {
  SceneReport report;
  report.file = description.path.string();
  report.name = scene->name;
  report.hash = scene->hash;
  report.units = description.units;
  report.metresPerUnit = scene->metresPerUnit;
  report.diagonal = scene->normalisation.sceneLength(static_cast<double>(scene->diagonal));
  for (const char* kind : {"polygon", "sphere", "box", "disc", "mesh"}) {
    const auto count =
        std::count_if(description.shapes.begin(), description.shapes.end(),
                      [&](const ShapeDescription& shape) { return shapeKind(shape.geometry) == kind; });
    if (count > 0) report.shapes.emplace_back(kind, static_cast<std::size_t>(count));
  }
  report.triangles = scene->triangleCount();
  report.materials = reportMaterials(description, *scene);
  report.lights = reportLights(*scene, parameters);
  for (const CameraDescription& camera : description.cameras) {
    report.cameras.push_back(reportCamera(camera));
  }
  report.needs = scene->needs;
  report.accelerationBytes = Tracer(scene, watch).memoryBytes();
  report.warnings = scene->warnings;
  return report;
}

std::vector<std::string> needsInWords(const SceneNeeds& needs) {
  const std::pair<bool, const char*> clauses[] = {
      {needs.diffuse, "diffuse surfaces: vectors that keep irradiance"},
      {needs.lobes, "glossy lobes: vectors that keep radiance towards a direction"},
      {needs.anisotropy, "anisotropic lobes: tangents"},
      {needs.specular, needs.glass ? "mirrors and glass: what is seen is followed through both branches"
                                   : "mirrors: what is seen is followed through them"},
      {needs.panes, "thin panes or gaps in surfaces: shadow rays that go on behind them"},
      {needs.areaLights, "area lights: shadow rays to many of their points"},
      {needs.infiniteLights, "light from outside: shadow rays that leave the scene"},
      {needs.smoothNormals, "smooth normals: shading apart from the geometry's"},
      {needs.analyticShapes, "spheres or discs: exact, beside triangles"}};
  std::vector<std::string> words;
  for (const auto& [needed, clause] : clauses) {
    if (needed) words.emplace_back(clause);
  }
  return words;
}

std::string sceneReportText(const SceneReport& report) {
  std::string text = nameOr(report.name, "(without a name)") + "\n";
  std::string diagonal = fmt::format("{:.6g} {}", report.diagonal, report.units);
  if (report.metresPerUnit != 1.0) {
    diagonal += fmt::format(" ({:.6g} metre)", report.diagonal * report.metresPerUnit);
  }
  std::vector<std::string> shapes;
  for (const auto& [kind, count] : report.shapes) shapes.push_back(counted(count, kind));
  const std::pair<const char*, std::string> facts[] = {
      {"file", report.file},
      {"hash", report.hash},
      {"units", report.units},
      {"diagonal", diagonal},
      {"shapes", fmt::format("{} ({})", fmt::join(shapes, ", "), counted(report.triangles, "triangle"))},
      {"memory", bytesText(report.accelerationBytes) + " for tracing rays"}};
  for (const auto& [what, value] : facts) text += fmt::format("  {:<9} {}\n", what, value);

  Cells lights;
  for (const auto& light : report.lights) {
    lights.push_back(
        {light.name, light.kind, fmt::format("{:.4g} W", light.watts),
         fmt::format("{}: {}", light.hasVectors ? "with vectors" : "without vectors", light.reason)});
  }
  text += section("Lights", lights);
  Cells materials;
  for (const auto& material : report.materials) {
    materials.push_back(
        {nameOr(material.name, "(without a name)"),
         material.parts.empty() ? "black" : fmt::format("{}", fmt::join(material.parts, ", ")),
         counted(material.shapes, "shape")});
  }
  text += section("Materials", materials);
  Cells cameras;
  for (const auto& camera : report.cameras) {
    cameras.push_back({nameOr(camera.name, "(without a name)"),
                       fmt::format("{}x{}", camera.width, camera.height),
                       sightInWords(camera, report.units)});
  }
  text += section("Cameras", cameras);
  Cells needs;
  for (const std::string& clause : needsInWords(report.needs)) needs.push_back({clause});
  text += section("Needs", needs);
  Cells warnings;
  for (const std::string& warning : report.warnings) warnings.push_back({warning});
  return warnings.empty() ? text : text + section("Warnings", warnings);
}

std::string sceneReportJson(const SceneReport& report) {
  using Json = nlohmann::ordered_json;
  Json shapes = Json::object();
  for (const auto& [kind, count] : report.shapes) shapes[kind] = count;
  Json lights = Json::array();
  for (const auto& light : report.lights) {
    lights.push_back({{"name", light.name},
                      {"kind", light.kind},
                      {"watts", light.watts},
                      {"shadow_rays", light.shadowRays},
                      {"vectors", light.hasVectors},
                      {"reason", light.reason}});
  }
  Json materials = Json::array();
  for (const auto& material : report.materials) {
    materials.push_back({{"name", material.name}, {"parts", material.parts}, {"shapes", material.shapes}});
  }
  Json cameras = Json::array();
  for (const auto& camera : report.cameras) {
    Json json = {{"name", camera.name}};
    if (camera.fovYDegrees) json["fov_y_degrees"] = *camera.fovYDegrees;
    if (camera.orthographicHeight) json["orthographic_height"] = *camera.orthographicHeight;
    if (camera.lensRadius > 0.0) {
      json["lens_radius"] = camera.lensRadius;
      json["focus_distance"] = camera.focusDistance;
    }
    json["resolution"] = Json::array({camera.width, camera.height});
    cameras.push_back(std::move(json));
  }
  const SceneNeeds& needs = report.needs;
  const Json json = {{"file", report.file},
                     {"name", report.name},
                     {"hash", report.hash},
                     {"units", report.units},
                     {"metres_per_unit", report.metresPerUnit},
                     {"diagonal", report.diagonal},
                     {"shapes", shapes},
                     {"triangles", report.triangles},
                     {"memory_bytes", report.accelerationBytes},
                     {"lights", lights},
                     {"materials", materials},
                     {"cameras", cameras},
                     {"needs",
                      {{"specular", needs.specular},
                       {"glass", needs.glass},
                       {"panes", needs.panes},
                       {"lobes", needs.lobes},
                       {"diffuse", needs.diffuse},
                       {"anisotropy", needs.anisotropy},
                       {"area_lights", needs.areaLights},
                       {"infinite_lights", needs.infiniteLights},
                       {"smooth_normals", needs.smoothNormals},
                       {"analytic_shapes", needs.analyticShapes},
                       {"missing_caustics", needs.missingCaustics}}},
                     {"warnings", report.warnings}};
  // Paths may be any bytes; JSON may not.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lightvane
