#pragma once
/// Collects the buffer, buffer views and accessors of a glTF that is being written.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mien/geometry/mesh.h"
#include "mien/io/detail/json.h"

namespace mien::detail {

/// How exactly floats are kept: 0 keeps every bit; otherwise they are rounded to multiples of a power of two
/// of at most twice this (compressed files alone).
struct Precision {
  double error = 0;
};

class GltfBuilder {
 public:
  /// `compress`: EXT_meshopt_compression for everything but images.
  explicit GltfBuilder(bool compress) : compress_(compress) {}

  /// A vertex attribute. `with_bounds` adds min and max.
  int add_attribute(std::span<const float> values, int columns, Precision precision,
                    bool with_bounds = false);
  int add_attribute(std::span<const std::uint8_t> values, int columns);
  int add_attribute(std::span<const std::uint16_t> values, int columns, bool normalized);
  /// Displacements of `rows` vertices, zero but at `vertices`; sparse when that is smaller.
  int add_deltas(int rows, std::span<const int> vertices, const Points& deltas, Precision precision);
  /// A custom attribute of `values` in its own type; every element starts at a multiple of four bytes.
  int add_custom(std::span<const float> values, const VertexAttribute& attribute);
  /// Corners of triangles, ends of lines, points; two bytes each where they fit.
  int add_indices(const std::vector<std::uint32_t>& indices, std::uint32_t vertex_count);
  /// Numbers that only the vendor extension reads.
  int add_numbers(const std::vector<std::uint32_t>& numbers);
  /// Animation data or matrices. Equal data is stored once.
  int add_floats(std::span<const float> values, int columns, bool with_bounds = false);
  /// A buffer view of bytes without an accessor (images).
  int add_bytes(std::span<const std::uint8_t> bytes);

  Json& accessors() { return accessors_; }
  Json& views() { return views_; }
  std::vector<std::uint8_t>& buffer() { return buffer_; }
  std::size_t fallback_size() const { return fallback_size_; }
  bool compressed_any() const { return fallback_size_ > 0; }

 private:
  enum class Use { attribute, indices, plain };
  int add_view(std::span<const std::uint8_t> bytes, int stride, Use use);
  struct Packed {
    std::vector<std::uint8_t> bytes;  ///< none: the codec has no form for them
    int stride = 0;
    const char* mode = "";
  };
  static Packed pack(std::span<const std::uint8_t> bytes, int stride, Use use);
  std::size_t stored_size(std::span<const float> values, Precision precision) const;
  int add_accessor(int view, int component_type, int columns, std::size_t rows);
  void add_bounds(int accessor, std::span<const float> values, int columns, bool with_zero);
  int float_view(std::span<const float> values, int columns, Precision precision);

  bool compress_;
  Json accessors_ = Json::array(), views_ = Json::array();
  std::vector<std::uint8_t> buffer_;
  std::size_t fallback_size_ = 0;
  std::map<std::pair<int, std::vector<float>>, int> shared_;
};

}  // namespace mien::detail
