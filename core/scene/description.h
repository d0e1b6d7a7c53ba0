#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/color.h"
#include "core/base/load_watch.h"
#include "core/base/math.h"
#include "core/image/image.h"

namespace lightvane {

// A scene as its file says it: plain data in the file's own units and in double, before anything is compiled.
// Defaults are the scene format's; docs/scene-format.md lists them.

enum class LayerModel : std::uint8_t {
  Schlick,  ///< of 1994
  Ggx       ///< microfacets by Trowbridge and Reitz, with Smith's shadowing and Schlick's Fresnel factor
};

/// One glossy layer of a material.
struct LayerDescription {
  Rgb color{0.0f};         ///< at normal incidence
  double roughness = 1.0;  ///< in [0, 1]; Schlick's r: 0 is specular, 1 is Lambert; Ggx: alpha is its square,
                           ///< and below GgxLayer::kSmallestAlpha the layer is a mirror
  double isotropy = 1.0;   ///< Schlick's p in [0, 1]: 1 is isotropic; without a meaning for Ggx
  LayerModel model = LayerModel::Schlick;

  bool operator==(const LayerDescription&) const = default;
};

/// A texture in place of a colour: the colour that stands there is what the texture's is multiplied by.
struct TextureUse {
  std::size_t texture = 0;  ///< index into SceneDescription::textures
  double scale = 1.0;       ///< texture coordinates, or lengths in scene units, that are 1 to the texture

  bool operator==(const TextureUse&) const = default;
};

/// The colours of a material that are textures.
struct MaterialTextures {
  std::optional<TextureUse> diffuse, mirror, transmission;
  std::array<std::optional<TextureUse>, 2> layers;
  std::optional<TextureUse> emission;

  bool any() const { return ofReflection() || emission; }
  /// Of what is reflected or let through.
  bool ofReflection() const { return diffuse || mirror || transmission || ofLayers(); }
  bool ofLayers() const { return layers[0] || layers[1]; }
};

/// How much of a surface is there: through the rest, light goes straight on, as through the gaps of a fabric
/// or of a picture of leaves.
struct OpacityDescription {
  double value = 1.0;                 ///< in [0, 1]
  std::optional<TextureUse> texture;  ///< the mean of its colours multiplies the value
  double cutoff = 0.0;                ///< above 0: what is less than this is not there, and all else wholly

  bool isFull() const { return value == 1.0 && !texture; }
  bool operator==(const OpacityDescription&) const = default;
};

struct MaterialDescription {
  std::string name;
  Rgb diffuse{0.0f};  ///< Lambertian reflectance in [0, 1]; what lies under a single Ggx layer, whose lobe
                      ///< takes its part of the light first: see EnergyRule
  Rgb mirror{0.0f};   ///< purely specular reflectance in [0, 1]
  Rgb transmission{
      0.0f};  ///< glass: the part of the light that passes a surface beside Fresnel's factor, in [0, 1]
  double ior = 1.5;   ///< index of refraction inside over outside
  bool thin = false;  ///< of glass: the surface is a whole pane, and what passes it goes straight on
  std::vector<LayerDescription> layers;  ///< none, one, or two (the first is on top)
  Rgb emission{0.0f};                    ///< radiance, W m^-2 sr^-1; its texture multiplies it
  bool twoSided = false;                 ///< emits from the back side too
  std::optional<Vec3d> tangent;          ///< where isotropy < 1 and a shape has no texture coordinates
  MaterialTextures textures;
  OpacityDescription opacity;

