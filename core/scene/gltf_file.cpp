#include "core/scene/gltf_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <istream>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "core/base/watched_text.h"
#include "core/image/image_format.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

// tinygltf walks nested values by recursion, copies a GLB file's binary part into every buffer without a URI,
// reads each picture as often as it is named, and asks for files by names it has decoded its own way. So the
// JSON is looked through before tinygltf has it, and files are read by us, when it asks.

/// glTF itself nests 10 values or so; what goes further belongs to extras.
constexpr std::size_t kDeepest = 100;
/// A value takes some 200 bytes once it is read; numbers of geometry are in buffers.
constexpr std::size_t kMostValues = 10'000'000;
constexpr std::uint64_t kMostBufferBytes = std::uint64_t{8} << 30;
/// Lengths in GLB files, and tinygltf's, have 32 bits.
constexpr std::uintmax_t kMostGltfBytes = 0xffff'ffffU;

const std::vector<std::string> kReadExtensions = {
    "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_volume",
    "KHR_mesh_quantization",      "KHR_texture_transform"};

struct BufferEntry {
  std::string uri;  ///< empty: a GLB file's own binary part
  std::uint64_t byteLength = 0;
  std::size_t uriEnd = 0;  ///< in the JSON, after its closing quote
  bool isTaken = false;    ///< its data: URI is no more in the JSON
};

/// Looks through JSON without keeping it: whether it is whole and of a decent depth, and what its buffers
/// say.
class JsonScan : public nlohmann::json_sax<nlohmann::json> {
 public:
  std::vector<BufferEntry> buffers;
  std::string wrong;  ///< empty as long as nothing is
  bool isObject = false;
  bool hasAsset = false;

  explicit JsonScan(const WatchedText& text) : text_(text) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t number) override {
    if (isOfBuffer() && key_ == "byteLength") buffers.back().byteLength = number;
    return value();
  }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t& text) override {
    if (isOfBuffer() && key_ == "uri") {
      buffers.back().uri = std::move(text);
      buffers.back().uriEnd = text_.position();
    }
    return value();
  }
  bool binary(binary_t&) override { return value(); }
  bool start_object(std::size_t) override {
    if (depth_ == 0) isObject = true;
    if (!enter()) return false;
    if (depth_ == 3 && isInBuffers_) buffers.emplace_back();
    return true;
  }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool key(string_t& key) override {
    key_ = key;
    if (depth_ != 1) return true;
    hasAsset = hasAsset || key == "asset";
    isInBuffers_ = key == "buffers";
    if (isInBuffers_ && std::exchange(hasBuffers_, true)) return fail("it has buffers twice");
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) override {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::string_view text = error.what();
    return fail("its JSON is damaged: " + printable(text.substr(std::min(text.find("] ") + 2, text.size()))));
  }

 private:
  bool isOfBuffer() const { return depth_ == 3 && isInBuffers_ && !buffers.empty(); }
  bool fail(std::string what) {
    if (wrong.empty()) wrong = std::move(what);
    return false;
  }
  bool value() {
    return ++values_ <= kMostValues || fail(fmt::format("its JSON has more than {} values", kMostValues));
  }
  bool enter() {
    return value() &&
           (++depth_ <= kDeepest || fail(fmt::format("its JSON has values nested deeper than {}", kDeepest)));
  }
  bool leave() {
    --depth_;
    return true;
  }

  const WatchedText& text_;
  std::size_t depth_ = 0;  ///< 1 within the outermost object, 3 within an object of a list there
  std::size_t values_ = 0;
  std::string key_;
  bool isInBuffers_ = false;
  bool hasBuffers_ = false;
};

// ---- GLB

constexpr std::string_view kGlbMagic = "glTF";
constexpr std::size_t kGlbHeader = 12;
constexpr std::size_t kChunkHeader = 8;

std::uint32_t wordAt(std::string_view bytes, std::size_t place) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::uint32_t{static_cast<unsigned char>(bytes[place + i])} << (8 * i);
  return word;
}

