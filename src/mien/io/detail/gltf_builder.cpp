#include "mien/io/detail/gltf_builder.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

// Compressed floats keep their type: each is a whole multiple of one power of two, stored as the mantissa and
// exponent of the EXPONENTIAL filter. A node's transform, a skin's bind matrices and the meaning of every
// delta stay as they were, which integers with a dequantising transform would not leave alone, and the
// constant exponent costs nothing.

namespace mien::detail {
namespace {

enum ComponentType { type_i8 = 5120, type_u8, type_i16, type_u16, type_u32 = 5125, type_f32 };
enum Target { array_buffer = 34962, element_array_buffer = 34963 };

template <typename Number>
std::span<const std::uint8_t> bytes_of(std::span<const Number> numbers) {
  return {reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size_bytes()};
}

const char* type_name(int columns) {
  switch (columns) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    default:
      return "MAT4";
  }
}

void align(std::vector<std::uint8_t>& bytes) {
  bytes.resize((bytes.size() + 3) / 4 * 4);
}

/// The power of two whose multiples are at most `error` away from any number, at least what 24 bits can hold.
int exponent_for(std::span<const float> values, double error) {
  double largest = 0;
  for (const float value : values) largest = std::max(largest, std::abs(static_cast<double>(value)));
  const int wanted = static_cast<int>(std::floor(std::log2(2 * error)));
  const int least = largest > 0 ? std::ilogb(largest) - 21 : -100;
  return std::clamp(std::max(wanted, least), -100, 100);
}

/// Each value as exponent << 24 | mantissa, and what it decodes to.
std::vector<std::uint32_t> quantized(std::span<const float> values, int exponent,
                                     std::vector<float>& decoded) {
  std::vector<std::uint32_t> words(values.size());
  decoded.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto mantissa =
        static_cast<std::int32_t>(std::lround(std::ldexp(static_cast<double>(values[i]), -exponent)));
    words[i] = static_cast<std::uint32_t>(exponent) << 24 | (static_cast<std::uint32_t>(mantissa) & 0xFFFFFF);
    decoded[i] = static_cast<float>(std::ldexp(mantissa, exponent));
  }
  return words;
}

}  // namespace

/// As a stream of rows: each byte by its difference from the row before.
static std::vector<std::uint8_t> packed_rows(std::span<const std::uint8_t> bytes, int stride) {
  const std::size_t rows = bytes.size() / stride;
  std::vector<std::uint8_t> packed(meshopt_encodeVertexBufferBound(rows, stride));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), bytes.data(), rows, stride));
  return packed;
}

static std::vector<std::uint8_t> packed_sequence(std::span<const std::uint8_t> bytes, int stride) {
  const std::size_t rows = bytes.size() / stride;
  std::vector<std::uint32_t> indices(rows, 0);
  for (std::size_t i = 0; i < rows; ++i) std::memcpy(&indices[i], bytes.data() + stride * i, stride);
  const std::size_t largest =
      rows > 0 ? *std::max_element(indices.begin(), indices.end()) + std::size_t{1} : 1;
  std::vector<std::uint8_t> packed(meshopt_encodeIndexSequenceBound(rows, largest));
  packed.resize(meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), rows));
  return packed;
}

/// The smallest of the forms that the codec has for these bytes. Whole numbers are often smaller as rows of several: those of
/// a quad's two triangles beside those of the quad before.
GltfBuilder::Packed GltfBuilder::pack(std::span<const std::uint8_t> bytes, int stride, Use use) {
  if (use == Use::attribute) return {packed_rows(bytes, stride), stride, "ATTRIBUTES"};
  Packed best;
  if (stride >= 2) best = {packed_sequence(bytes, stride), stride, "INDICES"};
  for (const int row : {4, 8, 12, 24}) {
    std::vector<std::uint8_t> rows = packed_rows(bytes, row);
    if (best.bytes.empty() || rows.size() < best.bytes.size()) best = {std::move(rows), row, "ATTRIBUTES"};
  }
  return best;
}

int GltfBuilder::add_view(std::span<const std::uint8_t> bytes, int stride, Use use) {
  align(buffer_);
  std::vector<std::uint8_t> whole_rows;  // of any of the lengths that `pack` tries
  if (compress_ && use == Use::indices) {
    whole_rows.assign(bytes.begin(), bytes.end());
    whole_rows.resize((bytes.size() + 23) / 24 * 24, 0);
    bytes = whole_rows;
  }
  Json view = {{"buffer", 0}, {"byteLength", bytes.size()}};
  const bool codec_takes = use == Use::attribute ? stride % 4 == 0 : use == Use::indices;
  const Packed packed = compress_ && codec_takes && !bytes.empty() ? pack(bytes, stride, use) : Packed{};
  if (!packed.bytes.empty()) {
    Json extension = {{"buffer", 0},
                      {"byteOffset", buffer_.size()},
                      {"byteLength", packed.bytes.size()},
                      {"byteStride", packed.stride},
                      {"count", bytes.size() / packed.stride},
                      {"mode", packed.mode}};
    view["buffer"] = 1;
    view["byteOffset"] = fallback_size_;
    view["extensions"]["EXT_meshopt_compression"] = extension;
    fallback_size_ += (bytes.size() + 3) / 4 * 4;
    buffer_.insert(buffer_.end(), packed.bytes.begin(), packed.bytes.end());
  } else {
    view["byteOffset"] = buffer_.size();
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }
  views_.push_back(std::move(view));
  return static_cast<int>(views_.size()) - 1;
}

