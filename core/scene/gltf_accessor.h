#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/scene/gltf_file.h"

namespace lightvane {

/// What an accessor holds: `components` numbers for each element, integers that are normalised as fractions.
struct GltfNumbers {
  std::size_t components = 0;  ///< 0 where there is no accessor
  std::vector<double> values;

  bool empty() const { return components == 0; }
  std::size_t count() const { return values.size() / components; }
  Vec2d vec2(std::size_t i) const { return {values[i * components], values[i * components + 1]}; }
  Vec3d vec3(std::size_t i) const {
    return {values[i * components], values[i * components + 1], values[i * components + 2]};
  }
};

/// The most elements of an accessor that is not backed by as many bytes, and of all meshes once nodes have
/// placed them: 2^26 vertices take 4 GB.
inline constexpr std::size_t kMostGltfElements = std::size_t{1} << 26;

/// The bytes of a view, within its buffer; `what` is what messages call it.
Expected<std::string_view> gltfViewBytes(const GltfFile& file, int view, const std::string& what);

/// Reads the accessor of this index, of between `least` and `most` components, sparse or not. All bounds are
/// checked before memory is taken; errors begin with `what`.
Expected<GltfNumbers> readGltfNumbers(const GltfFile& file, int index, std::size_t least, std::size_t most,
                                      const std::string& what);

/// Reads an accessor of whole numbers below `bound`.
Expected<std::vector<std::uint32_t>> readGltfIndices(const GltfFile& file, int accessor, std::size_t bound,
                                                     const std::string& what);

}  // namespace lightvane
