#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/skin_table.h"

namespace mien::detail {
namespace {

enum Mode { points = 0, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

/// A run of vertices that one or more primitives index.
struct Range {
  int begin = 0, end = 0;
  bool has_normals = false;
  int count() const { return end - begin; }
};

/// A range and the accessors that it came from.
struct KnownRange {
  Json accessors;  ///< attributes and targets
  Range range;
};

template <typename Rows>
void grow(Rows& rows, Eigen::Index count, float fill = 0) {
  const Eigen::Index before = rows.rows();
  if (before >= count) return;
  rows.conservativeResize(count, Eigen::NoChange);
  rows.bottomRows(count - before).setConstant(fill);
}

/// One mesh while its primitives are added to it.
class MeshReader {
 public:
  MeshReader(GltfDocument& document, bool skinned) : document_(document), skinned_(skinned) {}
  MeshData read(const JsonObject& mesh);

 private:
  void add_faces(const JsonObject& primitive);
  void add_loose(const JsonObject& primitive);
  Range range_of(const JsonObject& primitive);
  Range append_vertices(const JsonObject& primitive);
  void append_uvs(const JsonObject& attributes, const Range& range);
  void append_colors(const JsonObject& attributes, const Range& range);
  void append_influences_of(const JsonObject& attributes, const Range& range);
  void append_custom(const JsonObject& attributes, const Range& range);
  std::vector<std::uint32_t> indices_of(const JsonObject& primitive, const Range& range);
  void append_targets(const JsonObject& primitive, const Range& range);
  void append_faces(const JsonObject& primitive, const Range& range);
  void push_triangle(int a, int b, int c, const Range& range);
  void complete_attributes();
  int accessor(const JsonObject& attributes, const char* name) const {
    return attributes.index_or_none(name, document_.count("accessors"));
  }

