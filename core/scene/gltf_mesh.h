#pragma once

#include <glm/glm.hpp>

#include "core/scene/description.h"
#include "core/scene/gltf_file.h"

namespace lightvane {

/// Which texture coordinates of a mesh a material goes by, and how it bends them; v runs down.
struct GltfUvs {
  int set = 0;  ///< of TEXCOORD_0, TEXCOORD_1, ...
  glm::dmat3 transform{1.0};

  bool operator==(const GltfUvs&) const = default;
};

/// A part of a mesh with one material, in the coordinates of its node.
struct GltfPrimitive {
  MeshGeometry mesh;  ///< with colours where they differ
  Rgb tint{1.0f};     ///< the mean of the vertex colours
};

/// Reads the triangles of a mesh's primitive, with the vertices that they use; none, and a note, of points
/// and lines.
Expected<GltfPrimitive> readGltfPrimitive(const GltfFile& file, int mesh, std::size_t index,
                                          const GltfUvs& uvs, GltfNotes& geometryNotes,
                                          GltfNotes& materialNotes);

/// How many vertices and triangles a primitive has at most, by what the file says.
std::size_t mostGltfElements(const GltfFile& file, const tinygltf::Primitive& primitive);

/// Moves the mesh into the world. Triangles keep their front sides where the transform mirrors.
void placeGltfMesh(const glm::dmat4& toWorld, MeshGeometry& mesh, LoadWatch& watch);

/// Gives every corner a vertex of its own, with its triangle's normal.
void makeFlat(MeshGeometry& mesh, LoadWatch& watch);

}  // namespace lightvane
