#include "core/scene/write_scene.h"

#include <optional>
#include <set>
#include <variant>

#include <fmt/format.h>

#include "core/scene/supported.h"
#include "core/scene/toml_text.h"

namespace lightvane {
namespace {

/// The lines of one table.
class TomlLines {
 public:
  explicit TomlLines(std::string title) : text_("\n" + std::move(title) + "\n") {}

  void raw(std::string_view key, std::string_view value) { text_ += tomlLine(key, value); }
  void put(std::string_view key, const std::string& value) { raw(key, tomlString(value)); }
  void put(std::string_view key, const char* value) { raw(key, tomlString(value)); }
  void put(std::string_view key, double value) { raw(key, tomlNumber(value)); }
  void put(std::string_view key, int value) { raw(key, std::to_string(value)); }
  void put(std::string_view key, bool value) { raw(key, value ? "true" : "false"); }
  void put(std::string_view key, const Vec3d& value) { raw(key, tomlTriple(value)); }
  void put(std::string_view key, const Rgb& value) { raw(key, tomlTriple(value)); }
  /// Only where it is not what is read where it is left out.
  template <class Value>
  void put(std::string_view key, const Value& value, const Value& usual) {
    if (!(value == usual)) put(key, value);
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// The beginning of the table that names a texture in the place of a value.
std::string useText(const SceneDescription& scene, const TextureUse& use) {
  std::string text = "{ texture = " + tomlString(scene.textures[use.texture].name);
  if (use.scale != 1.0) text += ", scale = " + tomlNumber(use.scale);
  return text;
}

/// A colour, or the texture that stands in its place.
std::string colorText(const SceneDescription& scene, const Rgb& color, const std::optional<TextureUse>& use) {
  if (!use) return tomlTriple(color);
  std::string text = useText(scene, *use);
  if (color != Rgb(1.0f)) text += ", color = " + tomlTriple(color);
  return text + " }";
}

std::string opacityText(const SceneDescription& scene, const OpacityDescription& opacity) {
  const auto& [value, texture, cutoff] = opacity;
  if (!texture) return tomlNumber(value);
  std::string text = useText(scene, *texture);
  if (value != 1.0) text += ", value = " + tomlNumber(value);
  if (cutoff != 0.0) text += ", cutoff = " + tomlNumber(cutoff);
  return text + " }";
}

std::string layerText(const SceneDescription& scene, const LayerDescription& layer,
                      const std::optional<TextureUse>& use) {
  const LayerDescription usual;
  std::string text = "{ color = " + colorText(scene, layer.color, use);
  if (layer.model == LayerModel::Ggx) text += ", model = \"ggx\"";
  if (layer.roughness != usual.roughness) text += ", roughness = " + tomlNumber(layer.roughness);
  if (layer.model == LayerModel::Schlick && layer.isotropy != usual.isotropy)
    text += ", isotropy = " + tomlNumber(layer.isotropy);
  return text + " }";
}

std::string materialToml(const SceneDescription& scene, const MaterialDescription& material) {
  const auto& [name, diffuse, mirror, transmission, ior, thin, layers, emission, twoSided, tangent, textures,
               opacity] = material;
  const MaterialDescription usual;
  TomlLines lines(fmt::format("[material.{}]", tomlKey(name)));
  const auto color = [&](const char* key, const Rgb& value, const std::optional<TextureUse>& use) {
    if (use || !isBlack(value)) lines.raw(key, colorText(scene, value, use));
  };
  color("diffuse", diffuse, textures.diffuse);
  color("mirror", mirror, textures.mirror);
  color("transmission", transmission, textures.transmission);
  lines.put("ior", ior, usual.ior);
  lines.put("thin", thin, usual.thin);
  std::string list;
  for (std::size_t i = 0; i < layers.size(); ++i)
    list += (i == 0 ? "" : ",\n          ") + layerText(scene, layers[i], textures.layers[i]);
  if (!list.empty()) lines.raw("layers", "[" + list + "]");
  color("emission", emission, textures.emission);
  lines.put("two_sided", twoSided, usual.twoSided);
  if (tangent) lines.put("tangent", *tangent);
  if (!opacity.isFull()) lines.raw("opacity", opacityText(scene, opacity));
  return lines.text();
}

void putPattern(const ImageTextureDescription& image, TomlLines& lines) {
  lines.put("type", "image");
  lines.put("file", image.file);
  if (image.wrap == TextureWrap::Clamp) lines.put("wrap", "clamp");
  if (image.filter == TextureFilter::Nearest) lines.put("filter", "nearest");
  if (image.channel == TextureChannel::Alpha) lines.put("channel", "alpha");
}
void putPattern(const CheckerDescription& checker, TomlLines& lines) {
  const CheckerDescription usual;
  lines.put("type", "checker");
  lines.put("even", checker.even, usual.even);
  lines.put("odd", checker.odd, usual.odd);
}
void putPattern(const WoodDescription& wood, TomlLines& lines) {
  const WoodDescription usual;
  lines.put("type", "wood");
  lines.put("light", wood.light, usual.light);
  lines.put("dark", wood.dark, usual.dark);
  lines.put("axis", wood.axis, usual.axis);
  lines.put("ring", wood.ring, usual.ring);
  lines.put("distortion", wood.distortion, usual.distortion);
  lines.put("grain", wood.grain, usual.grain);
}
void putPattern(const MarbleDescription& marble, TomlLines& lines) {
  const MarbleDescription usual;
  lines.put("type", "marble");
  lines.put("base", marble.base, usual.base);
  lines.put("vein", marble.vein, usual.vein);
  lines.put("axis", marble.axis, usual.axis);
  lines.put("spacing", marble.spacing, usual.spacing);
  lines.put("distortion", marble.distortion, usual.distortion);
  lines.put("sharpness", marble.sharpness, usual.sharpness);
  lines.put("octaves", marble.octaves, usual.octaves);
}

void putGeometry(const PolygonDescription& polygon, TomlLines& lines) {
  std::string vertices;
  for (const Vec3d& vertex : polygon.vertices)
    vertices += (vertices.empty() ? "" : ", ") + tomlTriple(vertex);
  lines.put("type", "polygon");
  lines.raw("vertices", "[" + vertices + "]");
}
void putGeometry(const SphereDescription& sphere, TomlLines& lines) {
  const SphereDescription usual;
  lines.put("type", "sphere");
  lines.put("center", sphere.center, usual.center);
  lines.put("radius", sphere.radius, usual.radius);
}
void putGeometry(const BoxDescription& box, TomlLines& lines) {
  const BoxDescription usual;
  lines.put("type", "box");
  lines.put("min", box.min, usual.min);
  lines.put("max", box.max, usual.max);
}
void putGeometry(const DiscDescription& disc, TomlLines& lines) {
  const DiscDescription usual;
  lines.put("type", "disc");
  lines.put("center", disc.center, usual.center);
  lines.put("normal", disc.normal, usual.normal);
  lines.put("radius", disc.radius, usual.radius);
}
void putGeometry(const MeshDescription& mesh, TomlLines& lines) {
  lines.put("type", "mesh");
  lines.put("file", mesh.file);
}

/// The shape's mesh, if its materials are those of its file.
const MeshDescription* meshWithMaterials(const ShapeDescription& shape) {
  const auto* mesh = std::get_if<MeshDescription>(&shape.geometry);
  return mesh != nullptr && mesh->bringsMaterials() ? mesh : nullptr;
}

std::string shapeToml(const SceneDescription& scene, const ShapeDescription& shape) {
  const auto& [name, material, light, transform, geometry] = shape;
  TomlLines lines("[[shape]]");
  lines.put("name", name, std::string());
  std::visit([&](const auto& which) { putGeometry(which, lines); }, geometry);
  if (meshWithMaterials(shape) == nullptr) lines.put("material", scene.materials[material].name);
  lines.put("light", light, std::string());
  const TransformDescription usual;
  if (transform == usual) return lines.text();
  std::string parts;
  const auto part = [&](const char* key, const Vec3d& value, const Vec3d& without) {
    if (value != without)
      parts += (parts.empty() ? "" : ", ") + fmt::format("{} = {}", key, tomlTriple(value));
  };
  part("translate", transform.translate, usual.translate);
  part("rotate", transform.rotateDegrees, usual.rotateDegrees);
  part("scale", transform.scale, usual.scale);
  lines.raw("transform", "{ " + parts + " }");
  return lines.text();
}

void putLight(const PointLightDescription& light, TomlLines& lines) {
  const PointLightDescription usual;
  lines.put("type", "point");
  lines.put("position", light.position, usual.position);
  lines.put("intensity", light.intensity, usual.intensity);
}
void putLight(const SpotLightDescription& light, TomlLines& lines) {
  const SpotLightDescription usual;
  lines.put("type", "spot");
  lines.put("position", light.position, usual.position);
  lines.put("direction", light.direction, usual.direction);
  lines.put("intensity", light.intensity, usual.intensity);
  lines.put("inner", light.innerDegrees, usual.innerDegrees);
  lines.put("outer", light.outerDegrees, usual.outerDegrees);
}
void putLight(const DirectionalLightDescription& light, TomlLines& lines) {
  const DirectionalLightDescription usual;
  lines.put("type", "directional");
  lines.put("direction", light.direction, usual.direction);
  lines.put("irradiance", light.irradiance, usual.irradiance);
  lines.put("angle", light.angleDegrees, usual.angleDegrees);
}
void putLight(const VolumicSphereLightDescription& light, TomlLines& lines) {
  const VolumicSphereLightDescription usual;
  lines.put("type", "sphere");
  lines.put("center", light.center, usual.center);
  lines.put("radius", light.radius, usual.radius);
  lines.put("intensity", light.intensity, usual.intensity);
  lines.put("points", light.points, usual.points);
}
void putLight(const EnvironmentLightDescription& light, TomlLines& lines) {
  const EnvironmentLightDescription usual;
  lines.put("type", "environment");
  lines.put("radiance", light.radiance, usual.radiance);
  lines.put("image", light.image, usual.image);
  lines.put("rotate", light.rotateDegrees, usual.rotateDegrees);
  lines.put("up", light.up, usual.up);
}

std::string lightToml(const LightDescription& light) {
  TomlLines lines("[[light]]");
  lines.put("name", light.name, std::string());
  std::visit([&](const auto& which) { putLight(which, lines); }, light.geometry);
  return lines.text();
}

/// Materials and textures that come with a mesh's file, and so are not the scene's own.
struct Brought {
  std::set<std::size_t> materials, textures;

  explicit Brought(const SceneDescription& scene) {
    for (const ShapeDescription& shape : scene.shapes) {
      if (const MeshDescription* mesh = meshWithMaterials(shape))
        materials.insert(mesh->materials.begin(), mesh->materials.end());
    }
    for (const std::size_t material : materials) {
      forEachUse(scene.materials[material], [this](const TextureUse& use) { textures.insert(use.texture); });
    }
  }
};

}  // namespace

std::string cameraToml(const CameraDescription& camera, const std::string& title) {
  const auto& [name, position, target, up, fovYDegrees, width, height, exposureStops, projection,
               orthographicHeight, lensRadius, focusDistance] = camera;
  std::string text = title + "\n";
  if (!name.empty()) text += tomlLine("name", tomlString(name));
  text += tomlLine("position", tomlTriple(position)) + tomlLine("target", tomlTriple(target)) +
          tomlLine("up", tomlTriple(up));
  if (projection == Projection::Orthographic) {
    text += tomlLine("projection", tomlString("orthographic")) +
            tomlLine("height", tomlNumber(orthographicHeight));
  } else {
    text += tomlLine("fov_y", tomlNumber(fovYDegrees));
    if (lensRadius > 0.0 || focusDistance) text += tomlLine("lens_radius", tomlNumber(lensRadius));
    if (focusDistance) text += tomlLine("focus_distance", tomlNumber(*focusDistance));
  }
  return text + tomlLine("resolution", fmt::format("[{}, {}]", width, height)) +
         tomlLine("exposure", tomlNumber(exposureStops));
}

Expected<std::string> sceneToml(const SceneDescription& scene) {
  if (sceneFileKind(scene.path) == SceneFileKind::Gltf)
    return makeError(scene.path.string(), "the parts of a glTF file have no files of their own",
                     R"(name it in a scene file: [[shape]], type = "mesh", file = ")" +
                         scene.path.filename().string() + "\"");
  const SceneDescription usual;
  std::string text = tomlLine("version", "1");
  if (!scene.name.empty()) text += tomlLine("name", tomlString(scene.name));
  if (scene.units != usual.units) text += tomlLine("units", tomlString(scene.units));
  for (const CameraDescription& camera : scene.cameras)
    text += "\n" + cameraToml(camera, scene.cameras.size() == 1 ? "[camera]" : "[[cameras]]");

  const Brought brought(scene);
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    if (brought.textures.contains(i)) continue;
    TomlLines lines(fmt::format("[texture.{}]", tomlKey(scene.textures[i].name)));
    std::visit([&](const auto& pattern) { putPattern(pattern, lines); }, scene.textures[i].pattern);
    text += lines.text();
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (!brought.materials.contains(i)) text += materialToml(scene, scene.materials[i]);
  }
  for (const ShapeDescription& shape : scene.shapes) text += shapeToml(scene, shape);
  for (const LightDescription& light : scene.lights) text += lightToml(light);
  if (scene.render.empty()) return text;
  TomlLines render("[render]");
  for (const RenderSetting& setting : scene.render) render.raw(setting.key, tomlSetting(setting.value));
  return text + render.text();
}

}  // namespace lightvane
