#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_write.h"
#include "mien/io/detail/skin_table.h"

namespace mien::detail {
namespace {

/// Rows [begin, end) of the split mesh; copies take the vertex's own values.
template <typename Rows>
Rows rows_of(const Rows& values, const SplitMesh& split, int begin, int end) {
  Rows rows(end - begin, values.cols());
  for (int r = begin; r < end; ++r) rows.row(r - begin) = values.row(split.vertex_of(r));
  return rows;
}

template <typename Rows>
std::span<const float> flat(const Rows& rows) {
  return {rows.data(), static_cast<std::size_t>(rows.size())};
}

/// Unit normals for every row; a vertex without a face gets +Y, since glTF has no other way to say "none".
Points normals_of(const Mesh& mesh) {
  const bool own = mesh.normals.rows() == mesh.positions.rows();
  Points normals = own ? mesh.normals : vertex_normals(mesh.positions, triangulate(mesh.faces));
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    const float length = normals.row(v).norm();
    if (!(length > 0))
      normals.row(v) << 0, 1, 0;
    else if (std::abs(length - 1) > 5e-4f)
      normals.row(v) /= length;
  }
  return normals;
}

/// The same for tangents; a vertex without one gets +X.
Points4 tangents_of(const Mesh& mesh) {
  Points4 tangents = mesh.tangents;
  for (Eigen::Index v = 0; v < tangents.rows(); ++v)
    if ((tangents.row(v).array() == 0).all()) tangents.row(v) << 1, 0, 0, 1;
  return tangents;
}

/// The arrays of one vertex range, written once and shared by all primitives that use it.
struct WrittenRange {
  Json attributes;
  Json targets = Json::array();
};

/// Whether the rows say something: zeros stand for vertices that have none.
template <typename Rows>
bool any_in(const Rows& rows, int begin, int end) {
  return begin < end && (rows.middleRows(begin, end - begin).array() != 0).any();
}

class MeshWriter {
 public:
  MeshWriter(const Character& character, int part, GltfBuilder& builder)
      : character_(character),
        part_index_(part),
        part_(character.parts[part]),
        builder_(builder),
        split_(split_seams(part_.mesh)),
        ranges_(part_.mesh, split_),
        normals_(normals_of(part_.mesh)),
        precision_{builder_error * bounding_box(part_.mesh.positions).diagonal()} {}
  Json write();

 private:
  static constexpr double builder_error = 1e-5 / 1.7321;  // a component's share of 1e-5 of the box
  const WrittenRange& range(std::pair<int, int> rows);
  WrittenRange write_range(int begin, int end);
  void write_directions(int begin, int end, Json& attributes);
  void write_custom(int begin, int end, Json& attributes);
  void write_primitives(Json& primitives);
  void write_influences(int begin, int end, Json& attributes);
  void write_targets(int begin, int end, Json& targets);
  Json write_faces(const FaceGroup& group);
  Json write_loose(const LooseElements& loose);