int GltfBuilder::add_accessor(int view, int component_type, int columns, std::size_t rows) {
  Json accessor = {{"componentType", component_type}, {"type", type_name(columns)}, {"count", rows}};
  if (view >= 0) accessor["bufferView"] = view;
  accessors_.push_back(std::move(accessor));
  return static_cast<int>(accessors_.size()) - 1;
}

void GltfBuilder::add_bounds(int accessor, std::span<const float> values, int columns, bool with_zero) {
  std::vector<float> low(columns, with_zero ? 0.f : values.empty() ? 0.f : std::numeric_limits<float>::max());
  std::vector<float> high(columns, with_zero        ? 0.f
                                   : values.empty() ? 0.f
                                                    : std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i < values.size(); ++i) {
    low[i % columns] = std::min(low[i % columns], values[i]);
    high[i % columns] = std::max(high[i % columns], values[i]);
  }
  accessors_[accessor]["min"] = low;
  accessors_[accessor]["max"] = high;
}

int GltfBuilder::float_view(std::span<const float> values, int columns, Precision precision) {
  if (!compress_ || precision.error <= 0) return add_view(bytes_of(values), 4 * columns, Use::attribute);
  std::vector<float> decoded;
  const std::vector<std::uint32_t> words = quantized(values, exponent_for(values, precision.error), decoded);
  const int view = add_view(bytes_of(std::span<const std::uint32_t>(words)), 4 * columns, Use::attribute);
  views_[view]["extensions"]["EXT_meshopt_compression"]["filter"] = "EXPONENTIAL";
  return view;
}

/// What a reader gets back: bounds must be those of the rounded numbers.
static std::vector<float> as_stored(std::span<const float> values, bool compress, Precision precision) {
  if (!compress || precision.error <= 0) return {values.begin(), values.end()};
  std::vector<float> decoded;
  quantized(values, exponent_for(values, precision.error), decoded);
  return decoded;
}

int GltfBuilder::add_attribute(std::span<const float> values, int columns, Precision precision,
                               bool with_bounds) {
  const int view = float_view(values, columns, precision);
  views_[view]["target"] = array_buffer;
  const int accessor = add_accessor(view, type_f32, columns, values.size() / columns);
  if (with_bounds) add_bounds(accessor, as_stored(values, compress_, precision), columns, false);
  return accessor;
}

int GltfBuilder::add_attribute(std::span<const std::uint8_t> values, int columns) {
  const int view = add_view(values, columns, Use::attribute);
  views_[view]["target"] = array_buffer;
  return add_accessor(view, type_u8, columns, values.size() / columns);
}

int GltfBuilder::add_attribute(std::span<const std::uint16_t> values, int columns, bool normalized) {
  const int view = add_view(bytes_of(values), 2 * columns, Use::attribute);
  views_[view]["target"] = array_buffer;
  const int accessor = add_accessor(view, type_u16, columns, values.size() / columns);
  if (normalized) accessors_[accessor]["normalized"] = true;
  return accessor;
}

/// The bytes that floats will take in the file.
std::size_t GltfBuilder::stored_size(std::span<const float> values, Precision precision) const {
  if (!compress_) return values.size_bytes();
  if (precision.error <= 0) return packed_rows(bytes_of(values), 12).size();
  std::vector<float> decoded;
  const std::vector<std::uint32_t> words = quantized(values, exponent_for(values, precision.error), decoded);
  return packed_rows(bytes_of(std::span<const std::uint32_t>(words)), 12).size();
}

