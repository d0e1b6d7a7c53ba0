#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/math.h"

namespace lightvane {

// Values as bytes and back: integers little endian in their own width, floating-point numbers by their bits
// (so that NaN keeps its payload and zero its sign), counts before sequences, no padding. What a type
// consists of is said once, for both directions:
//
//   template <class Archive> void visitFields(Archive& archive, T& value) { archive(value.a, value.b); }

/// Appends values to a string.
class ByteWriter {
 public:
  template <class... T>
  void operator()(T&... values) {
    (visitFields(*this, values), ...);
  }

  template <std::unsigned_integral U>
  void number(const U& value) {
    for (std::size_t i = 0; i < sizeof(U); ++i) bytes_.push_back(static_cast<char>(value >> (8 * i)));
  }

  /// Anything with size() and operator[].
  template <class Sequence>
  void sequence(const Sequence& elements) {
    number(std::uint64_t{elements.size()});
    for (std::size_t i = 0; i < elements.size(); ++i) {
      auto element = elements[i];
      visitFields(*this, element);
    }
  }

  /// Replaces a number that was written at `offset` before its value was known.
  template <std::unsigned_integral U>
  void overwrite(std::size_t offset, U value) {
    ByteWriter number;
    number.number(value);
    bytes_.replace(offset, sizeof(U), number.bytes_);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Bytes that a value of type T takes at least: those of one whose sequences are empty.
template <class T>
std::size_t leastEncodedSize() {
  ByteWriter writer;
  T value{};
  writer(value);
  return writer.bytes().size();
}

/// Reads values from bytes of which nothing is known to be right. After the first that does not fit it has
/// failed: it reads zeros and empty sequences.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (visitFields(*this, values), ...);
  }

  template <std::unsigned_integral U>
  void number(U& value) {
    value = 0;
    if (bytes_.size() < sizeof(U)) {
      fail();
      return;
    }
    for (std::size_t i = 0; i < sizeof(U); ++i) {
      value = static_cast<U>(value | static_cast<U>(static_cast<unsigned char>(bytes_[i])) << (8 * i));
    }
    bytes_.remove_prefix(sizeof(U));
  }

  /// Takes no memory for more elements than the bytes that are left can hold.
  template <class Sequence>
  void sequence(Sequence& elements) {
    using Element = typename Sequence::value_type;
    static const std::size_t least = leastEncodedSize<Element>();
    elements.clear();
    std::uint64_t count = 0;
    number(count);
    if (count > bytes_.size() / least) {
      fail();
      return;
    }
    elements.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count && !failed_; ++i) {
      Element element{};
      visitFields(*this, element);
      elements.push_back(std::move(element));
    }
  }

  /// Whether everything fitted and nothing is left.
  bool endedWell() const { return !failed_ && bytes_.empty(); }

 private:
  void fail() {
    failed_ = true;
    bytes_ = {};
  }

  std::string_view bytes_;
  bool failed_ = false;
};

template <class Archive, std::unsigned_integral U>
void visitFields(Archive& archive, U& value) {
  archive.number(value);
}

/// A value as the number that stands for it in a file.
template <class Number, class Archive, class T>
void visitAs(Archive& archive, T& value) {
  auto number = std::bit_cast<Number>(value);
  archive.number(number);
  value = std::bit_cast<T>(number);
}

template <class Archive>
void visitFields(Archive& archive, std::int32_t& value) {
  visitAs<std::uint32_t>(archive, value);
}
template <class Archive>
void visitFields(Archive& archive, float& value) {
  visitAs<std::uint32_t>(archive, value);
}
template <class Archive>
void visitFields(Archive& archive, double& value) {
  visitAs<std::uint64_t>(archive, value);
}
template <class Archive>
void visitFields(Archive& archive, char& value) {
  visitAs<std::uint8_t>(archive, value);
}
template <class Archive>
void visitFields(Archive& archive, bool& value) {
  // A byte out of a file may be neither 0 nor 1, which no bool may be.
  std::uint8_t number = value ? 1 : 0;
  archive.number(number);
  value = number != 0;
}

template <class Archive>
void visitFields(Archive& archive, Vec3& v) {
  archive(v.x, v.y, v.z);
}
template <class Archive, class T, std::size_t N>
void visitFields(Archive& archive, T (&values)[N]) {
  for (T& value : values) archive(value);
}
template <class Archive>
void visitFields(Archive& archive, std::string& text) {
  archive.sequence(text);
}
template <class Archive, class T>
void visitFields(Archive& archive, std::vector<T>& values) {
  archive.sequence(values);
}
template <class Archive, class A, class B>
void visitFields(Archive& archive, std::pair<A, B>& both) {
  archive(both.first, both.second);
}
template <class Archive, class Key, class T>
void visitFields(Archive& archive, std::map<Key, T>& values) {
  std::vector<std::pair<Key, T>> entries(values.begin(), values.end());
  archive(entries);
  values = std::map<Key, T>(entries.begin(), entries.end());
}

}  // namespace lightvane