/// The JSON of a GLB file, after both of its parts were found to be there.
Expected<std::string_view> glbJson(const fs::path& path, std::string_view bytes) {
  const auto wrong = [&path](std::string what) { return makeError(path.string(), std::move(what)); };
  if (bytes.size() < kGlbHeader + kChunkHeader) return wrong("is cut off within its header");
  if (wordAt(bytes, 4) != 2) return wrong(fmt::format("is GLB version {}: expected 2", wordAt(bytes, 4)));
  const std::size_t length = wordAt(bytes, 8);
  if (length > bytes.size())
    return wrong(fmt::format("is cut off: it says it has {} bytes, and there are {}", length, bytes.size()));
  bytes = bytes.substr(0, length);
  std::string_view json;
  for (std::size_t at = kGlbHeader, chunk = 0; at < length && chunk < 2; ++chunk) {
    if (length - at < kChunkHeader || wordAt(bytes, at) > length - at - kChunkHeader)
      return wrong(fmt::format("its {} part does not fit into it", chunk == 0 ? "JSON" : "binary"));
    const std::size_t size = wordAt(bytes, at);
    if (bytes.substr(at + 4, 4) != (chunk == 0 ? std::string_view("JSON") : std::string_view("BIN\0", 4)))
      return wrong(fmt::format("expected its {} part, found another", chunk == 0 ? "JSON" : "binary"));
    if (chunk == 0) json = bytes.substr(at + kChunkHeader, size);
    at += kChunkHeader + size;
  }
  return json;
}

// ---- buffers within the JSON

/// What tinygltf reads, too.
constexpr std::string_view kDataUris[] = {"data:application/octet-stream;base64,",
                                          "data:application/gltf-buffer;base64,",
                                          "data:image/jpeg;base64,",
                                          "data:image/png;base64,",
                                          "data:image/bmp;base64,",
                                          "data:image/gif;base64,",
                                          "data:text/plain;base64,"};

/// The base64 of a data: URI; nothing where it is none.
std::optional<std::string_view> base64Of(std::string_view uri) {
  for (const std::string_view start : kDataUris) {
    if (uri.starts_with(start)) return uri.substr(start.size());
  }
  return std::nullopt;
}

/// Up to the first character that is none of base64's.
std::vector<unsigned char> decodeBase64(std::string_view text, LoadWatch& watch) {
  std::array<int, 256> digits;
  digits.fill(-1);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    digits[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    watch.piece(i);
    const int digit = digits[static_cast<unsigned char>(text[i])];
    if (digit < 0) break;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    // Of four digits the first brings no whole byte, and each other one.
    if (i % 4 > 0) bytes.push_back(static_cast<unsigned char>(bits >> (6 - 2 * (i % 4))));
  }
  return bytes;
}

/// Puts a short name in the place of each buffer's data: URI, since tinygltf takes seconds to decode 100 MB
/// and cannot be stopped: it asks for a file of that name.
void takeDataUris(std::string& json, std::vector<BufferEntry>& buffers) {
  for (std::size_t i = buffers.size(); i-- > 0;) {
    const std::string& uri = buffers[i].uri;
    if (!base64Of(uri) || uri.find('"') != std::string::npos) continue;
    const std::size_t end = buffers[i].uriEnd - 1;
    // Without a quote in it, it begins after the last one; with escapes it is longer than it reads.
    std::size_t first = end - uri.size();
    if (json[first - 1] != '"') first = json.rfind('"', end - 1) + 1;
    json.replace(first, end - first, fmt::format("buffer-{}", i));
    buffers[i].isTaken = true;
  }
}

// ---- the files it names

/// "%20" becomes a space; what is no such code stays.
std::string percentDecoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char* digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      text += static_cast<char>(code);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

/// The first bytes of a file, as many as the buffer says, into memory that is taken once they are known to be
/// there.
Expected<std::vector<unsigned char>> readBuffer(const fs::path& gltf, const BufferEntry& buffer,
                                                LoadWatch& watch) {
  if (const auto base64 = base64Of(buffer.uri)) {
    std::vector<unsigned char> bytes = decodeBase64(*base64, watch);
    if (bytes.size() == buffer.byteLength) return bytes;
    return makeError("", fmt::format("its data: URI has {} bytes, of {} that the buffer says", bytes.size(),
                                     buffer.byteLength));
  }
  if (buffer.uri.starts_with("data:"))
    return makeError("", fmt::format("its data: URI is of another kind than base64: {}",
                                     printable(buffer.uri.substr(0, 40))));
  const Expected<fs::path> path = resolveGltfUri(gltf, buffer.uri);
  if (!path) return tl::unexpected(path.error());
  std::error_code error;
  const fs::file_status status = fs::status(*path, error);
  if (!fs::exists(status)) return makeError(path->string(), "no such file");
  if (!fs::is_regular_file(status)) return makeError(path->string(), "is not a regular file");
  const std::uintmax_t size = fs::file_size(*path, error);
  if (error || size < buffer.byteLength)
    return makeError(path->string(), fmt::format("has {} bytes, of {} that the buffer says", error ? 0 : size,
                                                 buffer.byteLength));
  std::vector<unsigned char> bytes(buffer.byteLength);
  std::ifstream in(*path, std::ios::binary);
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  for (std::size_t at = 0; in && at < bytes.size(); at += kChunk) {
    watch.look();
    in.read(reinterpret_cast<char*>(bytes.data()) + at,
            static_cast<std::streamsize>(std::min(kChunk, bytes.size() - at)));
  }
  if (!in) return makeError(path->string(), "cannot be read");
  return bytes;
}