int GltfBuilder::add_deltas(int rows, std::span<const int> vertices, const Points& deltas,
                            Precision precision) {
  const std::span<const float> values(deltas.data(), static_cast<std::size_t>(deltas.size()));
  constexpr std::size_t overhead = 256;  // two views and their JSON
  // Four bytes compress better, as rows of one; an index takes about three bits then, most being one more than the last.
  const std::size_t index_size = rows <= 65535 && !compress_ ? 2 : 4;
  const std::size_t index_share = compress_ ? vertices.size() * 3 / 8 : vertices.size() * index_size;
  const std::size_t sparse_size = stored_size(values, precision) + index_share + overhead;
  if (!vertices.empty()) {
    Points dense = Points::Zero(rows, 3);
    for (std::size_t k = 0; k < vertices.size(); ++k) dense.row(vertices[k]) = deltas.row(k);
    const std::span<const float> all(dense.data(), static_cast<std::size_t>(dense.size()));
    if (stored_size(all, precision) <= sparse_size) return add_attribute(all, 3, precision, true);
  }
  const int accessor = add_accessor(-1, type_f32, 3, rows);
  add_bounds(accessor, as_stored(values, compress_, precision), 3,
             vertices.size() < static_cast<std::size_t>(rows));
  if (vertices.empty()) return accessor;
  Json indices;
  if (index_size == 2) {
    const std::vector<std::uint16_t> narrow(vertices.begin(), vertices.end());
    indices = {{"bufferView", add_view(bytes_of(std::span<const std::uint16_t>(narrow)), 2, Use::indices)},
               {"componentType", type_u16}};
  } else {
    const std::vector<std::uint32_t> wide(vertices.begin(), vertices.end());
    indices = {{"bufferView", add_view(bytes_of(std::span<const std::uint32_t>(wide)), 4, Use::indices)},
               {"componentType", type_u32}};
  }
  accessors_[accessor]["sparse"] = {{"count", vertices.size()},
                                    {"indices", indices},
                                    {"values", {{"bufferView", float_view(values, 3, precision)}}}};
  return accessor;
}

/// Whole numbers of one type, each row padded to a multiple of four bytes.
template <typename Number>
static std::vector<std::uint8_t> padded(std::span<const float> values, int columns, int stride) {
  const std::size_t rows = values.size() / static_cast<std::size_t>(columns);
  std::vector<std::uint8_t> bytes(rows * static_cast<std::size_t>(stride), 0);
  for (std::size_t r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto number = static_cast<Number>(values[r * columns + c]);
      std::memcpy(bytes.data() + r * stride + c * sizeof number, &number, sizeof number);
    }
  return bytes;
}

int GltfBuilder::add_custom(std::span<const float> values, const VertexAttribute& attribute) {
  const int columns = attribute.width, type = attribute.component_type;
  if (type == type_f32) return add_attribute(values, columns, Precision{});
  const bool narrow = type == type_i8 || type == type_u8;
  const int size = (narrow ? 1 : 2) * columns, stride = (size + 3) / 4 * 4;
  const std::vector<std::uint8_t> bytes = type == type_i8    ? padded<std::int8_t>(values, columns, stride)
                                          : type == type_u8  ? padded<std::uint8_t>(values, columns, stride)
                                          : type == type_i16 ? padded<std::int16_t>(values, columns, stride)
                                                             : padded<std::uint16_t>(values, columns, stride);
  const int view = add_view(bytes, stride, Use::attribute);
  views_[view]["target"] = array_buffer;
  if (stride != size) views_[view]["byteStride"] = stride;
  const int accessor = add_accessor(view, type, columns, values.size() / columns);
  if (attribute.normalized) accessors_[accessor]["normalized"] = true;
  return accessor;
}

int GltfBuilder::add_indices(const std::vector<std::uint32_t>& indices, std::uint32_t vertex_count) {
  int accessor;
  if (vertex_count <= 65535) {  // 65535 itself restarts a primitive
    const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
    accessor = add_accessor(add_view(bytes_of(std::span<const std::uint16_t>(narrow)), 2, Use::indices),
                            type_u16, 1, indices.size());
  } else {
    accessor = add_accessor(add_view(bytes_of(std::span<const std::uint32_t>(indices)), 4, Use::indices),
                            type_u32, 1, indices.size());
  }
  views_.back()["target"] = element_array_buffer;
  return accessor;
}

int GltfBuilder::add_numbers(const std::vector<std::uint32_t>& numbers) {
  const std::uint32_t largest = numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
  if (largest <= 255) {
    const std::vector<std::uint8_t> narrow(numbers.begin(), numbers.end());
    return add_accessor(add_view(narrow, 1, Use::indices), type_u8, 1, numbers.size());
  }
  if (largest <= 65535) {
    const std::vector<std::uint16_t> narrow(numbers.begin(), numbers.end());
    return add_accessor(add_view(bytes_of(std::span<const std::uint16_t>(narrow)), 2, Use::indices), type_u16,
                        1, numbers.size());
  }
  return add_accessor(add_view(bytes_of(std::span<const std::uint32_t>(numbers)), 4, Use::indices), type_u32,
                      1, numbers.size());
}

int GltfBuilder::add_floats(std::span<const float> values, int columns, bool with_bounds) {
  const auto key =
      std::pair(with_bounds ? -columns : columns, std::vector<float>(values.begin(), values.end()));
  if (const auto known = shared_.find(key); known != shared_.end()) return known->second;
  const int view = add_view(bytes_of(values), 4 * columns, Use::attribute);
  const int accessor = add_accessor(view, type_f32, columns, values.size() / columns);
  if (with_bounds) add_bounds(accessor, values, columns, false);
  shared_.emplace(key, accessor);
  return accessor;
}

int GltfBuilder::add_bytes(std::span<const std::uint8_t> bytes) {
  return add_view(bytes, 1, Use::plain);
}

}  // namespace mien::detail