  bool isGlass() const { return !isBlack(transmission); }
  bool emits() const { return !isBlack(emission); }
};

/// Calls visit(use) for each texture of a material's that there is.
template <class Material, class Visit>
void forEachUse(Material& material, const Visit& visit) {
  auto& textures = material.textures;
  for (auto* use : {&textures.diffuse, &textures.mirror, &textures.transmission, &textures.layers[0],
                    &textures.layers[1], &textures.emission, &material.opacity.texture}) {
    if (*use) visit(**use);
  }
}

enum class TextureWrap : std::uint8_t { Repeat, Clamp };
enum class TextureFilter : std::uint8_t { Linear, Nearest };
enum class TextureChannel : std::uint8_t { Color, Alpha };

/// A picture over texture coordinates: (0, 0) is its lower left corner, (1, 1) its upper right one.
struct ImageTextureDescription {
  std::string file;                        ///< as the scene names it, relative to the scene file
  std::shared_ptr<const ImageRgb> pixels;  ///< linear, in [0, 1]
  TextureWrap wrap = TextureWrap::Repeat;
  TextureFilter filter = TextureFilter::Linear;
  TextureChannel channel = TextureChannel::Color;  ///< alpha: `pixels` are that, in grey
};
/// Two colours in turn over texture coordinates, 1 wide.
struct CheckerDescription {
  Rgb even{0.8f};  ///< of the square at (0, 0)
  Rgb odd{0.2f};
};
/// Solid: the rings of a trunk through the origin.
struct WoodDescription {
  Rgb light{0.55f, 0.34f, 0.17f};  ///< early wood
  Rgb dark{0.27f, 0.13f, 0.06f};   ///< late wood
  Vec3d axis{0.0, 1.0, 0.0};       ///< of the trunk
  double ring = 0.05;              ///< from ring to ring
  double distortion = 1.0;         ///< how far rings wander, in their distances
  double grain = 0.3;              ///< contrast of the fibres, in that of light and dark
};
/// Solid: veins across an axis, bent by turbulence.
struct MarbleDescription {
  Rgb base{0.80f, 0.78f, 0.74f};
  Rgb vein{0.22f, 0.24f, 0.27f};
  Vec3d axis{1.0, 0.4, 0.2};
  double spacing = 0.5;     ///< from vein to vein
  double distortion = 1.5;  ///< how far veins wander, in their distances
  double sharpness = 6.0;   ///< the exponent of the wave: higher is thinner
  int octaves = 6;          ///< of the turbulence
};
using TexturePatternDescription =
    std::variant<ImageTextureDescription, CheckerDescription, WoodDescription, MarbleDescription>;
struct TextureDescription {
  std::string name;
  TexturePatternDescription pattern;
};

/// Scale, then rotate about x, y and z in this order, then translate.
struct TransformDescription {
  Vec3d translate{0.0};
  Vec3d rotateDegrees{0.0};
  Vec3d scale{1.0};

  bool operator==(const TransformDescription&) const = default;
};

/// Planar and convex; the front side is where the vertices run counter-clockwise (right-hand rule).
struct PolygonDescription {
  std::vector<Vec3d> vertices;
};
struct SphereDescription {
  Vec3d center{0.0};
  double radius = 1.0;
};
struct BoxDescription {
  Vec3d min{0.0};
  Vec3d max{1.0};
};
struct DiscDescription {
  Vec3d center{0.0};
  Vec3d normal{0.0, 1.0, 0.0};
  double radius = 1.0;
};
/// Triangles as loaded from a file, in its coordinates. normals, colors and uvs are empty or one for each
/// position.
struct MeshGeometry {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;
  std::vector<Rgb> colors;  ///< linear, in [0, 1]: multiply `diffuse`, `mirror` and `transmission`
  std::vector<Vec2> uvs;
  std::vector<glm::uvec3> triangles;
  /// For each triangle a number of its file's materials; empty where the file knows of none.
  std::vector<std::uint32_t> triangleMaterials;
};
/// A mesh where a shape puts it.
struct MeshDescription {
  std::string file;  ///< as the scene names it, relative to the scene file
  /// Shared by all shapes that place the same triangles; never null once loaded.
  std::shared_ptr<const MeshGeometry> geometry;
  /// For meshes that bring their own materials: what geometry->triangleMaterials number, as indices into
  /// SceneDescription::materials. Empty where all triangles have the shape's.
  std::vector<std::uint32_t> materials;
  /// Moves the triangles before the shape's transform does: that of a glTF file's node.
  glm::dmat4 placement{1.0};