/// The files that tinygltf asks for: those of its buffers in their order, and then pictures, which it is told
/// are not there.
struct BufferFiles {
  fs::path gltf;
  std::vector<std::pair<std::size_t, BufferEntry>> left;  ///< with the buffer's index; the next one last
  LoadWatch& watch;
  std::optional<Error> error;

  static bool exists(const std::string&, void* self) {
    return !static_cast<BufferFiles*>(self)->left.empty();
  }
  static std::string expand(const std::string& name, void*) { return name; }
  static bool read(std::vector<unsigned char>* bytes, std::string*, const std::string&, void* self) {
    auto& files = *static_cast<BufferFiles*>(self);
    const auto [index, buffer] = std::move(files.left.back());
    files.left.pop_back();
    // Nothing is thrown through the library: who called it looks again.
    Expected<std::vector<unsigned char>> content =
        untilStopped([&] { return readBuffer(files.gltf, buffer, files.watch); });
    if (!content) {
      files.error =
          Error{files.gltf.string(), fmt::format("buffer {}: {}", index, content.error().message()), {}};
      return false;
    }
    *bytes = std::move(*content);
    return true;
  }
};

/// Of the pictures, those in URIs come as bytes; those in views are found there later.
bool keepPicture(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// ---- what it says

std::optional<std::string> wrongBuffers(const std::vector<BufferEntry>& buffers, bool isGlb) {
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    if (buffers[i].byteLength == 0) return fmt::format("buffer {} has no bytes", i);
    if (buffers[i].byteLength > kMostBufferBytes - bytes)
      return fmt::format("buffer {} would have {} bytes: more than {} GiB in all", i, buffers[i].byteLength,
                         kMostBufferBytes >> 30);
    bytes += buffers[i].byteLength;
    if (buffers[i].uri.empty() && !(isGlb && i == 0)) return fmt::format("buffer {} has no uri", i);
  }
  return std::nullopt;
}

/// What tinygltf found wrong and has passed over, as a rule a part of the scene that is missing now; nothing
/// where that is of skins or animations, which are left out anyway and of which it wants what they need not
/// have.
std::string firstProblem(const std::string& messages) {
  std::string_view rest = messages;
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const auto isAbout = [line](const char* word) { return line.find(word) != std::string_view::npos; };
    const bool isLeftOut = isAbout("nimation") || isAbout("'node'") || isAbout("'path'") ||
                           isAbout("'sampler'") || isAbout("Skin") || isAbout("'inverseBindMatrices'");
    if (!line.empty() && !isLeftOut) return printable(line);
  }
  return {};
}

std::optional<Error> checkExtensions(const GltfFile& file, GltfNotes& notes) {
  const auto isRead = [](const std::string& name) {
    return std::find(kReadExtensions.begin(), kReadExtensions.end(), name) != kReadExtensions.end();
  };
  for (const std::string& name : file.model.extensionsRequired) {
    if (isRead(name)) continue;
    const bool isCompression = name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression";
    return Error{file.path.string(),
                 fmt::format("it needs the extension {}, which is not read", printable(name)),
                 isCompression ? "export it without compression" : ""};
  }
  // Files do not always declare what their materials have.
  std::set<std::string> used(file.model.extensionsUsed.begin(), file.model.extensionsUsed.end());
  for (const tinygltf::Material& material : file.model.materials) {
    for (const auto& [name, value] : material.extensions) used.insert(name);
  }
  for (const std::string& name : used) {
    if (!isRead(name)) notes.unused("the extension " + printable(name));
  }
  return std::nullopt;
}

// ---- indices

/// Looks whether indices lead somewhere; the first that does not is the error.
class IndexCheck {
 public:
  explicit IndexCheck(const tinygltf::Model& model) : model_(model) {}

