#include "core/scene/load_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/image_format.h"
#include "core/scene/polygon.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

enum class Encoding { Ascii, LittleEndian, BigEndian };

enum class NumberType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct TypeName {
  std::string_view name;
  NumberType type;
};
constexpr std::array kTypeNames = {
    TypeName{"char", NumberType::Int8},      TypeName{"int8", NumberType::Int8},
    TypeName{"uchar", NumberType::Uint8},    TypeName{"uint8", NumberType::Uint8},
    TypeName{"short", NumberType::Int16},    TypeName{"int16", NumberType::Int16},
    TypeName{"ushort", NumberType::Uint16},  TypeName{"uint16", NumberType::Uint16},
    TypeName{"int", NumberType::Int32},      TypeName{"int32", NumberType::Int32},
    TypeName{"uint", NumberType::Uint32},    TypeName{"uint32", NumberType::Uint32},
    TypeName{"float", NumberType::Float32},  TypeName{"float32", NumberType::Float32},
    TypeName{"double", NumberType::Float64}, TypeName{"float64", NumberType::Float64}};

std::optional<NumberType> typeNamed(std::string_view name) {
  for (const TypeName& each : kTypeNames) {
    if (each.name == name) return each.type;
  }
  return std::nullopt;
}

std::size_t sizeOf(NumberType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool isReal(NumberType type) { return type == NumberType::Float32 || type == NumberType::Float64; }

struct Property {
  std::string name;
  NumberType type = NumberType::Float32;
  std::optional<NumberType> countType;  ///< of a list: what says how long it is
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  /// The place of the first property that is called like one of these.
  std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (std::find(names.begin(), names.end(), properties[i].name) != names.end()) return i;
    }
    return std::nullopt;
  }
};

struct Header {
  Encoding encoding = Encoding::Ascii;
  std::vector<Element> elements;
};

/// Where the reading is; after the first error it stays there.
class Reader {
 public:
  Reader(const fs::path& path, std::string_view bytes, LoadWatch& watch)
      : path_(path), bytes_(bytes), watch_(watch) {}

  const std::optional<Error>& error() const { return error_; }
  bool failed() const { return error_.has_value(); }
  std::size_t bytesLeft() const { return bytes_.size() - position_; }

  void fail(std::string what, std::string hint = {}) {
    if (failed()) return;
    const std::string where = isText_ ? fmt::format("{}:{}", path_.string(), line_) : path_.string();
    error_ = Error{where, std::move(what), std::move(hint)};
  }

