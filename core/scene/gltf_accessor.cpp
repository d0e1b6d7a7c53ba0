#include "core/scene/gltf_accessor.h"

#include <cstring>

#include <fmt/format.h>

namespace lightvane {
namespace {

// Of an accessor without a view, which are all 0: a few bytes of a file must not take gigabytes.
constexpr std::size_t kMostBareElements = std::size_t{1} << 20;

/// Elements of one kind within a view.
struct ElementSpan {
  const char* first = nullptr;
  std::size_t stride = 0;
};

struct ElementKind {
  int type = 0;  ///< of its components: TINYGLTF_COMPONENT_TYPE_
  std::size_t components = 1;

  std::size_t componentSize() const {
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
      case TINYGLTF_COMPONENT_TYPE_SHORT:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
      default:
        return 0;
    }
  }
  std::size_t size() const { return components * componentSize(); }
};

/// Where `count` elements are that begin at a place of a view.
Expected<ElementSpan> spanOf(const GltfFile& file, int view, std::size_t offset, std::size_t count,
                             const ElementKind& kind, const std::string& what) {
  const Expected<std::string_view> bytes = gltfViewBytes(file, view, what);
  if (!bytes) return tl::unexpected(bytes.error());
  const std::size_t given = file.model.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::size_t stride = given > 0 ? given : kind.size();
  const std::size_t room = bytes->size();
  const bool fits = count == 0 || (offset <= room && room - offset >= kind.size() &&
                                   count - 1 <= (room - offset - kind.size()) / stride);
  if (!fits)
    return file.error(
        fmt::format("{}: {} elements of {} bytes from byte {} on do not fit into view {} of {} "
                    "bytes",
                    what, count, kind.size(), offset, view, room));
  return ElementSpan{bytes->data() + (count == 0 ? 0 : offset), stride};
}

template <class T>
double numberAt(const char* place) {
  T number;
  std::memcpy(&number, place, sizeof number);
  return static_cast<double>(number);
}

/// A component; normalised integers by the formulas of section 3.6.2.2 of the specification.
double componentAt(const char* place, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const double number = numberAt<std::int8_t>(place);
      return normalized ? std::max(number / 127.0, -1.0) : number;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return numberAt<std::uint8_t>(place) / (normalized ? 255.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const double number = numberAt<std::int16_t>(place);
      return normalized ? std::max(number / 32767.0, -1.0) : number;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return numberAt<std::uint16_t>(place) / (normalized ? 65535.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return numberAt<std::uint32_t>(place);
    default:
      return numberAt<float>(place);
  }
}

void decodeElement(const char* place, const ElementKind& kind, bool normalized, double* numbers) {
  for (std::size_t c = 0; c < kind.components; ++c)
    numbers[c] = componentAt(place + c * kind.componentSize(), kind.type, normalized);
}

/// Puts the elements of a sparse accessor that differ in their places.
Expected<void> applySparse(const GltfFile& file, const tinygltf::Accessor& accessor, const ElementKind& kind,
                           const std::string& what, GltfNumbers& numbers) {
  const auto& sparse = accessor.sparse;
  const ElementKind indexKind{sparse.indices.componentType, 1};
  if (indexKind.size() == 0 || indexKind.type == TINYGLTF_COMPONENT_TYPE_FLOAT)
    return file.error(fmt::format("{}: sparse indices of type {}", what, indexKind.type));
  if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    return file.error(fmt::format("{}: {} sparse elements", what, sparse.count));
  const auto count = static_cast<std::size_t>(sparse.count);
  const auto indices =
      spanOf(file, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
             indexKind, what + ": sparse indices");
  if (!indices) return tl::unexpected(indices.error());
  const auto values =
      spanOf(file, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count, kind,
             what + ": sparse values");
  if (!values) return tl::unexpected(values.error());
  for (std::size_t i = 0; i < count; ++i) {
    file.watch.piece(i);
    const double index = componentAt(indices->first + i * indices->stride, indexKind.type, false);
    if (!(index >= 0.0 && index < static_cast<double>(accessor.count)))
      return file.error(
          fmt::format("{}: a sparse index is {}, and there are {}", what, index, accessor.count));
    decodeElement(values->first + i * values->stride, kind, accessor.normalized,
                  &numbers.values[static_cast<std::size_t>(index) * kind.components]);
  }
  return {};
}

/// Accessors have one number or a vector; the others are matrices, which no mesh has.
std::size_t componentsOf(int type) {
  return type == TINYGLTF_TYPE_SCALAR ? 1 : type <= TINYGLTF_TYPE_VEC4 ? static_cast<std::size_t>(type) : 0;
}

}  // namespace

Expected<std::string_view> gltfViewBytes(const GltfFile& file, int view, const std::string& what) {
  const auto& views = file.model.bufferViews;
  if (view < 0 || static_cast<std::size_t>(view) >= views.size())
    return file.error(fmt::format("{} names view {}, and there are {}", what, view, views.size()));
  const tinygltf::BufferView& found = views[static_cast<std::size_t>(view)];
  const auto& buffers = file.model.buffers;
  if (found.buffer < 0 || static_cast<std::size_t>(found.buffer) >= buffers.size())
    return file.error(
        fmt::format("view {} names buffer {}, and there are {}", view, found.buffer, buffers.size()));
  const std::vector<unsigned char>& bytes = buffers[static_cast<std::size_t>(found.buffer)].data;
  if (found.byteOffset > bytes.size() || found.byteLength > bytes.size() - found.byteOffset)
    return file.error(fmt::format("view {}: {} bytes from {} on do not fit into buffer {} of {}", view,
                                  found.byteLength, found.byteOffset, found.buffer, bytes.size()));
  return std::string_view(reinterpret_cast<const char*>(bytes.data()) + found.byteOffset, found.byteLength);
}

Expected<GltfNumbers> readGltfNumbers(const GltfFile& file, int index, std::size_t least, std::size_t most,
                                      const std::string& what) {
  const tinygltf::Accessor& accessor = file.model.accessors[static_cast<std::size_t>(index)];
  const ElementKind kind{accessor.componentType, componentsOf(accessor.type)};
  if (kind.components < least || kind.components > most)
    return file.error(
        fmt::format("{}: expected {}, found {}", what,
                    least == most ? fmt::format("{} numbers each", least)
                                  : fmt::format("{} to {} numbers each", least, most),
                    kind.components == 0 ? std::string("a matrix") : fmt::format("{}", kind.components)));
  if (kind.size() == 0)
    return file.error(fmt::format("{}: numbers of type {}", what, accessor.componentType));
  ElementSpan span;
  if (accessor.bufferView != -1) {
    const auto found = spanOf(file, accessor.bufferView, accessor.byteOffset, accessor.count, kind, what);
    if (!found) return tl::unexpected(found.error());
    span = *found;
  } else if (accessor.count > kMostBareElements) {
    return file.error(fmt::format("{}: {} elements without bytes", what, accessor.count));
  }
  GltfNumbers numbers{kind.components, std::vector<double>(accessor.count * kind.components)};
  for (std::size_t i = 0; span.first != nullptr && i < accessor.count; ++i) {
    file.watch.piece(i);
    decodeElement(span.first + i * span.stride, kind, accessor.normalized,
                  &numbers.values[i * kind.components]);
  }
  if (accessor.sparse.isSparse) {
    if (auto done = applySparse(file, accessor, kind, what, numbers); !done)
      return tl::unexpected(done.error());
  }
  return numbers;
}

Expected<std::vector<std::uint32_t>> readGltfIndices(const GltfFile& file, int accessor, std::size_t bound,
                                                     const std::string& what) {
  const int type = file.model.accessors[static_cast<std::size_t>(accessor)].componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    return file.error(
        fmt::format("{}: expected whole numbers of 1, 2 or 4 bytes, found type {}", what, type));
  const Expected<GltfNumbers> numbers = readGltfNumbers(file, accessor, 1, 1, what);
  if (!numbers) return tl::unexpected(numbers.error());
  std::vector<std::uint32_t> indices;
  indices.reserve(numbers->values.size());
  for (const double number : numbers->values) {
    file.watch.piece(indices.size());
    if (number >= static_cast<double>(bound))
      return file.error(
          fmt::format("{}: index {} is {}, and there are {} vertices", what, indices.size(), number, bound));
    indices.push_back(static_cast<std::uint32_t>(number));
  }
  return indices;
}

}  // namespace lightvane