  std::optional<std::string> run() {
    each("node", model_.nodes, [&](const tinygltf::Node& node) {
      optional("mesh", node.mesh, model_.meshes.size());
      optional("camera", node.camera, model_.cameras.size());
      optional("light", gltfLightOf(node), model_.lights.size());
      for (const int child : node.children) needed("node", child, model_.nodes.size());
    });
    each("scene", model_.scenes, [&](const tinygltf::Scene& scene) {
      for (const int node : scene.nodes) needed("node", node, model_.nodes.size());
    });
    each("mesh", model_.meshes, [&](const tinygltf::Mesh& mesh) {
      for (const tinygltf::Primitive& primitive : mesh.primitives) {
        optional("material", primitive.material, model_.materials.size());
        optional("accessor", primitive.indices, model_.accessors.size());
        for (const auto& [name, accessor] : primitive.attributes)
          needed("accessor", accessor, model_.accessors.size());
      }
    });
    each("material", model_.materials, [&](const tinygltf::Material& material) {
      optional("texture", material.pbrMetallicRoughness.baseColorTexture.index, model_.textures.size());
      optional("texture", material.pbrMetallicRoughness.metallicRoughnessTexture.index,
               model_.textures.size());
      optional("texture", material.emissiveTexture.index, model_.textures.size());
    });
    each("texture", model_.textures, [&](const tinygltf::Texture& texture) {
      optional("picture", texture.source, model_.images.size());
      optional("sampler", texture.sampler, model_.samplers.size());
    });
    title_ = "the file";
    optional("scene", model_.defaultScene, model_.scenes.size());
    return wrong_;
  }

 private:
  template <class Item, class Check>
  void each(const char* kind, const std::vector<Item>& items, const Check& check) {
    for (std::size_t i = 0; i < items.size() && !wrong_; ++i) {
      title_ = gltfName(kind, static_cast<int>(i), items[i].name);
      check(items[i]);
    }
  }
  void optional(const char* what, int index, std::size_t count) {
    if (index != -1) needed(what, index, count);
  }
  void needed(const char* what, int index, std::size_t count) {
    if (wrong_ || (index >= 0 && static_cast<std::size_t>(index) < count)) return;
    wrong_ = fmt::format("{} names {} {}, and there are {}", title_, what, index, count);
  }

  const tinygltf::Model& model_;
  std::string title_;
  std::optional<std::string> wrong_;
};

/// The file by tinygltf, after its JSON and its parts were looked through.
Expected<void> parseGltf(const std::string& bytes, std::size_t size, bool isGlb, BufferFiles& files,
                         GltfFile& file) {
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(keepPicture, nullptr);
  reader.SetFsCallbacks({BufferFiles::exists, BufferFiles::expand, BufferFiles::read, nullptr, &files});
  std::string problems;
  std::string remarks;  // of pictures that were not read on purpose
  bool isRead = false;
  try {
    isRead = isGlb ? reader.LoadBinaryFromMemory(&file.model, &problems, &remarks,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()),
                                                 static_cast<unsigned>(size))
                   : reader.LoadASCIIFromString(&file.model, &problems, &remarks, bytes.data(),
                                                static_cast<unsigned>(size), "");
  } catch (const std::bad_alloc&) {
    return file.error("takes more memory than there is");
  } catch (const std::exception& error) {
    return file.error("cannot be read: " + printable(error.what()));
  }
  file.watch.look();
  if (files.error) return tl::unexpected(*files.error);
  const std::string problem = firstProblem(problems);
  if (!problem.empty()) return file.error("cannot be read: " + problem);
  if (!isRead) return file.error("cannot be read: " + printable(problems));
  return {};
}

}  // namespace

void GltfNotes::unused(const std::string& what) {
  if (std::find(unused_.begin(), unused_.end(), what) == unused_.end()) unused_.push_back(what);
}

void GltfNotes::say(const std::string& sentence) {
  if (std::find(sentences_.begin(), sentences_.end(), sentence) == sentences_.end())
    sentences_.push_back(sentence);
}

std::vector<std::string> GltfNotes::warnings(const fs::path& path) const {
  std::vector<std::string> all;
  for (const std::string& sentence : sentences_) all.push_back(path.string() + ": " + sentence);
  if (!unused_.empty())
    all.push_back(fmt::format("{}: not used: {}", path.string(), fmt::join(unused_, ", ")));
  return all;
}

