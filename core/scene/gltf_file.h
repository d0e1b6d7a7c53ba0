#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "core/base/error.h"
#include "core/base/load_watch.h"

// What the parts of the glTF reader share. Internal: everybody else reads by load_gltf.h.

namespace lightvane {

/// What a file has and Lightvane does not use, or uses in part: each said once.
class GltfNotes {
 public:
  /// Adds to the list of what is not used.
  void unused(const std::string& what);
  /// Adds a sentence of its own.
  void say(const std::string& sentence);
  /// All of it, as warnings that name the file.
  std::vector<std::string> warnings(const std::filesystem::path& path) const;

 private:
  std::vector<std::string> unused_;
  std::vector<std::string> sentences_;
};

/// A glTF file as it is written, with its buffers; pictures are left in their files, views and URIs. Indices
/// of nodes, meshes, cameras, lights, materials, textures, pictures and accessors lead somewhere, or are -1
/// where they may be missing; those of views and buffers are checked as they are followed.
struct GltfFile {
  std::filesystem::path path;
  tinygltf::Model model;
  LoadWatch& watch;  ///< of whoever reads it

  tl::unexpected<Error> error(std::string what, std::string hint = {}) const {
    return makeError(path.string(), std::move(what), std::move(hint));
  }
};

/// Reads a .gltf or .glb file. Refuses what is damaged, another version, and what needs an extension that is
/// not known; one that is used but not needed is noted. Takes no more memory than the file and its buffers
/// have bytes, and a small multiple of its JSON, of which the number of values is bounded.
/// Throws LoadStopped as `watch` says.
Expected<GltfFile> readGltfFile(const std::filesystem::path& path, GltfNotes& notes, LoadWatch& watch);

/// The file that a URI names: decoded, relative to the glTF file and not outside its folder. The error has no
/// place: it belongs to what names the file.
Expected<std::filesystem::path> resolveGltfUri(const std::filesystem::path& gltf, const std::string& uri);

/// "mesh 3 (chair)", as a message names it.
std::string gltfName(const char* kind, int index, const std::string& name);

/// A number of an extension; `otherwise` where there is none.
double gltfNumber(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                  double otherwise);
/// Fills `numbers` from an array of as many; false where there is none.
bool gltfNumbers(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                 std::vector<double>& numbers);

/// The light of KHR_lights_punctual that a node is; -1 where it is none.
int gltfLightOf(const tinygltf::Node& node);

}  // namespace lightvane
