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

/// The arrays of one vertex range, written once and shared by all primitives that use it.
struct WrittenRange {
  Json attributes;
  Json targets = Json::array();
};

class MeshWriter {
 public:
  MeshWriter(const Character& character, int part, GltfBuilder& builder)
      : character_(character),
        part_index_(part),
        part_(character.parts[part]),
        builder_(builder),
        split_(split_seams(part_.mesh)),
        normals_(normals_of(part_.mesh)),
        precision_{builder_error * bounding_box(part_.mesh.positions).diagonal()} {}
  Json write();

 private:
  static constexpr double builder_error = 1e-5 / 1.7321;  // a component's share of 1e-5 of the box
  WrittenRange write_range(int begin, int end);
  void write_influences(int begin, int end, Json& attributes);
  void write_targets(int begin, int end, Json& targets);
  Json write_primitive(const FaceGroup& group, const WrittenRange& range, int first_row, int rows);

  const Character& character_;
  int part_index_;
  const Part& part_;
  GltfBuilder& builder_;
  SplitMesh split_;
  Points normals_;
  Precision precision_;
};

Json MeshWriter::write() {
  Json mesh = carried_json(part_.carried, fmt::format("part {}: carried", part_.name));
  const Json carried_primitives = mesh.value("primitives", Json::array());
  mesh["primitives"] = Json::array();
  std::vector<std::pair<std::pair<int, int>, WrittenRange>> written;
  for (const FaceGroup& group : primitive_groups(part_.mesh, split_)) {
    const std::pair<int, int> key(group.vertex_begin, group.vertex_end);
    auto found = std::find_if(written.begin(), written.end(), [&](const auto& w) { return w.first == key; });
    if (found == written.end())
      found = written.insert(written.end(), {key, write_range(key.first, key.second)});
    Json primitive = write_primitive(group, found->second, key.first, key.second - key.first);
    const std::size_t number = mesh["primitives"].size();
    if (number < carried_primitives.size() && carried_primitives[number].is_object())
      primitive.update(carried_primitives[number]);
    mesh["primitives"].push_back(std::move(primitive));
  }
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
  Json vendor =
      vendor_mesh(part_.mesh, split_, part_.mesh.normals.rows() != part_.mesh.positions.rows(), builder_);
  write_surface(part_, vendor);
  if (!vendor.empty()) vendor["vertexCount"] = split_.vertex_count;
  if (!vendor.empty()) mesh["extensions"][vendor_extension] = vendor;
  return mesh;
}

WrittenRange MeshWriter::write_range(int begin, int end) {
  WrittenRange range;
  const Mesh& mesh = part_.mesh;
  range.attributes["POSITION"] =
      builder_.add_attribute(flat(rows_of(mesh.positions, split_, begin, end)), 3, precision_, true);
  constexpr Precision direction{1.0 / 65536}, color{1.0 / 1024}, uv{1.0 / 131072};
  range.attributes["NORMAL"] =
      builder_.add_attribute(flat(rows_of(normals_, split_, begin, end)), 3, direction);
  if (mesh.tangents.rows() == mesh.positions.rows() && mesh.tangents.rows() > 0)
    range.attributes["TANGENT"] =
        builder_.add_attribute(flat(rows_of(mesh.tangents, split_, begin, end)), 4, direction);
  for (std::size_t set = 0; set < split_.uvs.size(); ++set) {
    Points2 flipped = split_.uvs[set].middleRows(begin, end - begin);
    flipped.col(1) = 1.f - flipped.col(1).array();
    range.attributes[fmt::format("TEXCOORD_{}", set)] = builder_.add_attribute(flat(flipped), 2, uv);
  }
  for (std::size_t set = 0; set < mesh.colors.size(); ++set)
    range.attributes[fmt::format("COLOR_{}", set)] =
        builder_.add_attribute(flat(rows_of(mesh.colors[set], split_, begin, end)), 4, color);
  if (part_.skin >= 0 && !part_.skin_weights.empty()) write_influences(begin, end, range.attributes);
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
  const bool narrow = character_.skins[part_.skin].joints.size() <= 256;
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

Json MeshWriter::write_primitive(const FaceGroup& group, const WrittenRange& range, int first_row, int rows) {
  std::vector<std::uint32_t> indices;
  for (int f = group.face_begin; f < group.face_end; ++f) {
    const int first = part_.mesh.faces.offset(f), size = static_cast<int>(part_.mesh.faces[f].size());
    for (int c = 2; c < size; ++c)
      for (const int corner : {0, c - 1, c})
        indices.push_back(static_cast<std::uint32_t>(split_.corner_row[first + corner] - first_row));
  }
  Json primitive = {{"attributes", range.attributes}};
  if (indices.empty())
    primitive["mode"] = 0;  // points: glTF has no triangles without corners
  else
    primitive["indices"] = builder_.add_triangles(indices, static_cast<std::uint32_t>(rows));
  if (group.material >= 0) primitive["material"] = group.material;
  if (!range.targets.empty()) primitive["targets"] = range.targets;
  return primitive;
}

std::uint64_t bits_of(const Points2& coordinates, int row) {
  std::uint64_t bits = 0;
  if (row >= 0) std::memcpy(&bits, coordinates.data() + 2 * row, sizeof bits);
  return bits;
}

}  // namespace