  GltfDocument& document_;
  bool skinned_;
  MeshData data_;
  std::map<std::string, Range> ranges_;     ///< by all accessors
  std::map<int, KnownRange> first_ranges_;  ///< the first that has these positions
  std::optional<std::size_t> target_count_;
  bool tangents_everywhere_ = true;
};

MeshData MeshReader::read(const JsonObject& mesh) {
  // The points of a part that has neither faces nor anything loose stand for its vertices.
  const bool only_vertices = mesh.has("extensions") && mesh.object("extensions").has(vendor_extension) &&
                             mesh.object("extensions").object(vendor_extension).truth_or("points", false);
  Json carried = Json::array();
  bool carries = false;
  const auto add = [&](const JsonObject& primitive, bool faces) {
    const std::int64_t mode = primitive.integer_or("mode", triangles, points, triangle_fan);
    if (faces != (mode >= triangles || (mode == points && only_vertices))) return;
    if (!faces && !primitive.object("attributes").has("POSITION")) return;  // draws nothing
    if (faces)
      add_faces(primitive);
    else
      add_loose(primitive);
    const std::string others = primitive.others({"attributes", "indices", "material", "mode", "targets"});
    carries = carries || !others.empty();
    carried.push_back(others.empty() ? Json::object() : Json::parse(others));
  };
  // As they are written: faces first, so that points and lines do not change the numbers of the faces' vertices.
  for (const bool faces : {true, false})
    for (const JsonObject& primitive : mesh.objects("primitives")) add(primitive, faces);
  if (carries) data_.carried_primitives = json_text(carried);
  complete_attributes();
  return std::move(data_);
}

/// Whether `some` has no accessor that `all` has not.
bool is_part_of(const Json& some, const Json& all) {
  if (some[1] != all[1]) return false;
  for (const auto& [name, accessor] : some[0].items())
    if (!all[0].contains(name) || all[0][name] != accessor) return false;
  return true;
}

/// Primitives of the same accessors share their vertices. Points and lines that have some of another's and no others do
/// too, because points have no tangents.
Range MeshReader::range_of(const JsonObject& primitive) {
  const Json accessors = {primitive.object("attributes").json(),
                          primitive.has("targets") ? primitive.json().at("targets") : Json()};
  const std::string key = json_text(accessors);
  if (const auto known = ranges_.find(key); known != ranges_.end()) return known->second;
  const int positions = primitive.object("attributes").index("POSITION", document_.count("accessors"));
  const auto first = first_ranges_.find(positions);
  const bool is_loose = primitive.integer_or("mode", triangles, points, triangle_fan) < triangles;
  const bool shares =
      is_loose && first != first_ranges_.end() && is_part_of(accessors, first->second.accessors);
  const Range range = shares ? first->second.range : append_vertices(primitive);
  ranges_.emplace(key, range);
  first_ranges_.emplace(positions, KnownRange{accessors, range});
  return range;
}

void MeshReader::add_loose(const JsonObject& primitive) {
  const std::int64_t mode = primitive.integer_or("mode", triangles, points, line_strip);
  const Range range = range_of(primitive);
  const std::vector<std::uint32_t> indices = indices_of(primitive, range);
  LooseElements loose;
  loose.lines = mode != points;
  loose.material = primitive.index_or_none("material", document_.count("materials"));
  const auto add = [&](std::size_t i) {
    loose.vertices.push_back(range.begin + static_cast<int>(indices[i]));
  };
  if (mode == points || mode == lines) {
    const std::size_t whole = mode == lines ? indices.size() / 2 * 2 : indices.size();
    for (std::size_t i = 0; i < whole; ++i) add(i);
  } else {
    const std::size_t ends = mode == line_loop ? indices.size() : indices.size() - 1;
    for (std::size_t i = 0; i < ends && indices.size() > 1; ++i) add(i), add((i + 1) % indices.size());
  }
  if (!loose.vertices.empty()) data_.mesh.loose.push_back(std::move(loose));
}

void MeshReader::add_faces(const JsonObject& primitive) {
  const Range range = range_of(primitive);
  FaceGroup group;
  group.material = primitive.index_or_none("material", document_.count("materials"));
  group.face_begin = static_cast<int>(data_.mesh.faces.size());
  group.vertex_begin = range.begin;
  group.vertex_end = range.end;
  append_faces(primitive, range);
  group.face_end = static_cast<int>(data_.mesh.faces.size());
  data_.mesh.groups.push_back(group);
}

Range MeshReader::append_vertices(const JsonObject& primitive) {
  const JsonObject attributes = primitive.object("attributes");
  Mesh& mesh = data_.mesh;
  const int position = attributes.index("POSITION", document_.count("accessors"));
  const Table positions = document_.floats(position, 3);
  Range range{static_cast<int>(mesh.positions.rows()),
              static_cast<int>(mesh.positions.rows()) + positions.rows};
  mesh.positions.conservativeResize(range.end, 3);
  mesh.positions.bottomRows(range.count()) =
      Eigen::Map<const Points>(positions.values.data(), range.count(), 3);
  if (const int normal = accessor(attributes, "NORMAL"); normal >= 0) {
    const Table table = document_.floats(normal, 3, range.count());
    grow(mesh.normals, range.end);
    mesh.normals.bottomRows(range.count()) = Eigen::Map<const Points>(table.values.data(), range.count(), 3);
    range.has_normals = true;
  }
  if (const int tangent = accessor(attributes, "TANGENT"); tangent >= 0) {
    const Table table = document_.floats(tangent, 4, range.count());
    grow(mesh.tangents, range.end);
    mesh.tangents.bottomRows(range.count()) =
        Eigen::Map<const Points4>(table.values.data(), range.count(), 4);
  } else if (primitive.integer_or("mode", triangles, points, triangle_fan) >= triangles) {
    tangents_everywhere_ = false;
  }
  append_uvs(attributes, range);
  append_colors(attributes, range);
  if (skinned_) append_influences_of(attributes, range);
  append_custom(attributes, range);
  append_targets(primitive, range);
  return range;
}

void MeshReader::append_uvs(const JsonObject& attributes, const Range& range) {
  for (std::size_t set = 0;; ++set) {
    const int uv = accessor(attributes, fmt::format("TEXCOORD_{}", set).c_str());
    if (uv < 0) break;
    const Table table = document_.floats(uv, 2, range.count());
    if (data_.mesh.uvs.size() <= set) data_.mesh.uvs.emplace_back();
    Points2& coordinates = data_.mesh.uvs[set].coordinates;
    grow(coordinates, range.end);
    for (int r = 0; r < range.count(); ++r)
      coordinates.row(range.begin + r) << table.values[2 * r], 1.f - table.values[2 * r + 1];
  }
}

void MeshReader::append_colors(const JsonObject& attributes, const Range& range) {
  for (std::size_t set = 0;; ++set) {
    const int color = accessor(attributes, fmt::format("COLOR_{}", set).c_str());
    if (color < 0) break;
    const int columns = document_.columns_of(color) == 3 ? 3 : 4;
    const Table table = document_.floats(color, columns, range.count());
    if (data_.mesh.colors.size() <= set) data_.mesh.colors.emplace_back();
    Points4& colors = data_.mesh.colors[set];
    grow(colors, range.end, 1.f);
    for (int r = 0; r < range.count(); ++r)
      for (int c = 0; c < columns; ++c) colors(range.begin + r, c) = table.values[columns * r + c];
  }
}

void MeshReader::append_influences_of(const JsonObject& attributes, const Range& range) {
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<Table> weights;
  for (std::size_t set = 0;; ++set) {
    const int joint = accessor(attributes, fmt::format("JOINTS_{}", set).c_str());
    const int weight = accessor(attributes, fmt::format("WEIGHTS_{}", set).c_str());
    if (joint < 0 || weight < 0) break;
    joints.push_back(document_.integers(joint, 4, range.count()));
    weights.push_back(document_.floats(weight, 4, range.count()));
  }
  std::vector<Influence> influences;
  for (int r = 0; r < range.count(); ++r) {
    influences.clear();
    for (std::size_t set = 0; set < joints.size(); ++set)
      for (int c = 0; c < 4; ++c)
        influences.push_back({static_cast<int>(std::min<std::uint32_t>(joints[set][4 * r + c], 1 << 30)),
                              weights[set].values[4 * r + c]});
    tidy_influences(influences);
    append_influences(data_.skin_weights, influences);
  }
}

/// The numbers of an attribute as others understand them.
void decode(VertexAttribute& attribute) {
  const float one = attribute.component_type == 5120   ? 127.f
                    : attribute.component_type == 5121 ? 255.f
                    : attribute.component_type == 5122 ? 32767.f
                                                       : 65535.f;
  if (attribute.normalized)
    for (float& value : attribute.values) value = std::max(value / one, -1.f);
  attribute.component_type = 5126;
  attribute.normalized = false;
}

/// Puts zeros behind each vertex's numbers.
void widen(VertexAttribute& attribute, int width) {
  const std::size_t rows = attribute.values.size() / attribute.width;
  std::vector<float> wide(rows * width, 0.f);
  for (std::size_t r = 0; r < rows; ++r)
    std::copy_n(attribute.values.begin() + r * attribute.width, attribute.width, wide.begin() + r * width);
  attribute.values = std::move(wide);
  attribute.width = width;
}

/// Attributes `_NAME`. Primitives that store one differently get it as floats of the widest.
void MeshReader::append_custom(const JsonObject& attributes, const Range& range) {
  for (const auto& [name, value] : attributes.json().items()) {
    if (!name.starts_with('_')) continue;
    const int index = attributes.index(name.c_str(), document_.count("accessors"));
    if (document_.is_matrix(index)) continue;
    StoredTable table = document_.stored(index, range.count());
    VertexAttribute read{name, table.columns, table.component_type, table.normalized,
                         std::move(table.values)};
    if (read.component_type == 5125)
      read.component_type = 5126, read.normalized = false;  // glTF forbids 32 bits here
    std::vector<VertexAttribute>& all = data_.mesh.attributes;
    auto found = std::find_if(all.begin(), all.end(), [&](const auto& a) { return a.name == read.name; });
    if (found == all.end()) {
      all.push_back(std::move(read));
      all.back().values.insert(all.back().values.begin(),
                               static_cast<std::size_t>(range.begin) * all.back().width, 0.f);
      continue;
    }
    if (found->component_type != read.component_type || found->normalized != read.normalized)
      decode(*found), decode(read);
    const int width = std::max(found->width, read.width);
    if (found->width < width) widen(*found, width);
    if (read.width < width) widen(read, width);
    found->values.resize(static_cast<std::size_t>(range.begin) * width, 0.f);
    found->values.insert(found->values.end(), read.values.begin(), read.values.end());
  }
}

void append_rows(Points& to, const Points& rows) {
  to.conservativeResize(to.rows() + rows.rows(), 3);
  to.bottomRows(rows.rows()) = rows;
}

/// The rows of a sparse table that belong to `vertices` (numbered within the range), zero where it has none.
Points rows_for(const SparseTable& table, const std::vector<int>& vertices) {
  Points rows = Points::Zero(static_cast<Eigen::Index>(vertices.size()), 3);
  std::size_t from = 0;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    while (from < table.rows.size() && table.rows[from] < vertices[k]) ++from;
    if (from < table.rows.size() && table.rows[from] == vertices[k]) rows.row(k) = table.values.row(from);
  }
  return rows;
}

std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

void MeshReader::append_targets(const JsonObject& primitive, const Range& range) {
  const std::vector<JsonObject> targets = primitive.objects("targets");
  if (target_count_ && *target_count_ != targets.size())
    throw io_error(primitive.place_of("targets"), fmt::format("has {} targets", targets.size()),
                   fmt::format("the mesh's other primitives have {}", *target_count_));
  target_count_ = targets.size();
  data_.targets.resize(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const auto table = [&](const char* name) {
      const int index = accessor(targets[t], name);
      return index < 0 ? SparseTable{} : document_.sparse_rows(index, range.count());
    };
    const SparseTable positions = table("POSITION"), normals = table("NORMAL"), tangents = table("TANGENT");
    const std::vector<int> vertices = united(united(positions.rows, normals.rows), tangents.rows);
    PartDelta& delta = data_.targets[t];
    const auto already = static_cast<Eigen::Index>(delta.vertices.size());
    for (const int v : vertices) delta.vertices.push_back(range.begin + v);
    append_rows(delta.deltas, rows_for(positions, vertices));
    if (targets[t].has("NORMAL")) {
      grow(delta.normal_deltas, already);
      append_rows(delta.normal_deltas, rows_for(normals, vertices));
    }
    if (targets[t].has("TANGENT")) {
      grow(delta.tangent_deltas, already);
      append_rows(delta.tangent_deltas, rows_for(tangents, vertices));
    }
  }
}

void MeshReader::push_triangle(int a, int b, int c, const Range& range) {
  data_.mesh.faces.push_back({range.begin + a, range.begin + b, range.begin + c});
}

std::vector<std::uint32_t> MeshReader::indices_of(const JsonObject& primitive, const Range& range) {
  std::vector<std::uint32_t> indices;
  if (const int index = accessor(primitive, "indices"); index >= 0) {
    indices = document_.integers(index, 1);
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= static_cast<std::uint32_t>(range.count()))
        throw io_error(fmt::format("accessors[{}]", index), fmt::format("index {} is {}", i, indices[i]),
                       fmt::format("there are {} vertices", range.count()));
  } else {
    indices.resize(range.count());
    for (int i = 0; i < range.count(); ++i) indices[i] = i;
  }
  return indices;
}

void MeshReader::append_faces(const JsonObject& primitive, const Range& range) {
  const std::int64_t mode = primitive.integer_or("mode", triangles, points, triangle_fan);
  if (mode == points) return;
  const std::vector<std::uint32_t> indices = indices_of(primitive, range);
  const auto at = [&](std::size_t i) { return static_cast<int>(indices[i]); };
  switch (mode) {
    case triangle_strip:
      for (std::size_t i = 2; i < indices.size(); ++i)
        push_triangle(at(i - 2 + i % 2), at(i - 1 - i % 2), at(i), range);
      break;
    case triangle_fan:
      for (std::size_t i = 2; i < indices.size(); ++i) push_triangle(at(0), at(i - 1), at(i), range);
      break;
    default:
      if (indices.size() % 3 != 0)
        throw io_error(primitive.place(), fmt::format("has {} indices", indices.size()),
                       "triangles need a multiple of three");
      data_.mesh.faces.reserve(data_.mesh.faces.size() + indices.size() / 3,
                               data_.mesh.faces.corner_count() + indices.size());
      for (std::size_t i = 0; i < indices.size(); i += 3) push_triangle(at(i), at(i + 1), at(i + 2), range);
  }
}

/// Primitives that lack what others of the mesh have get it here, so that every array covers all vertices.
void MeshReader::complete_attributes() {
  Mesh& mesh = data_.mesh;
  const Eigen::Index count = mesh.positions.rows();
  for (UvSet& uv : mesh.uvs) grow(uv.coordinates, count);
  for (Points4& colors : mesh.colors) grow(colors, count, 1.f);
  for (VertexAttribute& attribute : mesh.attributes)
    attribute.values.resize(static_cast<std::size_t>(count) * attribute.width, 0.f);
  if (mesh.tangents.rows() > 0) grow(mesh.tangents, count);
  if (!tangents_everywhere_) mesh.tangents.resize(0, 4);
  if (mesh.normals.rows() > 0) {
    grow(mesh.normals, count);
    std::optional<Points> computed;
    for (const auto& [key, range] : ranges_) {
      if (range.has_normals) continue;
      if (!computed) computed = vertex_normals(mesh.positions, triangulate(mesh.faces));
      mesh.normals.middleRows(range.begin, range.count()) = computed->middleRows(range.begin, range.count());
    }
  }
  for (PartDelta& delta : data_.targets) {
    const auto rows = static_cast<Eigen::Index>(delta.vertices.size());
    if (delta.normal_deltas.rows() > 0) grow(delta.normal_deltas, rows);
    if (delta.tangent_deltas.rows() > 0) grow(delta.tangent_deltas, rows);
  }
}

}  // namespace

MeshData read_mesh(GltfDocument& document, int mesh, bool skinned) {
  return MeshReader(document, skinned).read(document.element("meshes", mesh));
}

}  // namespace mien::detail
