#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "mien/core/error.h"
#include "mien/io/detail/gltf_document.h"

namespace mien::detail {
namespace {

enum StoredType { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

int size_of_component(std::int64_t type, const std::string& place) {
  switch (type) {
    case i8:
    case u8:
      return 1;
    case i16:
    case u16:
      return 2;
    case u32:
    case f32:
      return 4;
    default:
      throw io_error(place, fmt::format("is {}", type), "give 5120, 5121, 5122, 5123, 5125 or 5126");
  }
}

int columns_of_type(const std::string& type, const std::string& place) {
  const std::pair<const char*, int> known[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                               {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, columns] : known)
    if (type == name) return columns;
  throw io_error(place, fmt::format("is \"{}\"", type.substr(0, 40)),
                 "give SCALAR, VEC2, VEC3, VEC4 or MAT4");
}

template <typename Stored>
Stored stored_at(const std::uint8_t* at) {
  Stored value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <typename Stored, typename Number>
Number converted(Stored stored, bool normalized) {
  if constexpr (std::is_same_v<Number, float> && std::is_integral_v<Stored>) {
    // In double and divided, not multiplied: 255 must become exactly one.
    if (normalized)
      return std::max(static_cast<float>(stored / double(std::numeric_limits<Stored>::max())), -1.f);
  }
  (void)normalized;
  return static_cast<Number>(stored);
}

void check_finite(const std::vector<float>& values, int accessor, int columns) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw io_error(fmt::format("accessors[{}]", accessor),
                     fmt::format("element {} is not finite", i / static_cast<std::size_t>(columns)),
                     "give finite numbers");
}

}  // namespace

/// What an accessor says about its elements.
struct GltfDocument::Layout {
  int component_type = 0, component_size = 0, columns = 0;
  std::size_t rows = 0;
  bool normalized = false;
  std::string place;
  std::size_t row_size() const { return static_cast<std::size_t>(component_size) * columns; }
};

struct GltfDocument::Slice {
  const std::uint8_t* first = nullptr;
  std::size_t stride = 0;
};

GltfDocument::Layout GltfDocument::layout_of(int index) const {
  const JsonObject accessor = element("accessors", index);
  Layout layout;
  layout.place = accessor.place();
  layout.component_type = static_cast<int>(accessor.integer("componentType", 0, 65535));
  layout.component_size = size_of_component(layout.component_type, accessor.place_of("componentType"));
  layout.columns = columns_of_type(accessor.text("type"), accessor.place_of("type"));
  layout.rows = static_cast<std::size_t>(accessor.integer("count", 1, std::numeric_limits<int>::max() / 16));
  layout.normalized = accessor.truth_or("normalized", false);
  return layout;
}

int GltfDocument::columns_of(int accessor) const {
  return layout_of(accessor).columns;
}
bool GltfDocument::is_matrix(int accessor) const {
  return element("accessors", accessor).text("type").starts_with("MAT");
}
int GltfDocument::rows_of(int accessor) const {
  return static_cast<int>(layout_of(accessor).rows);
}

/// `owner` holds the byteOffset: an accessor, or one of its sparse halves. Checks that all rows are in the
/// view.
GltfDocument::Slice GltfDocument::slice(int view_index, const JsonObject& owner, const Layout& layout,
                                        std::size_t rows) {
  const std::span<const std::uint8_t> bytes = view(view_index);
  const JsonObject description = element("bufferViews", view_index);
  const std::size_t row = layout.row_size();
  const auto stride = static_cast<std::size_t>(description.integer_or("byteStride", row, 1, 65535));
  const auto offset = static_cast<std::size_t>(owner.integer_or("byteOffset", 0, 0, std::int64_t{1} << 40));
  if (stride < row)
    throw io_error(description.place_of("byteStride"), fmt::format("is {}", stride),
                   fmt::format("elements of {} take {} bytes", owner.place(), row));
  if (offset > bytes.size() || row > bytes.size() - offset ||
      (rows - 1) * stride > bytes.size() - offset - row)
    throw io_error(owner.place(),
                   fmt::format("has {} elements of {} bytes from byte {} on", rows, row, offset),
                   fmt::format("{} has {} bytes", description.place(), bytes.size()));
  return {bytes.data() + offset, stride};
}

/// Row i of the slice goes to row `to[i]` of `values`; an empty `to` means row i.
template <typename Number>
void GltfDocument::read_rows(const Slice& slice, const Layout& layout, std::span<const int> to,
                             std::vector<Number>& values) const {
  const auto copy = [&]<typename Stored>(Stored, std::size_t rows) {
    for (std::size_t r = 0; r < rows; ++r) {
      const std::uint8_t* from = slice.first + r * slice.stride;
      Number* row = values.data() + (to.empty() ? r : static_cast<std::size_t>(to[r])) * layout.columns;
      for (int c = 0; c < layout.columns; ++c, from += sizeof(Stored))
        row[c] = converted<Stored, Number>(stored_at<Stored>(from), layout.normalized);
    }
  };
  const std::size_t rows = to.empty() ? layout.rows : to.size();
  switch (layout.component_type) {
    case i8:
      return copy(std::int8_t{}, rows);
    case u8:
      return copy(std::uint8_t{}, rows);
    case i16:
      return copy(std::int16_t{}, rows);
    case u16:
      return copy(std::uint16_t{}, rows);
    case u32:
      return copy(std::uint32_t{}, rows);
    default:
      return copy(float{}, rows);
  }
}

std::vector<int> GltfDocument::sparse_indices(const JsonObject& sparse, const Layout& layout) {
  const JsonObject half = sparse.object("indices");
  Layout wanted;
  wanted.place = half.place();
  wanted.component_type = static_cast<int>(half.integer("componentType", 0, 65535));
  wanted.component_size = size_of_component(wanted.component_type, half.place_of("componentType"));
  if (wanted.component_type != u8 && wanted.component_type != u16 && wanted.component_type != u32)
    throw io_error(half.place_of("componentType"), fmt::format("is {}", wanted.component_type),
                   "give 5121, 5123 or 5125");
  wanted.columns = 1;
  wanted.rows = static_cast<std::size_t>(sparse.integer("count", 1, static_cast<std::int64_t>(layout.rows)));
  const Slice from = slice(half.index("bufferView", count("bufferViews")), half, wanted, wanted.rows);
  spend(wanted.rows * sizeof(int), wanted.place);
  std::vector<std::uint32_t> indices(wanted.rows);
  read_rows<std::uint32_t>(from, wanted, {}, indices);
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= layout.rows || (i > 0 && indices[i] <= indices[i - 1]))
      throw io_error(half.place(), fmt::format("has row {} at {}", indices[i], i),
                     fmt::format("rows must ascend and stay below {}", layout.rows));
  return {indices.begin(), indices.end()};
}

template <typename Number>
std::vector<Number> GltfDocument::read(int index, const Layout& layout, int columns, int rows) {
  const JsonObject accessor = element("accessors", index);
  if (layout.columns != columns)
    throw io_error(accessor.place_of("type"), fmt::format("is {}", accessor.text("type")),
                   fmt::format("{} components are needed here", columns));
  if (rows >= 0 && layout.rows != static_cast<std::size_t>(rows))
    throw io_error(accessor.place_of("count"), fmt::format("is {}", layout.rows),
                   fmt::format("{} elements are needed here", rows));
  if (std::is_integral_v<Number> &&
      (layout.component_type != u8 && layout.component_type != u16 && layout.component_type != u32))
    throw io_error(accessor.place_of("componentType"), fmt::format("is {}", layout.component_type),
                   "unsigned integers are needed here");
  spend(layout.rows * layout.columns * sizeof(Number), layout.place);
  const int view_index = accessor.index_or_none("bufferView", count("bufferViews"));
  // The slice is checked before anything is allocated, so a count can only be as large as the bytes behind
  // it.
  const Slice from = view_index >= 0 ? slice(view_index, accessor, layout, layout.rows) : Slice{};
  std::vector<Number> values(layout.rows * layout.columns);
  if (view_index >= 0) read_rows<Number>(from, layout, {}, values);
  if (accessor.has("sparse")) {
    const JsonObject sparse = accessor.object("sparse");
    const std::vector<int> to = sparse_indices(sparse, layout);
    const JsonObject half = sparse.object("values");
    read_rows<Number>(slice(half.index("bufferView", count("bufferViews")), half, layout, to.size()), layout,
                      to, values);
  }
  return values;
}

Table GltfDocument::floats(int accessor, int columns, int rows) {
  Table table;
  table.values = read<float>(accessor, layout_of(accessor), columns, rows);
  table.columns = columns;
  table.rows = static_cast<int>(table.values.size()) / columns;
  check_finite(table.values, accessor, columns);
  return table;
}

StoredTable GltfDocument::stored(int accessor, int rows) {
  Layout layout = layout_of(accessor);
  StoredTable table;
  table.rows = rows;
  table.columns = layout.columns;
  table.component_type = layout.component_type;
  table.normalized = layout.normalized && layout.component_type != f32;
  layout.normalized = false;
  table.values = read<float>(accessor, layout, layout.columns, rows);
  check_finite(table.values, accessor, layout.columns);
  return table;
}

std::vector<std::uint32_t> GltfDocument::integers(int accessor, int columns, int rows) {
  return read<std::uint32_t>(accessor, layout_of(accessor), columns, rows);
}

SparseTable GltfDocument::sparse_rows(int index, int rows) {
  const JsonObject accessor = element("accessors", index);
  SparseTable result;
  if (accessor.has("sparse") && !accessor.has("bufferView")) {
    const Layout layout = layout_of(index);
    if (layout.columns != 3 || layout.rows != static_cast<std::size_t>(rows))
      throw io_error(accessor.place(),
                     fmt::format("has {} elements of {} components", layout.rows, layout.columns),
                     fmt::format("{} elements of 3 are needed here", rows));
    const JsonObject sparse = accessor.object("sparse");
    result.rows = sparse_indices(sparse, layout);
    const JsonObject half = sparse.object("values");
    const Slice from =
        slice(half.index("bufferView", count("bufferViews")), half, layout, result.rows.size());
    spend(result.rows.size() * 3 * sizeof(float), layout.place);
    std::vector<float> values(result.rows.size() * 3);
    std::vector<int> identity(result.rows.size());
    std::iota(identity.begin(), identity.end(), 0);
    read_rows<float>(from, layout, identity, values);
    result.values = Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(result.rows.size()), 3);
  } else if (accessor.has("bufferView")) {
    const Table table = floats(index, 3, rows);
    const Eigen::Map<const Points> dense(table.values.data(), rows, 3);
    for (int r = 0; r < rows; ++r)
      if ((dense.row(r).array() != 0).any()) result.rows.push_back(r);
    result.values.resize(static_cast<Eigen::Index>(result.rows.size()), 3);
    for (std::size_t k = 0; k < result.rows.size(); ++k) result.values.row(k) = dense.row(result.rows[k]);
  }
  if (!result.values.allFinite())
    throw io_error(accessor.place(), "holds numbers that are not finite", "give finite numbers");
  return result;
}