  /// The next line of the header without its end.
  std::optional<std::string_view> line() {
    step();
    const std::size_t end = bytes_.find('\n', position_);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view text = bytes_.substr(position_, end - position_);
    while (text.ends_with('\r') || text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
    position_ = end + 1;
    ++line_;
    return text;
  }

  /// The body begins: numbers are words of lines, or bytes.
  void begin(Encoding encoding) {
    encoding_ = encoding;
    isText_ = encoding == Encoding::Ascii;
    ++line_;
  }

  double number(NumberType type) {
    if (failed()) return 0.0;
    step();
    return isText_ ? word(type) : binary(type);
  }

  /// Something is read, be it nothing.
  void step() {
    // As LoadWatch::piece, with a fraction by the bytes.
    constexpr std::size_t kStepsPerLook = 4096;
    if (steps_++ % kStepsPerLook == 0)
      watch_.look(static_cast<double>(position_) / static_cast<double>(bytes_.size() + 1));
  }

 private:
  double word(NumberType type) {
    while (position_ < bytes_.size() && isSpace(bytes_[position_])) {
      if (bytes_[position_] == '\n') ++line_;
      ++position_;
    }
    std::size_t end = position_;
    while (end < bytes_.size() && !isSpace(bytes_[end])) ++end;
    std::string_view text = bytes_.substr(position_, end - position_);
    if (text.empty()) {
      fail("the file ends before its elements do");
      return 0.0;
    }
    position_ = end;
    const std::string_view whole = text;
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [after, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool isNumber = status == std::errc() && after == text.data() + text.size();
    if (!isNumber || (!isReal(type) && value != std::floor(value))) {
      fail(fmt::format("expected {}, found \"{}\"", isReal(type) ? "a number" : "a whole number",
                       printable(whole)));
      return 0.0;
    }
    return value;
  }

  static bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  double binary(NumberType type) {
    const std::size_t size = sizeOf(type);
    if (bytesLeft() < size) {
      fail("the file ends before its elements do");
      return 0.0;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = encoding_ == Encoding::LittleEndian ? i : size - 1 - i;
      bits |= std::uint64_t{static_cast<unsigned char>(bytes_[position_ + i])} << (8 * place);
    }
    position_ += size;
    switch (type) {
      case NumberType::Int8:
        return static_cast<double>(static_cast<std::int8_t>(bits));
      case NumberType::Uint8:
        return static_cast<double>(static_cast<std::uint8_t>(bits));
      case NumberType::Int16:
        return static_cast<double>(static_cast<std::int16_t>(bits));
      case NumberType::Uint16:
        return static_cast<double>(static_cast<std::uint16_t>(bits));
      case NumberType::Int32:
        return static_cast<double>(static_cast<std::int32_t>(bits));
      case NumberType::Uint32:
        return static_cast<double>(static_cast<std::uint32_t>(bits));
      case NumberType::Float32:
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      case NumberType::Float64:
        return std::bit_cast<double>(bits);
    }
    return 0.0;
  }

  const fs::path& path_;
  std::string_view bytes_;
  LoadWatch& watch_;
  std::size_t steps_ = 0;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
  bool isText_ = true;  ///< the header is
  Encoding encoding_ = Encoding::Ascii;
  std::optional<Error> error_;
};

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

void readFormat(Reader& reader, std::span<const std::string_view> words, Header& header) {
  const std::string_view name = words.size() == 3 && words[2] == "1.0" ? words[1] : std::string_view();
  if (name == "ascii") {
    header.encoding = Encoding::Ascii;
  } else if (name == "binary_little_endian") {
    header.encoding = Encoding::LittleEndian;
  } else if (name == "binary_big_endian") {
    header.encoding = Encoding::BigEndian;
  } else {
    reader.fail("expected format ascii, binary_little_endian or binary_big_endian, and 1.0");
  }
}

void readElement(Reader& reader, std::span<const std::string_view> words, Header& header) {
  Element element;
  if (words.size() == 3) {
    element.name = words[1];
    const bool isKnown = std::any_of(header.elements.begin(), header.elements.end(),
                                     [&](const Element& other) { return other.name == element.name; });
    if (isKnown) return reader.fail(fmt::format("a second element {}", printable(element.name)));
    const std::string_view count = words[2];
    const auto [end, status] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (status == std::errc() && end == count.data() + count.size()) {
      header.elements.push_back(std::move(element));
      return;
    }
  }
  reader.fail("expected element, its name and how many there are");
}

void readProperty(Reader& reader, std::span<const std::string_view> words, Header& header) {
  if (header.elements.empty()) return reader.fail("a property before the first element");
  const bool isList = words.size() == 5 && words[1] == "list";
  if (!isList && words.size() != 3) return reader.fail("expected property, its type and its name");
  Property property;
  property.name = words.back();
  const std::optional<NumberType> type = typeNamed(words[words.size() - 2]);
  if (!type) return reader.fail(fmt::format("unknown type \"{}\"", printable(words[words.size() - 2])));
  property.type = *type;
  if (isList) {
    property.countType = typeNamed(words[2]);
    if (!property.countType) return reader.fail(fmt::format("unknown type \"{}\"", printable(words[2])));
  }
  header.elements.back().properties.push_back(std::move(property));
}

Header readHeader(Reader& reader) {
  Header header;
  bool hasFormat = false;
  if (reader.line() != "ply") {
    reader.fail("is not a PLY file: it does not begin with the line ply");
    return header;
  }
  while (!reader.failed()) {
    const std::optional<std::string_view> line = reader.line();
    if (!line) {
      reader.fail("the header has no end", "expected the line end_header");
      break;
    }
    const std::vector<std::string_view> words = wordsOf(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      readFormat(reader, words, header);
      hasFormat = true;
    } else if (words[0] == "element") {
      readElement(reader, words, header);
    } else if (words[0] == "property") {
      readProperty(reader, words, header);
    } else {
      reader.fail(fmt::format("unknown statement \"{}\"", printable(words[0])));
    }
  }
  if (!hasFormat) reader.fail("the header has no format");
  return header;
}

/// Bytes that an element takes at least: of ascii numbers a digit and a space.
std::size_t leastSize(const Element& element, Encoding encoding) {
  std::size_t size = 0;
  for (const Property& property : element.properties)
    size += encoding == Encoding::Ascii ? 2 : sizeOf(property.countType.value_or(property.type));
  return size;
}

/// Reads one element: `values` gets its numbers by property, `lists` the last list of each.
void readOne(Reader& reader, const Element& element, std::vector<double>& values,
             std::vector<std::vector<double>>& lists) {
  reader.step();
  values.assign(element.properties.size(), 0.0);
  lists.resize(element.properties.size());
  for (std::size_t i = 0; i < element.properties.size() && !reader.failed(); ++i) {
    const Property& property = element.properties[i];
    lists[i].clear();
    if (!property.countType) {
      values[i] = reader.number(property.type);
      continue;
    }
    const double count = reader.number(*property.countType);
    if (!(count >= 0.0) || count > static_cast<double>(reader.bytesLeft()))
      return reader.fail(fmt::format("a list of {} numbers in a file that has no room for it", count));
    for (double n = 0.0; n < count && !reader.failed(); n += 1.0)
      lists[i].push_back(reader.number(property.type));
  }
}

/// The vertices of the file as they stand, before faces choose among them.
struct Vertices {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;  ///< 0 where one has no length or is no number
  std::vector<Rgb> colors;
  std::vector<Vec2> uvs;
  bool hasBrightColors = false;  ///< beyond 1, where they end
};

/// A colour's component: whole numbers are parts of 255, or of 65535 where the type says so, and sRGB as in
/// pictures.
float colorComponent(double value, NumberType type) {
  const auto clamped = [](double part) {
    return part >= 0.0 ? static_cast<float>(std::min(part, 1.0)) : 0.0f;
  };
  if (isReal(type)) return clamped(value);
  return decodeSrgb(clamped(value / (type == NumberType::Uint16 ? 65535.0 : 255.0)));
}

void readVertices(Reader& reader, const Element& element, Vertices& vertices) {
  const auto x = element.find({"x"}), y = element.find({"y"}), z = element.find({"z"});
  if (!x || !y || !z) return reader.fail("its vertices have no x, y and z");
  const auto nx = element.find({"nx"}), ny = element.find({"ny"}), nz = element.find({"nz"});
  const auto u = element.find({"s", "u", "texture_u", "texture_s"});
  const auto v = element.find({"t", "v", "texture_v", "texture_t"});
  const auto red = element.find({"red", "diffuse_red"}), green = element.find({"green", "diffuse_green"}),
             blue = element.find({"blue", "diffuse_blue"});
  std::vector<double> values;
  std::vector<std::vector<double>> lists;
  constexpr double kMost = std::numeric_limits<float>::max();
  for (std::uint64_t i = 0; i < element.count; ++i) {
    readOne(reader, element, values, lists);
    if (reader.failed()) return;
    const Vec3d position(values[*x], values[*y], values[*z]);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(position[axis]) <= kMost))
        return reader.fail(
            fmt::format("vertex {} is at {}: expected finite numbers up to 3.4e38", i, position[axis]));
    }
    vertices.positions.push_back(position);
    if (nx && ny && nz) {
      const Vec3d normal(values[*nx], values[*ny], values[*nz]);
      const double length = glm::length(normal);
      // One without length or of no number is as good as none.
      vertices.normals.push_back(length > 0.0 && std::isfinite(length) ? normal : Vec3d(0.0));
    }
    if (red && green && blue) {
      const auto component = [&](std::size_t which) {
        const NumberType type = element.properties[which].type;
        vertices.hasBrightColors |= isReal(type) && values[which] > 1.0;
        return colorComponent(values[which], type);
      };
      vertices.colors.emplace_back(component(*red), component(*green), component(*blue));
    }
    if (u && v) vertices.uvs.emplace_back(static_cast<float>(values[*u]), static_cast<float>(values[*v]));
  }
}

