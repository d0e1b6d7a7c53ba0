#include "core/io/ply_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/base/file.h"
#include "core/image/image_format.h"
#include "core/io/archive.h"
#include "core/vectors/validity.h"

namespace lightvane {
namespace {

/// A vector of either kind, in the scene's own units: a vertex.
struct Vertex {
  Vec3d position{0.0};
  Vec3 normal{0.0f};
  Rgb color{0.0f};  ///< in [0, 1], sRGB
  bool isDirect = false;
  std::uint32_t light = kNone;
  SurfaceKey key = kLambertKey;
  float radius = 0.0f;
  Vec3 direction{0.0f};
  Vec3 outgoing{0.0f};
  Rgb energy{0.0f};
  Rgb irradiance{0.0f};
  Rgb lobeRadiance{0.0f};
  Vec3 gradient[3] = {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)};
  Vec3 rotation[3] = {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)};
  float arithmeticMean = 0.0f;
  float harmonicMean = 0.0f;
  float leastDistance = 0.0f;
  float lobeWidth = 0.0f;
  float solidAngle = 0.0f;
  bool occluded = false;
  float footprint = 0.0f;
  Birth birth;
};

/// The list of properties: the header and the vertices are read off it, so that they cannot disagree.
template <class Row>
void visitVertex(Row& row, const Vertex& v) {
  row("x", static_cast<float>(v.position.x), "place");
  row("y", static_cast<float>(v.position.y));
  row("z", static_cast<float>(v.position.z));
  row("nx", v.normal.x, "shading normal, on the viewer's side");
  row("ny", v.normal.y);
  row("nz", v.normal.z);
  const auto channel = [](float c) { return static_cast<std::uint8_t>(std::lround(255.0f * c)); };
  row("red", channel(v.color.r), "energy for display: sRGB, the brightest twentieth of its kind is clipped");
  row("green", channel(v.color.g));
  row("blue", channel(v.color.b));
  row("kind", static_cast<std::uint8_t>(v.isDirect ? 1 : 0), "0: ILV (indirect light), 1: DLV (direct)");
  row("light", static_cast<std::int32_t>(v.light), "of a DLV, counted from 0; -1 for ILVs");
  row("surface_key", v.key,
      "vectors serve surfaces of their key: 0 all diffuse ones, else 1 + a BRDF's number");
  row("radius", v.radius, "length within which the vector is valid");
  row.vector("direction", v.direction, "where the light comes from on average, unit; 0 where there is none");
  row.vector("outgoing", v.outgoing, "towards the viewer, unit");
  row.color("energy", v.energy, "irradiance, W/m^2; of lobes radiance, W/(m^2 sr); or P of L = P f(D)");
  row.color("irradiance", v.irradiance, "of ILVs");
  row.color("lobe_radiance", v.lobeRadiance, "of DLVs: what the surface's lobe sends towards the viewer");
  row.vector("gradient_red", v.gradient[0], "of an ILV's energy, per unit of length");
  row.vector("gradient_green", v.gradient[1]);
  row.vector("gradient_blue", v.gradient[2]);
  row.vector("rotation_red", v.rotation[0], "of an ILV's energy when the normal turns: an axis, per radian");
  row.vector("rotation_green", v.rotation[1]);
  row.vector("rotation_blue", v.rotation[2]);
  row("mean_distance", v.arithmeticMean, "of what an ILV's rays met: length, infinite where that is nothing");
  row("harmonic_mean_distance", v.harmonicMean);
  row("least_distance", v.leastDistance);
  row("lobe_width", v.lobeWidth, "half width, radians; 0 without a lobe");
  row("solid_angle", v.solidAngle, "of a DLV's light, sr");
  row("occluded", static_cast<std::uint8_t>(v.occluded), "a DLV whose light is wholly hidden");
  row("footprint", v.footprint, "width of a pixel of a picture 256 pixels high, length");
  row("birth_pass", v.birth.pass, "that computed it; 0 is the seed");
  row("birth_order", v.birth.order, "among the pass's vectors of its kind");
  row("birth_pixel", v.birth.pixel, "that asked for it, row by row from the top left");
  row("birth_rays", v.birth.rays, "its cost");
  row("through_specular", static_cast<std::uint8_t>(v.birth.throughSpecular),
      "that pixel sees it by way of a mirror or glass");
}

/// Parts of a property that has several.
template <class Row>
class RowParts {
 public:
  void vector(const std::string& name, const Vec3& v, const char* help = "") {
    Row& row = static_cast<Row&>(*this);
    row(name + "_x", v.x, help);
    row(name + "_y", v.y);
    row(name + "_z", v.z);
  }
  void color(const std::string& name, const Rgb& c, const char* help = "") {
    Row& row = static_cast<Row&>(*this);
    row(name + "_r", c.r, help);
    row(name + "_g", c.g);
    row(name + "_b", c.b);
  }
};

const char* typeName(float) { return "float"; }
const char* typeName(std::uint8_t) { return "uchar"; }
const char* typeName(std::int32_t) { return "int"; }
const char* typeName(std::uint32_t) { return "uint"; }

/// The properties' lines of the header.
class HeaderRow : public RowParts<HeaderRow> {
 public:
  template <class T>
  void operator()(const std::string& name, T value, const char* help = "") {
    if (help[0] != '\0') comments += fmt::format("comment {}: {}\n", name, help);
    properties += fmt::format("property {} {}\n", typeName(value), name);
  }
  std::string comments;
  std::string properties;
};

/// A vertex's bytes.
class ByteRow : public RowParts<ByteRow> {
 public:
  explicit ByteRow(ByteWriter& bytes) : bytes_(bytes) {}
  void operator()(const std::string&, float value, const char* = "") {
    bytes_.number(std::bit_cast<std::uint32_t>(value));
  }
  void operator()(const std::string&, std::int32_t value, const char* = "") {
    bytes_.number(static_cast<std::uint32_t>(value));
  }
  template <std::unsigned_integral U>
  void operator()(const std::string&, U value, const char* = "") {
    bytes_.number(value);
  }

