#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "core/scene/gltf_mesh.h"
#include "core/scene/load_gltf.h"
#include "tests/support/temporary_folder.h"

namespace lightvane::test {

/// The bytes of numbers, the least significant first.
template <class Bits>
std::string littleEndian(std::initializer_list<Bits> numbers) {
  std::string bytes;
  for (const Bits number : numbers) {
    for (std::size_t i = 0; i < sizeof(Bits); ++i)
      bytes += static_cast<char>((static_cast<std::uint64_t>(number) >> (8 * i)) & 0xffU);
  }
  return bytes;
}
inline std::string floats(std::initializer_list<float> numbers) {
  std::string bytes;
  for (const float number : numbers) bytes += littleEndian({std::bit_cast<std::uint32_t>(number)});
  return bytes;
}

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

constexpr int kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125, kFloat = 5126;

/// A glTF file that is put together from its parts: a right triangle in the plane of x and y, shown by a
/// node, unless told otherwise.
class GltfText {
 public:
  /// Adds a view of these bytes and returns its index.
  int view(const std::string& bytes, const std::string& more = "") {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    views.push_back(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", buffer.size(),
                                bytes.size(), more));
    buffer += bytes;
    return static_cast<int>(views.size()) - 1;
  }
  /// Adds an accessor of a view and returns its index.
  int accessor(int view, int type, std::size_t count, const std::string& kind, const std::string& more = "") {
    accessors.push_back(fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})",
                                    view, type, count, kind, more));
    return static_cast<int>(accessors.size()) - 1;
  }
  int positions(std::initializer_list<float> numbers) {
    return accessor(view(floats(numbers)), kFloat, numbers.size() / 3, "VEC3");
  }
  /// Adds a part of the file: `set("meshes", "[...]")`.
  GltfText& set(const std::string& key, const std::string& json) {
    parts[key] = json;
    return *this;
  }
  /// A mesh of one triangle with more attributes, R"(,"NORMAL":1)", and more of the primitive.
  GltfText& triangle(const std::string& attributes = "", const std::string& more = "") {
    const int index = positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    return set("meshes", fmt::format(R"([{{"primitives":[{{"attributes":{{"POSITION":{}{}}}{}}}]}}])", index,
                                     attributes, more));
  }

  /// The JSON, with a buffer of this URI; none: a GLB file's own.
  std::string json(const std::string& uri) const {
    std::map<std::string, std::string> all = parts;
    all.try_emplace("asset", R"({"version":"2.0"})");
    all.try_emplace("nodes", R"([{"mesh":0}])");
    if (!buffer.empty())
      all.try_emplace("buffers", fmt::format(R"([{{"byteLength":{}{}}}])", buffer.size(),
                                             uri.empty() ? "" : R"(,"uri":")" + uri + '"'));
    all.try_emplace("bufferViews", fmt::format("[{}]", fmt::join(views, ",")));
    all.try_emplace("accessors", fmt::format("[{}]", fmt::join(accessors, ",")));
    std::vector<std::string> members;
    for (const auto& [key, value] : all) members.push_back(fmt::format("\"{}\":{}", key, value));
    return fmt::format("{{{}}}", fmt::join(members, ","));
  }
  std::string gltf() const { return json("data:application/octet-stream;base64," + base64(buffer)); }
  std::string glb() const {
    std::string text = json("");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = buffer;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const auto size = [](const std::string& part) { return static_cast<std::uint32_t>(part.size()); };
    return "glTF" + littleEndian<std::uint32_t>({2, 28 + size(text) + size(bytes), size(text)}) + "JSON" +
           text + littleEndian<std::uint32_t>({size(bytes)}) + std::string("BIN\0", 4) + bytes;
  }

  std::string buffer;
  std::vector<std::string> views;
  std::vector<std::string> accessors;
  std::map<std::string, std::string> parts;
};

/// Reads files that are put together as GltfText.
class GltfFolder {
 public:
  SceneDescription scene(const GltfText& text) const { return scene(text.gltf()); }
  SceneDescription scene(const std::string& bytes) const {
    Expected<SceneDescription> read = loadGltfScene(folder.write("a.gltf", bytes));
    EXPECT_TRUE(read) << read.error().message();
    return read ? *std::move(read) : SceneDescription{};
  }
  /// The mesh of the scene's shape.
  /// The shape's triangles where they are placed.
  static MeshGeometry meshOf(const SceneDescription& scene, std::size_t shape = 0) {
    const auto& mesh = std::get<MeshDescription>(scene.shapes.at(shape).geometry);
    MeshGeometry placed = *mesh.geometry;
    placeGltfMesh(mesh.placement, placed, LoadWatch::none());
    return placed;
  }
  /// The error without the folder's name.
  std::string refusal(const std::string& bytes, const std::string& name = "a.gltf") const {
    const Expected<SceneDescription> read = loadGltfScene(folder.write(name, bytes));
    if (read) return "none";
    const std::string message = read.error().message();
    const std::string where = folder.path().string() + "/";
    return message.starts_with(where) ? message.substr(where.size()) : message;
  }

  TemporaryFolder folder;
};

}  // namespace lightvane::test