  bool bringsMaterials() const { return !materials.empty(); }
};

using GeometryDescription =
    std::variant<PolygonDescription, SphereDescription, BoxDescription, DiscDescription, MeshDescription>;

struct ShapeDescription {
  std::string name;
  std::size_t material = 0;  ///< index into SceneDescription::materials
  std::string light;         ///< emitting shapes with the same non-empty name are one source
  TransformDescription transform;
  GeometryDescription geometry;
};

struct PointLightDescription {
  Vec3d position{0.0};
  Rgb intensity{1.0f};  ///< W sr^-1
};
/// Full intensity within the inner half-angle, none beyond the outer, smoothstep between.
struct SpotLightDescription {
  Vec3d position{0.0};
  Vec3d direction{0.0, -1.0, 0.0};  ///< from the light into the scene
  Rgb intensity{1.0f};              ///< W sr^-1 on the axis
  double innerDegrees = 20.0;
  double outerDegrees = 30.0;
};
struct DirectionalLightDescription {
  Vec3d direction{0.0, -1.0, 0.0};  ///< from the light into the scene
  Rgb irradiance{1.0f};             ///< W m^-2 on a surface facing the light
  double angleDegrees = 0.0;        ///< the light's apparent diameter; 0 is a Dirac
};
/// The paper's volumic light: point lights placed at random within a sphere, which share its intensity.
struct VolumicSphereLightDescription {
  Vec3d center{0.0};
  double radius = 0.1;
  Rgb intensity{1.0f};  ///< W sr^-1 of all points together
  int points = 32;
};
/// The sky: light from all directions, from infinitely far away.
struct EnvironmentLightDescription {
  Rgb radiance{1.0f};  ///< W m^-2 sr^-1; where there is an image, what that is multiplied by
  std::string image;   ///< as the scene names it, relative to the scene file; empty: the same from everywhere
  std::shared_ptr<const ImageRgb> pixels;  ///< of `image`, latitude by longitude, up at the top; else null
  double rotateDegrees = 0.0;              ///< about `up`, counter-clockwise seen from above
  Vec3d up{0.0, 1.0, 0.0};
};
using LightGeometryDescription =
    std::variant<PointLightDescription, SpotLightDescription, DirectionalLightDescription,
                 VolumicSphereLightDescription, EnvironmentLightDescription>;
struct LightDescription {
  std::string name;
  LightGeometryDescription geometry;
};

enum class Projection {
  Perspective,   ///< lines of sight meet in the eye
  Orthographic,  ///< they are parallel
};

struct CameraDescription {
  std::string name;
  Vec3d position{0.0, 0.0, 0.0};
  Vec3d target{0.0, 0.0, -1.0};
  Vec3d up{0.0, 1.0, 0.0};
  double fovYDegrees = 45.0;  ///< of a perspective camera
  int width = 512;
  int height = 512;
  double exposureStops = 0.0;
  Projection projection = Projection::Perspective;
  double orthographicHeight = 1.0;  ///< of what an orthographic camera's picture shows; scene units
  double lensRadius = 0.0;          ///< of a perspective camera, scene units; 0: a pinhole
  /// Along the viewing axis, scene units; without one as far as the target, wherever that is moved.
  std::optional<double> focusDistance = {};

  /// How far from the camera a lens makes all sharp, scene units.
  double resolvedFocusDistance() const { return focusDistance.value_or(glm::length(target - position)); }
  bool operator==(const CameraDescription&) const = default;
};

/// Whether the cameras see the same, whatever they are called, and however large and bright their pictures.
bool isSameView(const CameraDescription& a, const CameraDescription& b);

/// A `[render]` entry, kept as text until the parameters read it.
struct RenderSetting {
  std::string key;
  std::string value;
  std::string where;  ///< "file:line:column"
};

struct SceneDescription {
  std::filesystem::path path;
  std::string name;
  std::string units = "metre";
  std::vector<CameraDescription> cameras;  ///< never empty once loaded; the first is the default
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  std::vector<ShapeDescription> shapes;
  std::vector<LightDescription> lights;  ///< beside the emitting shapes
  std::vector<RenderSetting> render;
  std::vector<std::string> warnings;  ///< what the files carry and Lightvane does not use, each said once

  /// How many metres 1.0 is; 0 for an unknown unit.
  double metresPerUnit() const;
};

/// metre, decimetre, centimetre, millimetre, foot, inch -> metres; 0 for an unknown unit.
double metresPerUnit(const std::string& unit);
std::vector<std::string> unitNames();

/// What a hash of a scene is to tell apart.
enum class HashScope {
  Picture,  ///< everything that can change its picture
  Lighting  ///< cameras apart: the light in a scene, and the vectors that hold it, serve every view of it
};

/// The scene's identity: a 64-bit hash (xxHash) of everything within the scope, `[render]` apart, as 16
/// hexadecimal digits. Independent of the path, of comments and of the order of keys. Throws LoadStopped as
/// `watch` says.
std::string sceneHash(const SceneDescription& scene, HashScope scope = HashScope::Picture,
                      LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