bool isOfStrips(const Element& element) { return element.name == "tristrips" || element.name == "tristrip"; }

/// The corners of all faces, one after another, and how many each has.
struct Faces {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> counts;
  bool hasThinOnes = false;  ///< of fewer than 3 corners, which are left out
};

bool isVertexNumber(double corner, std::uint64_t vertexCount) {
  return corner >= 0.0 && corner < static_cast<double>(vertexCount) && corner == std::floor(corner);
}

/// Adds the triangles of a strip, of which every other one turns the other way round.
void addStrip(std::span<const double> strip, Faces& faces) {
  if (strip.size() < 3) faces.hasThinOnes = true;
  for (std::size_t i = 2; i < strip.size(); ++i) {
    std::array<std::uint32_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = static_cast<std::uint32_t>(strip[i - 2 + k]);
    if (i % 2 == 1) std::swap(corners[0], corners[1]);
    // Strips turn corners by triangles of two.
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) continue;
    faces.corners.insert(faces.corners.end(), corners.begin(), corners.end());
    faces.counts.push_back(3);
  }
}

/// Calls visit(i, corners) for the list of vertices of each of an element, which messages call `what`, until
/// the reader fails.
template <class Visit>
void forEachCornerList(Reader& reader, const Element& element, const char* what, const Visit& visit) {
  const auto corners = element.find({"vertex_indices", "vertex_index"});
  if (!corners || !element.properties[*corners].countType)
    return reader.fail(fmt::format("its {} have no list vertex_indices", what));
  std::vector<double> values;
  std::vector<std::vector<double>> lists;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    readOne(reader, element, values, lists);
    if (reader.failed()) return;
    visit(i, std::span<const double>(lists[*corners]));
    if (reader.failed()) return;
  }
}