SplitMesh split_seams(const Mesh& mesh) {
  SplitMesh split;
  split.vertex_count = static_cast<int>(mesh.vertex_count());
  split.corner_row = mesh.faces.corners();
  std::vector<std::size_t> cornered;  // UV sets that have a coordinate a corner
  for (std::size_t set = 0; set < mesh.uvs.size(); ++set)
    if (!mesh.uvs[set].corners.empty()) cornered.push_back(set);
  // Corners of a vertex are told apart by the bits of their UVs, so that equal coordinates never split a
  // vertex.
  const auto bits = [&](std::size_t corner) {
    std::vector<std::uint64_t> key{static_cast<std::uint64_t>(mesh.faces.corners()[corner])};
    for (const std::size_t set : cornered)
      key.push_back(bits_of(mesh.uvs[set].coordinates, mesh.uvs[set].corners[corner]));
    return key;
  };
  std::vector<int> corner_of_row(split.vertex_count, -1);
  std::map<std::vector<std::uint64_t>, int> copies;
  for (std::size_t c = 0; c < split.corner_row.size() && !cornered.empty(); ++c) {
    const int vertex = split.corner_row[c];
    if (corner_of_row[vertex] < 0) corner_of_row[vertex] = static_cast<int>(c);
    const std::vector<std::uint64_t> key = bits(c);
    if (key == bits(corner_of_row[vertex])) continue;
    const auto [copy, is_new] = copies.emplace(key, split.rows());
    if (is_new) {
      split.copy_of.push_back(vertex);
      corner_of_row.push_back(static_cast<int>(c));
    }
    split.corner_row[c] = copy->second;
  }
  for (const UvSet& uv : mesh.uvs) {
    Points2 rows = Points2::Zero(split.rows(), 2);
    for (int r = 0; r < split.rows(); ++r) {
      const int from = uv.corners.empty()      ? split.vertex_of(r)
                       : corner_of_row[r] >= 0 ? uv.corners[corner_of_row[r]]
                                               : -1;
      if (from >= 0) rows.row(r) = uv.coordinates.row(from);
    }
    split.uvs.push_back(std::move(rows));
  }
  return split;
}

std::vector<FaceGroup> primitive_groups(const Mesh& mesh, const SplitMesh& split) {
  FaceGroup whole;
  whole.face_end = static_cast<int>(mesh.faces.size());
  whole.vertex_end = split.rows();
  if (mesh.groups.empty()) return {whole};
  bool own_ranges = split.copy_of.empty();
  for (const FaceGroup& group : mesh.groups)
    for (int f = group.face_begin; own_ranges && f < group.face_end; ++f)
      for (const int v : mesh.faces[f])
        own_ranges = own_ranges && v >= group.vertex_begin && v < group.vertex_end;
  std::vector<FaceGroup> primitives;
  for (FaceGroup group : mesh.groups) {
    if (group.face_begin == group.face_end) continue;
    if (!own_ranges) group.vertex_begin = 0, group.vertex_end = split.rows();
    FaceGroup* last = primitives.empty() ? nullptr : &primitives.back();
    // Named groups are the artist's; the extension keeps them, and one primitive a material draws faster.
    const bool merge = last && !(last->name.empty() && group.name.empty()) &&
                       last->material == group.material && last->vertex_begin == group.vertex_begin &&
                       last->vertex_end == group.vertex_end;
    if (!merge) {
      primitives.push_back(group);
    } else {
      last->face_end = group.face_end;
      if (last->name.empty()) last->name = group.name;
    }
  }
  return primitives.empty() ? std::vector<FaceGroup>{whole} : primitives;
}

Json write_meshes(const Character& character, GltfBuilder& builder) {
  Json meshes = Json::array();
  for (std::size_t p = 0; p < character.parts.size(); ++p)
    meshes.push_back(MeshWriter(character, static_cast<int>(p), builder).write());
  return meshes;
}

}  // namespace mien::detail
