#include <algorithm>
#include <cstring>
#include <map>

#include "mien/io/detail/gltf_write.h"

// glTF knows one row of attributes a vertex and no faces of more than three corners: what a part's vertices and faces become.

namespace mien::detail {
namespace {

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

VertexRanges::VertexRanges(const Mesh& mesh, const SplitMesh& split) : rows_(split.rows()) {
  if (split.copy_of.empty() && !mesh.faces.empty() && follow_groups(mesh) && fits(mesh)) return;
  ranges_ = {{0, rows_}};
  faces_.clear();
  if (!mesh.faces.empty()) faces_ = ranges_;
}

/// The ranges of the groups, and what comes after them. False: they do not follow one another, as they will when read.
bool VertexRanges::follow_groups(const Mesh& mesh) {
  int next = 0;
  for (const FaceGroup& group : mesh.groups) {
    if (group.face_begin == group.face_end || faces_.contains({group.vertex_begin, group.vertex_end}))
      continue;
    if (group.vertex_begin != next || group.vertex_end > rows_) return false;
    faces_.emplace(group.vertex_begin, group.vertex_end);
    next = group.vertex_end;
  }
  ranges_ = faces_;
  if (next < rows_) ranges_.emplace(next, rows_);
  return true;
}

/// Whether each face and each loose element stays in one range, and no range is left without any.
bool VertexRanges::fits(const Mesh& mesh) const {
  std::set<std::pair<int, int>> used = faces_;
  for (const LooseElements& loose : mesh.loose) {
    const auto range = of(loose);
    for (const int v : loose.vertices)
      if (v < range.first || v >= range.second) return false;
    used.insert(range);
  }
  for (const FaceGroup& group : mesh.groups)
    for (int f = group.face_begin; f < group.face_end; ++f)
      for (const int v : mesh.faces[f])
        if (v < group.vertex_begin || v >= group.vertex_end) return false;
  return used == ranges_;
}

std::pair<int, int> VertexRanges::of(const LooseElements& loose) const {
  auto after = ranges_.upper_bound({loose.vertices.front(), rows_ + 1});
  return after == ranges_.begin() ? *after : *std::prev(after);
}

std::vector<FaceGroup> primitive_groups(const Mesh& mesh, const SplitMesh& split) {
  if (mesh.faces.empty() && !mesh.loose.empty()) return {};
  FaceGroup whole;
  whole.face_end = static_cast<int>(mesh.faces.size());
  whole.vertex_end = split.rows();
  if (mesh.groups.empty()) return {whole};
  const VertexRanges ranges(mesh, split);
  std::vector<FaceGroup> primitives;
  for (FaceGroup group : mesh.groups) {
    if (group.face_begin == group.face_end) continue;
    if (!ranges.has_faces(group.vertex_begin, group.vertex_end))
      group.vertex_begin = 0, group.vertex_end = split.rows();
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

}  // namespace mien::detail