/// Strips of triangles, as Stanford's scanner writes them: several in a list, with -1 between them.
void readStrips(Reader& reader, const Element& element, std::uint64_t vertexCount, Faces& faces) {
  forEachCornerList(reader, element, "tristrips", [&](std::uint64_t i, std::span<const double> rest) {
    while (!rest.empty()) {
      const auto end = std::find(rest.begin(), rest.end(), -1.0);
      const auto strip = rest.first(static_cast<std::size_t>(end - rest.begin()));
      for (const double corner : strip) {
        reader.step();
        if (!isVertexNumber(corner, vertexCount))
          return reader.fail(
              fmt::format("strip {} names vertex {}, and there are {}", i, corner, vertexCount));
      }
      addStrip(strip, faces);
      rest = rest.subspan(std::min(strip.size() + 1, rest.size()));
    }
  });
}

void readFaces(Reader& reader, const Element& element, std::uint64_t vertexCount, Faces& faces) {
  forEachCornerList(reader, element, "faces", [&](std::uint64_t i, std::span<const double> face) {
    constexpr std::size_t kMostCorners = 4096;  // cutting ears takes their square
    if (face.size() > kMostCorners)
      return reader.fail(fmt::format("face {} has {} corners", i, face.size()), "cut it into smaller ones");
    for (const double corner : face) {
      if (!isVertexNumber(corner, vertexCount))
        return reader.fail(fmt::format("face {} names vertex {}, and there are {}", i, corner, vertexCount));
    }
    if (face.size() < 3) {
      faces.hasThinOnes = true;
      return;
    }
    for (const double corner : face) faces.corners.push_back(static_cast<std::uint32_t>(corner));
    faces.counts.push_back(static_cast<std::uint32_t>(face.size()));
  });
}

/// What the file carries and is not used, each once.
std::vector<std::string> unusedOf(const Header& header) {
  constexpr std::array<std::string_view, 20> kOfVertices = {"x",
                                                            "y",
                                                            "z",
                                                            "nx",
                                                            "ny",
                                                            "nz",
                                                            "s",
                                                            "t",
                                                            "u",
                                                            "v",
                                                            "texture_u",
                                                            "texture_v",
                                                            "texture_s",
                                                            "texture_t",
                                                            "red",
                                                            "green",
                                                            "blue",
                                                            "diffuse_red",
                                                            "diffuse_green",
                                                            "diffuse_blue"};
  constexpr std::array<std::string_view, 2> kOfFaces = {"vertex_indices", "vertex_index"};
  std::vector<std::string> unused;
  for (const Element& element : header.elements) {
    const bool isVertex = element.name == "vertex";
    const bool isFace = element.name == "face" || isOfStrips(element);
    if (!isVertex && !isFace) unused.push_back("element " + printable(element.name));
    const std::span<const std::string_view> used =
        isVertex ? std::span<const std::string_view>(kOfVertices) : kOfFaces;
    for (const Property& property : element.properties) {
      const bool isUsed = std::find(used.begin(), used.end(), property.name) != used.end();
      if ((isVertex || isFace) && !isUsed)
        unused.push_back(fmt::format("{} of {}", printable(property.name), element.name));
    }
  }
  return unused;
}

/// Whether all vertices of faces have a normal; what no face uses need not.
bool haveNormals(const Vertices& vertices, const Faces& faces) {
  return std::all_of(faces.corners.begin(), faces.corners.end(),
                     [&](std::uint32_t corner) { return vertices.normals[corner] != Vec3d(0.0); });
}