  const Character& character_;
  int part_index_;
  const Part& part_;
  GltfBuilder& builder_;
  SplitMesh split_;
  VertexRanges ranges_;
  Points normals_;
  Precision precision_;
  std::map<std::pair<int, int>, WrittenRange> written_;
};

Json MeshWriter::write() {
  Json mesh = carried_json(part_.carried, fmt::format("part {}: carried", part_.name));
  const Json carried_primitives = mesh.value("primitives", Json::array());
  mesh["primitives"] = Json::array();
  write_primitives(mesh["primitives"]);
  for (std::size_t p = 0; p < mesh["primitives"].size() && p < carried_primitives.size(); ++p)
    if (carried_primitives[p].is_object()) mesh["primitives"][p].update(carried_primitives[p]);
  mesh["name"] = part_.mesh_name.empty() ? part_.name : part_.mesh_name;
  if (!mesh["extras"].is_object()) mesh.erase("extras");
  Json names = Json::array(), weights = Json::array();
  const ShapeWeights rest = shape_weights(character_, rest_sliders(character_));
  for (std::size_t s = 0; s < character_.shapes.size(); ++s) {
    const Shape& shape = character_.shapes[s];
    if (std::any_of(shape.parts.begin(), shape.parts.end(),
                    [&](const PartDelta& delta) { return delta.part == part_index_; })) {
      names.push_back(shape.name);
      weights.push_back(rest.values[static_cast<Eigen::Index>(s)]);
    }
  }
  if (!names.empty()) {
    mesh["extras"]["targetNames"] = names;
    mesh["weights"] = weights;
  }
  const bool computed = part_.mesh.normals.rows() != part_.mesh.positions.rows();
  Json vendor = vendor_mesh(part_.mesh, split_, computed && !part_.mesh.faces.empty(), builder_);
  write_surface(part_, vendor);
  if (!vendor.empty()) vendor["vertexCount"] = split_.vertex_count;
  if (!vendor.empty()) mesh["extensions"][vendor_extension] = vendor;
  return mesh;
}

void MeshWriter::write_primitives(Json& primitives) {
  for (const FaceGroup& group : primitive_groups(part_.mesh, split_))
    primitives.push_back(write_faces(group));
  for (const LooseElements& loose : part_.mesh.loose) primitives.push_back(write_loose(loose));
}

const WrittenRange& MeshWriter::range(std::pair<int, int> rows) {
  const auto known = written_.find(rows);
  if (known != written_.end()) return known->second;
  return written_.emplace(rows, write_range(rows.first, rows.second)).first->second;
}

/// Normals and tangents, where the range has any: what only lines and points use need not.
void MeshWriter::write_directions(int begin, int end, Json& attributes) {
  const Mesh& mesh = part_.mesh;
  const bool own = mesh.normals.rows() == mesh.positions.rows();
  // Computed normals are for other programs' pictures alone: a tenth of a degree will do.
  const Precision direction{own ? 1.0 / 65536 : 1.0 / 1024};
  const bool has_faces = ranges_.has_faces(begin, end);
  const int last = std::min(end, split_.vertex_count);
  if (has_faces || (own && any_in(mesh.normals, begin, last)))
    attributes["NORMAL"] = builder_.add_attribute(flat(rows_of(normals_, split_, begin, end)), 3, direction);
  if (mesh.tangents.rows() == mesh.positions.rows() && mesh.tangents.rows() > 0 &&
      (has_faces || any_in(mesh.tangents, begin, last)))
    attributes["TANGENT"] =
        builder_.add_attribute(flat(rows_of(tangents_of(mesh), split_, begin, end)), 4, direction);
}

void MeshWriter::write_custom(int begin, int end, Json& attributes) {
  for (const VertexAttribute& attribute : part_.mesh.attributes) {
    std::vector<float> values;
    for (int r = begin; r < end; ++r) {
      const auto from = attribute.values.begin() + split_.vertex_of(r) * attribute.width;
      values.insert(values.end(), from, from + attribute.width);
    }
    attributes[attribute.name] = builder_.add_custom(values, attribute);
  }
}

WrittenRange MeshWriter::write_range(int begin, int end) {
  WrittenRange range;
  const Mesh& mesh = part_.mesh;
  range.attributes["POSITION"] =
      builder_.add_attribute(flat(rows_of(mesh.positions, split_, begin, end)), 3, precision_, true);
  constexpr Precision color{1.0 / 1024}, uv{1.0 / 131072};
  write_directions(begin, end, range.attributes);
  for (std::size_t set = 0; set < split_.uvs.size(); ++set) {
    Points2 flipped = split_.uvs[set].middleRows(begin, end - begin);
    flipped.col(1) = 1.f - flipped.col(1).array();
    range.attributes[fmt::format("TEXCOORD_{}", set)] = builder_.add_attribute(flat(flipped), 2, uv);
  }
  for (std::size_t set = 0; set < mesh.colors.size(); ++set)
    range.attributes[fmt::format("COLOR_{}", set)] =
        builder_.add_attribute(flat(rows_of(mesh.colors[set], split_, begin, end)), 4, color);
  if ((part_.skin >= 0 || !part_.shown) && !part_.skin_weights.empty())
    write_influences(begin, end, range.attributes);
  write_custom(begin, end, range.attributes);
  write_targets(begin, end, range.targets);
  return range;
}

void MeshWriter::write_influences(int begin, int end, Json& attributes) {
  const SkinWeights& skin = part_.skin_weights;
  std::vector<std::vector<Influence>> rows(end - begin);
  std::size_t most = 1;
  for (int r = begin; r < end; ++r) {
    const int v = split_.vertex_of(r);
    std::vector<Influence>& influences = rows[r - begin];
    for (int i = skin.offsets[v]; i < skin.offsets[v + 1]; ++i)
      influences.push_back({skin.joints[i], skin.weights[i]});
    tidy_influences(influences);
    most = std::max(most, influences.size());
  }
  const std::size_t joint_count = part_.skin >= 0 ? character_.skins[part_.skin].joints.size() : 65536;
  const bool narrow = joint_count <= 256;
  for (std::size_t set = 0; set < (most + 3) / 4; ++set) {
    std::vector<std::uint16_t> joints(rows.size() * 4, 0);
    std::vector<float> weights(rows.size() * 4, 0.f);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t c = 0; c < 4 && 4 * set + c < rows[r].size(); ++c) {
        joints[4 * r + c] = static_cast<std::uint16_t>(rows[r][4 * set + c].joint);
        weights[4 * r + c] = rows[r][4 * set + c].weight;
      }
    const std::string suffix = std::to_string(set);
    if (narrow) {
      const std::vector<std::uint8_t> bytes(joints.begin(), joints.end());
      attributes["JOINTS_" + suffix] = builder_.add_attribute(std::span<const std::uint8_t>(bytes), 4);
    } else {
      attributes["JOINTS_" + suffix] =
          builder_.add_attribute(std::span<const std::uint16_t>(joints), 4, false);
    }
    attributes["WEIGHTS_" + suffix] = builder_.add_attribute(weights, 4, Precision{});
  }
}