 private:
  ByteWriter& bytes_;
};

/// Turns vectors into vertices of the scene's units.
class VertexMaker {
 public:
  VertexMaker(const Scene& scene, const VectorParameters& parameters)
      : normalisation_(scene.normalisation), radii_(parameters, scene) {}

  Vertex operator()(const IndirectLightVector& r) const {
    Vertex v = vertex(r.point, r.direction, r.energy, radii_(r), r.birth);
    v.irradiance = light(r.irradiance);
    for (int c = 0; c < 3; ++c) {
      v.gradient[c] = light(r.gradient[c]) / length(1.0f);
      v.rotation[c] = light(r.rotation[c]);
    }
    v.arithmeticMean = length(r.arithmeticMean);
    v.harmonicMean = length(r.harmonicMean);
    v.leastDistance = length(r.leastDistance);
    v.lobeWidth = r.lobeWidth;
    return v;
  }
  Vertex operator()(const DirectLightVector& r, std::uint32_t lightNumber) const {
    Vertex v = vertex(r.point, r.direction, r.energy, radii_(r), r.birth);
    v.isDirect = true;
    v.light = lightNumber;
    v.lobeRadiance = light(r.lobeRadiance);
    v.solidAngle = r.solidAngle;
    v.occluded = r.occluded;
    return v;
  }

 private:
  float length(float normalised) const {
    return static_cast<float>(normalisation_.sceneLength(static_cast<double>(normalised)));
  }
  Vec3 light(const Vec3& normalised) const { return normalisation_.radianceScale() * normalised; }

  Vertex vertex(const VectorPoint& point, const Vec3& direction, const Rgb& energy, float radius,
                const Birth& birth) const {
    Vertex v;
    v.position = normalisation_.scenePoint(point.position);
    v.normal = point.normal;
    v.key = point.key;
    v.radius = length(radius);
    v.direction = direction;
    v.outgoing = point.outgoing;
    v.energy = light(energy);
    v.footprint = length(point.footprint);
    v.birth = birth;
    return v;
  }

  const Normalisation& normalisation_;
  VectorRadii radii_;
};

/// Colours for display. Vectors of lamps nearby would leave all others black: the brightest twentieth is
/// clipped.
void colorVertices(std::vector<Vertex>& vertices, bool isDirect) {
  std::vector<float> brightnesses;
  for (const Vertex& v : vertices) {
    if (v.isDirect == isDirect && isValidSample(v.energy)) brightnesses.push_back(maxComponent(v.energy));
  }
  if (brightnesses.empty()) return;
  const auto bright = brightnesses.begin() + static_cast<std::ptrdiff_t>(brightnesses.size() * 19 / 20);
  std::nth_element(brightnesses.begin(), bright, brightnesses.end());
  const float scale = *bright > 0.0f ? 1.0f / *bright : 1.0f;
  for (Vertex& v : vertices) {
    if (v.isDirect != isDirect || !isValidSample(v.energy)) continue;
    for (int c = 0; c < 3; ++c) v.color[c] = encodeSrgb(scale * v.energy[c]);
  }
}

std::vector<Vertex> verticesOf(const Snapshot& snapshot, const Scene& scene,
                               const VectorParameters& parameters) {
  const VertexMaker make(scene, parameters);
  std::vector<Vertex> vertices;
  vertices.reserve(snapshot.indirect.size() + snapshot.directCount());
  for (std::size_t i = 0; i < snapshot.indirect.size(); ++i) vertices.push_back(make(snapshot.indirect[i]));
  for (std::uint32_t light = 0; light < snapshot.direct.size(); ++light) {
    for (std::size_t i = 0; i < snapshot.direct[light].size(); ++i)
      vertices.push_back(make(snapshot.direct[light][i], light));
  }
  colorVertices(vertices, false);
  colorVertices(vertices, true);
  return vertices;
}

std::string headerOf(std::size_t vertexCount, const Scene& scene, const PlyOrigin& origin) {
  HeaderRow row;
  visitVertex(row, Vertex{});
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header +=
      fmt::format("comment {}: light vectors of {}\n", printable(origin.program), printable(origin.scene));
  header += fmt::format("comment lengths in the scene's units, of {} m each; light in W/m^2 and W/(m^2 sr)\n",
                        scene.metresPerUnit);
  for (std::size_t i = 0; i < scene.lightNames.size(); ++i) {
    if (!scene.lightNames[i].empty())
      header += fmt::format("comment light {} is {}\n", i, printable(scene.lightNames[i]));
  }
  header += row.comments;
  header += fmt::format("element vertex {}\n", vertexCount);
  return header + row.properties + "end_header\n";
}

}  // namespace

bool isPlyPath(const std::filesystem::path& path) { return fileEnding(path) == ".ply"; }

std::string encodePly(const Snapshot& snapshot, const Scene& scene, const VectorParameters& parameters,
                      const PlyOrigin& origin) {
  const std::vector<Vertex> vertices = verticesOf(snapshot, scene, parameters);
  ByteWriter bytes;
  ByteRow row(bytes);
  for (const Vertex& vertex : vertices) visitVertex(row, vertex);
  return headerOf(vertices.size(), scene, origin) + bytes.bytes();
}

Expected<void> writePly(const std::filesystem::path& path, const Snapshot& snapshot, const Scene& scene,
                        const VectorParameters& parameters, const PlyOrigin& origin) {
  return writeFileAtomically(path, encodePly(snapshot, scene, parameters, origin));
}

}  // namespace lightvane