Expected<GltfFile> readGltfFile(const fs::path& path, GltfNotes& notes, LoadWatch& watch) {
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (fs::is_other(status)) return makeError(path.string(), "is not a regular file");
  if (fs::is_regular_file(status) && fs::file_size(path, unknown) > kMostGltfBytes)
    return makeError(path.string(), "is too large: more than 4 GiB");
  Expected<std::string> bytes = readFile(path, watch);
  if (!bytes) return tl::unexpected(bytes.error());

  GltfFile file{path, {}, watch};
  const bool isGlb = bytes->starts_with(kGlbMagic);
  watch.part(0.3, 0.6);
  Expected<std::string_view> json = isGlb ? glbJson(path, *bytes) : Expected<std::string_view>(*bytes);
  if (!json) return tl::unexpected(json.error());
  WatchedText text(*json, watch);
  std::istream stream(&text);
  JsonScan scan(text);
  const bool isSound = nlohmann::json::sax_parse(stream, &scan);
  watch.look();
  if (!isSound) return file.error(scan.wrong);
  if (!scan.isObject) return file.error("is no glTF file: its JSON is not an object");
  if (!scan.hasAsset) return file.error("is no glTF file: its JSON has no \"asset\"");
  if (const auto wrong = wrongBuffers(scan.buffers, isGlb)) return file.error(*wrong);

  if (!isGlb) takeDataUris(*bytes, scan.buffers);
  BufferFiles files{path, {}, watch, {}};
  for (std::size_t i = scan.buffers.size(); i-- > 0;) {
    BufferEntry& buffer = scan.buffers[i];
    if (!buffer.uri.empty() && (buffer.isTaken || !base64Of(buffer.uri)))
      files.left.emplace_back(i, std::move(buffer));
  }
  const Expected<void> parsed = parseGltf(*bytes, bytes->size(), isGlb, files, file);
  // Versions and extensions are known before what they change is found to be strange.
  const std::string& version = file.model.asset.version;
  if (!file.model.asset.minVersion.empty() && file.model.asset.minVersion != "2.0")
    return file.error(fmt::format("needs glTF {}: 2.0 is read", printable(file.model.asset.minVersion)));
  if (!version.starts_with("2."))
    return file.error(fmt::format("is glTF {}: 2.0 is read", printable(version)));
  if (std::optional<Error> error = checkExtensions(file, notes)) return tl::unexpected(*error);
  if (!parsed) return tl::unexpected(parsed.error());
  if (const auto wrong = IndexCheck(file.model).run()) return file.error(*wrong);
  return file;
}

Expected<fs::path> resolveGltfUri(const fs::path& gltf, const std::string& uri) {
  std::string name = percentDecoded(uri);
  // Backslashes part folders where many such files were written.
  std::replace(name.begin(), name.end(), '\\', '/');
  if (name.empty() || name.find('\0') != std::string::npos)
    return makeError("", fmt::format("\"{}\" names no file", printable(uri)));
  const fs::path relative = fs::path(name).lexically_normal();
  const bool hasDrive = name.size() > 1 && name[1] == ':';
  if (relative.is_absolute() || hasDrive || name.find("://") != std::string::npos ||
      name.starts_with("file:"))
    return makeError("", fmt::format("\"{}\" is not relative to the file", printable(uri)),
                     "put it beside the file");
  if (*relative.begin() == "..")
    return makeError("", fmt::format("\"{}\" lies outside the file's folder", printable(uri)),
                     "put it beside the file");
  return (gltf.parent_path() / relative).lexically_normal();
}

std::string gltfName(const char* kind, int index, const std::string& name) {
  if (name.empty()) return fmt::format("{} {}", kind, index);
  return fmt::format("{} {} ({})", kind, index, printable(name));
}

double gltfNumber(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                  double otherwise) {
  const auto found = extensions.find(extension);
  if (found == extensions.end() || !found->second.Has(key)) return otherwise;
  const tinygltf::Value& value = found->second.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

bool gltfNumbers(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                 std::vector<double>& numbers) {
  const auto found = extensions.find(extension);
  if (found == extensions.end() || !found->second.Has(key)) return false;
  const tinygltf::Value& value = found->second.Get(key);
  if (value.ArrayLen() != numbers.size()) return false;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const tinygltf::Value& number = value.Get(static_cast<int>(i));
    if (!number.IsNumber()) return false;
    numbers[i] = number.GetNumberAsDouble();
  }
  return true;
}

int gltfLightOf(const tinygltf::Node& node) {
  const double light = gltfNumber(node.extensions, "KHR_lights_punctual", "light", -1.0);
  return static_cast<int>(std::clamp(light, -2.0, 2e9));
}

}  // namespace lightvane