void MeshWriter::write_targets(int begin, int end, Json& targets) {
  std::vector<std::vector<int>> rows_of_vertex(split_.vertex_count);
  for (int r = begin; r < end; ++r) rows_of_vertex[split_.vertex_of(r)].push_back(r - begin);
  for (const Shape& shape : character_.shapes)
    for (const PartDelta& delta : shape.parts) {
      if (delta.part != part_index_) continue;
      std::vector<std::pair<int, int>> rows;  // row in this range, entry in the delta
      for (std::size_t k = 0; k < delta.vertices.size(); ++k)
        for (const int r : rows_of_vertex[delta.vertices[k]]) rows.emplace_back(r, static_cast<int>(k));
      std::sort(rows.begin(), rows.end());
      std::vector<int> vertices(rows.size());
      for (std::size_t k = 0; k < rows.size(); ++k) vertices[k] = rows[k].first;
      const auto add = [&](const Points& values) {
        Points picked(static_cast<Eigen::Index>(rows.size()), 3);
        for (std::size_t k = 0; k < rows.size(); ++k) picked.row(k) = values.row(rows[k].second);
        return builder_.add_deltas(end - begin, vertices, picked, precision_);
      };
      const auto count = static_cast<Eigen::Index>(delta.vertices.size());
      Json target = {{"POSITION", add(delta.deltas)}};
      if (count > 0 && delta.normal_deltas.rows() == count) target["NORMAL"] = add(delta.normal_deltas);
      if (count > 0 && delta.tangent_deltas.rows() == count) target["TANGENT"] = add(delta.tangent_deltas);
      targets.push_back(std::move(target));
    }
}

Json MeshWriter::write_faces(const FaceGroup& group) {
  const WrittenRange& range = this->range({group.vertex_begin, group.vertex_end});
  std::vector<std::uint32_t> indices;
  for (int f = group.face_begin; f < group.face_end; ++f) {
    const int first = part_.mesh.faces.offset(f), size = static_cast<int>(part_.mesh.faces[f].size());
    for (int c = 2; c < size; ++c)
      for (const int corner : {0, c - 1, c})
        indices.push_back(static_cast<std::uint32_t>(split_.corner_row[first + corner] - group.vertex_begin));
  }
  Json primitive = {{"attributes", range.attributes}};
  if (indices.empty())
    primitive["mode"] = 0;  // points: glTF has no triangles without corners
  else
    primitive["indices"] =
        builder_.add_indices(indices, static_cast<std::uint32_t>(group.vertex_end - group.vertex_begin));
  if (group.material >= 0) primitive["material"] = group.material;
  if (!range.targets.empty()) primitive["targets"] = range.targets;
  return primitive;
}

Json MeshWriter::write_loose(const LooseElements& loose) {
  const std::pair<int, int> rows = ranges_.of(loose);
  const WrittenRange& range = this->range(rows);
  std::vector<std::uint32_t> indices;
  for (const int vertex : loose.vertices) indices.push_back(static_cast<std::uint32_t>(vertex - rows.first));
  Json primitive = {
      {"attributes", range.attributes},
      {"mode", loose.lines ? 1 : 0},
      {"indices", builder_.add_indices(indices, static_cast<std::uint32_t>(rows.second - rows.first))}};
  if (!loose.lines) primitive["attributes"].erase("TANGENT");  // points have no surface
  if (loose.material >= 0) primitive["material"] = loose.material;
  if (!range.targets.empty()) primitive["targets"] = range.targets;
  return primitive;
}

}  // namespace

Json write_meshes(const Character& character, GltfBuilder& builder) {
  Json meshes = Json::array();
  for (std::size_t p = 0; p < character.parts.size(); ++p)
    meshes.push_back(MeshWriter(character, static_cast<int>(p), builder).write());
  return meshes;
}

}  // namespace mien::detail
