#pragma once
/// A glTF 2.0 file taken apart: its JSON, its buffers, and its accessors as plain arrays of numbers.

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mien/geometry/mesh.h"
#include "mien/io/detail/json.h"

namespace mien::detail {

/// The vendor extension that carries what glTF has no place for; docs/io.md describes it.
inline constexpr const char* vendor_extension = "MIEN_character";

/// Numbers of one accessor: `rows` elements of `columns` components, row by row.
struct Table {
  int rows = 0, columns = 0;
  std::vector<float> values;
};

/// Numbers of one accessor as the file stores them: whole numbers are not scaled.
struct StoredTable {
  int rows = 0, columns = 0, component_type = 0;
  bool normalized = false;
  std::vector<float> values;
};

/// The rows of an accessor that are not zero.
struct SparseTable {
  std::vector<int> rows;  ///< ascending
  Points values;
};

class GltfDocument {
 public:
  /// Reads .glb or .gltf with its buffers.
  ///   throws  io: not glTF 2.0, truncated, a required extension that mien does not read
  explicit GltfDocument(const std::filesystem::path& path);

  JsonObject root() const { return JsonObject(json_, ""); }
  std::size_t count(const char* collection) const;
  /// Element `index` of a root array, with its place.
  JsonObject element(const char* collection, int index) const;

  /// An accessor as floats; normalised integers become [0, 1] or [-1, 1].
  ///   columns  what the accessor must have (1 SCALAR ... 4 VEC4, 16 MAT4); rows: how many, or -1 for any
  Table floats(int accessor, int columns, int rows = -1);
  /// An accessor of any type as stored; 32-bit whole numbers become the nearest floats.
  StoredTable stored(int accessor, int rows);
  /// An accessor of unsigned integers.
  std::vector<std::uint32_t> integers(int accessor, int columns, int rows = -1);
  /// A VEC3 accessor of displacements without its zero rows; sparse accessors are never made dense.
  SparseTable sparse_rows(int accessor, int rows);
  int columns_of(int accessor) const;
  /// Whether the accessor holds matrices, whose columns files pad.
  bool is_matrix(int accessor) const;
  int rows_of(int accessor) const;

  /// The bytes of a buffer view, decompressed.
  std::span<const std::uint8_t> view(int index);

  /// The bytes that a uri names: a data: URI, or a file in the glTF's folder.
  ///   throws  io: a path that leaves the folder, a missing file
  std::vector<std::uint8_t> bytes_of_uri(const std::string& uri, const std::string& place) const;
  bool has_uri_file(const std::string& uri) const;

 private:
  struct Layout;
  struct Slice;
  void parse_container(std::span<const std::uint8_t> file);
  void check_version_and_extensions() const;
  const std::vector<std::uint8_t>& buffer(int index);
  std::vector<std::uint8_t> decompress(const JsonObject& view, const JsonObject& compression);
  std::span<const std::uint8_t> sub_range(const JsonObject& view, const char* buffer_key);
  Layout layout_of(int accessor) const;
  Slice slice(int view_index, const JsonObject& owner, const Layout& layout, std::size_t rows);
  std::vector<int> sparse_indices(const JsonObject& sparse, const Layout& layout);
  template <typename Number>
  void read_rows(const Slice& slice, const Layout& layout, std::span<const int> to,
                 std::vector<Number>& values) const;
  template <typename Number>
  std::vector<Number> read(int accessor, const Layout& layout, int columns, int rows);
  void spend(std::size_t bytes, const std::string& place);

  std::filesystem::path folder_;
  Json json_;
  bool binary_ = false;
  std::vector<std::uint8_t> chunk_;  ///< the GLB's own buffer
  std::map<int, std::vector<std::uint8_t>> buffers_;
  std::map<int, std::vector<std::uint8_t>> decompressed_;
  std::size_t budget_ =
      0;  ///< bytes that may still be decoded, so that a small file never asks for a huge allocation
};

}  // namespace mien::detail