std::vector<std::uint8_t> GltfDocument::decompress(const JsonObject& view, const JsonObject& compression) {
  const std::span<const std::uint8_t> packed = sub_range(compression, "buffer");
  const auto stride = static_cast<std::size_t>(compression.integer("byteStride", 1, 256));
  const auto rows = static_cast<std::size_t>(compression.integer("count", 1, std::int64_t{1} << 31));
  const auto length = static_cast<std::size_t>(view.integer("byteLength", 1, std::int64_t{1} << 40));
  const std::string mode = compression.text("mode"), filter = compression.text_or("filter", "NONE");
  const Error broken = io_error(compression.place(), "cannot be decompressed", "the data is damaged");
  // The codecs need at least two bits for sixteen bytes of a vertex stream, one byte for a triangle or an
  // index.
  if (rows * stride != length || rows * stride / 64 > packed.size() + 64) throw broken;
  spend(rows * stride, compression.place());
  std::vector<std::uint8_t> bytes(rows * stride);
  int code = -1;
  if (mode == "ATTRIBUTES" && stride % 4 == 0)
    code = meshopt_decodeVertexBuffer(bytes.data(), rows, stride, packed.data(), packed.size());
  else if (mode == "TRIANGLES" && rows % 3 == 0 && (stride == 2 || stride == 4))
    code = meshopt_decodeIndexBuffer(bytes.data(), rows, stride, packed.data(), packed.size());
  else if (mode == "INDICES" && (stride == 2 || stride == 4))
    code = meshopt_decodeIndexSequence(bytes.data(), rows, stride, packed.data(), packed.size());
  if (code != 0) throw broken;
  // The filters work on four vertices at a time in place; the padding gives them room.
  bytes.resize((rows + 3) / 4 * 4 * stride);
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
    meshopt_decodeFilterOct(bytes.data(), rows, stride);
  else if (filter == "QUATERNION" && stride == 8)
    meshopt_decodeFilterQuat(bytes.data(), rows, stride);
  else if (filter == "EXPONENTIAL" && stride % 4 == 0)
    meshopt_decodeFilterExp(bytes.data(), rows, stride);
  else if (filter != "NONE")
    throw broken;
  bytes.resize(rows * stride);
  return bytes;
}

}  // namespace mien::detail