std::vector<std::string> warningsOf(const fs::path& path, const Header& header, const Vertices& vertices,
                                    const Faces& faces, bool isMissingNormals) {
  std::vector<std::string> warnings;
  const auto say = [&](const std::string& what) { warnings.push_back(path.string() + ": " + what); };
  const std::vector<std::string> unused = unusedOf(header);
  if (!unused.empty()) say("not used: " + listWords(unused));
  if (faces.hasThinOnes) say("faces of fewer than 3 corners are left out");
  if (isMissingNormals) say("normals of no length: the mesh is flat-shaded");
  if (vertices.hasBrightColors) say("colours beyond 1 are taken as 1");
  return warnings;
}

MeshGeometry meshOf(Vertices vertices, const Faces& faces, LoadWatch& watch) {
  MeshGeometry mesh;
  mesh.normals = std::move(vertices.normals);
  // What no face uses must have one, too.
  std::replace(mesh.normals.begin(), mesh.normals.end(), Vec3d(0.0), Vec3d(0.0, 0.0, 1.0));
  mesh.positions = std::move(vertices.positions);
  mesh.uvs = std::move(vertices.uvs);
  mesh.colors = std::move(vertices.colors);
  std::vector<Vec3d> outline;
  std::size_t first = 0;
  for (std::size_t face = 0; face < faces.counts.size(); ++face) {
    watch.piece(face, faces.counts.size());
    const std::uint32_t count = faces.counts[face];
    outline.clear();
    for (std::size_t i = first; i < first + count; ++i) outline.push_back(mesh.positions[faces.corners[i]]);
    for (const glm::uvec3& t : triangulate(outline, watch))
      mesh.triangles.emplace_back(faces.corners[first + t.x], faces.corners[first + t.y],
                                  faces.corners[first + t.z]);
    first += count;
  }
  return mesh;
}

}  // namespace

Expected<MeshFile> loadPly(const fs::path& path, LoadWatch& watch) {
  const LoadStage stage(watch, "reading " + path.filename().string());
  watch.part(0.0, 0.1);
  const Expected<std::string> bytes = readFile(path, watch);
  if (!bytes) return tl::unexpected(bytes.error());
  watch.part(0.1, 0.7);
  Reader reader(path, *bytes, watch);
  const Header header = readHeader(reader);
  reader.begin(header.encoding);
  Vertices vertices;
  Faces faces;
  // Faces may stand before the vertices that they name.
  std::uint64_t vertexCount = 0;
  for (const Element& element : header.elements) vertexCount += element.name == "vertex" ? element.count : 0;
  for (const Element& element : header.elements) {
    if (reader.failed()) break;
    const std::size_t least = leastSize(element, header.encoding);
    if (element.count > (reader.bytesLeft() + 1) / std::max<std::size_t>(least, 1)) {
      reader.fail(fmt::format("it has no room for {} elements {}", element.count, printable(element.name)));
    } else if (element.name == "vertex") {
      readVertices(reader, element, vertices);
    } else if (element.name == "face") {
      readFaces(reader, element, vertexCount, faces);
    } else if (isOfStrips(element)) {
      readStrips(reader, element, vertexCount, faces);
    } else {
      std::vector<double> values;
      std::vector<std::vector<double>> lists;
      for (std::uint64_t i = 0; i < element.count && !reader.failed(); ++i)
        readOne(reader, element, values, lists);
    }
  }
  if (const std::optional<Error>& error = reader.error()) return tl::unexpected(*error);
  if (faces.counts.empty())
    return makeError(path.string(), "the file has no faces or strips of triangles",
                     "points alone cannot be rendered");
  MeshFile file;
  watch.part(0.7, 1.0);
  const bool hasColors = !vertices.colors.empty();
  const bool isMissingNormals = !vertices.normals.empty() && !haveNormals(vertices, faces);
  if (isMissingNormals) vertices.normals.clear();
  file.warnings = warningsOf(path, header, vertices, faces, isMissingNormals);
  file.geometry = meshOf(std::move(vertices), faces, watch);
  file.geometry.triangleMaterials.assign(file.geometry.triangles.size(), 0);
  file.materials.push_back(defaultMaterial(path));
  if (!hasColors) {
    file.materialWarnings.push_back(defaultMaterialWarning(path));
  } else {
    file.materials.back().diffuse = Rgb(1.0f);  // the vertices say what of it is reflected
  }
  return file;
}

Expected<SceneDescription> loadPlyScene(const fs::path& path, LoadWatch& watch) {
  Expected<MeshFile> mesh = loadPly(path, watch);
  if (!mesh) return tl::unexpected(mesh.error());
  return sceneOfMesh(path, std::move(*mesh), "a PLY file", watch);
}

}  // namespace lightvane
