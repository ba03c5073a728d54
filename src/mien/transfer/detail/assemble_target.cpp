#include "mien/transfer/detail/assemble_target.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <map>

#include "mien/texture/texture.h"
#include "mien/transfer/detail/at.h"

namespace mien::detail {
namespace {

void bake_into_model_space(Part& part, const Eigen::Matrix4d& matrix) {
  if (matrix.isIdentity(0)) return;
  Mesh& mesh = part.mesh;
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d normal_matrix = linear.inverse().transpose();
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    const Eigen::Vector3d local = mesh.positions.row(v).transpose().cast<double>();
    mesh.positions.row(v) = (matrix * local.homogeneous()).head<3>().transpose().cast<float>();
  }
  for (Eigen::Index v = 0; v < mesh.normals.rows(); ++v) {
    const Eigen::Vector3d normal = normal_matrix * mesh.normals.row(v).transpose().cast<double>();
    if (normal.norm() > 0) mesh.normals.row(v) = normal.normalized().transpose().cast<float>();
  }
  for (Eigen::Index v = 0; v < mesh.tangents.rows(); ++v) {
    const Eigen::Vector3d tangent = linear * mesh.tangents.row(v).head<3>().transpose().cast<double>();
    if (tangent.norm() > 0) mesh.tangents.row(v).head<3>() = tangent.normalized().transpose().cast<float>();
  }
}

/// A node for every part, none above it.
void give_root_nodes(const Character& target, Character& result) {
  result.nodes.clear();
  for (Part& part : result.parts) {
    Node node;
    node.name = part.node >= 0 ? target.nodes[at(part.node)].name : part.name;
    if (part.node >= 0) node.carried = target.nodes[at(part.node)].carried;
    part.node = static_cast<int>(result.nodes.size());
    result.nodes.push_back(std::move(node));
  }
}

/// The nodes that hold parts, and their ancestors, in order.
void keep_holding_nodes(const Character& target, Character& result) {
  std::vector<char> keep(target.nodes.size(), 0);
  for (const Part& part : target.parts)
    for (int n = part.node; n >= 0 && !keep[at(n)]; n = target.nodes[at(n)].parent) keep[at(n)] = 1;
  std::vector<int> index(target.nodes.size(), -1);
  result.nodes.clear();
  for (std::size_t n = 0; n < target.nodes.size(); ++n) {
    if (!keep[n]) continue;
    index[n] = static_cast<int>(result.nodes.size());
    result.nodes.push_back(target.nodes[n]);
  }
  for (Node& node : result.nodes)
    if (node.parent >= 0) node.parent = index[at(node.parent)];
  for (Part& part : result.parts)
    if (part.node >= 0) part.node = index[at(part.node)];
}

}  // namespace

Character bare_target(const Character& target, const Pool& pool, bool skinned) {
  Character result = target;
  result.shapes.clear();
  result.sliders.clear();
  result.correctives.clear();
  result.expressions.clear();
  result.clips.clear();
  result.skins.clear();
  result.wires.clear();
  result.objects.clear();
  result.constraints.clear();
  result.controls.clear();
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    result.parts[p].skin = -1;
    result.parts[p].skin_weights = {};
    if (skinned) bake_into_model_space(result.parts[p], pool.part_matrix[p]);
  }
  if (skinned)
    give_root_nodes(target, result);
  else
    keep_holding_nodes(target, result);
  return result;
}

Shape shape_of_target(const Shape& source, const Pool& pool, const Character& character,
                      const PointsD& displacement, double least) {
  Shape shape{source.name, {}};
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const bool in_node = character.parts[p].skin < 0 && character.skins.empty();
    const Eigen::Matrix3d to_part = in_node
                                        ? Eigen::Matrix3d(pool.part_matrix[p].topLeftCorner<3, 3>().inverse())
                                        : Eigen::Matrix3d::Identity();
    PartDelta delta;
    delta.part = static_cast<int>(p);
    const auto& welded = pool.welded[p];
    for (std::size_t v = 0; v < welded.size(); ++v)
      if (displacement.row(welded[v]).norm() > least) delta.vertices.push_back(static_cast<int>(v));
    delta.deltas.resize(static_cast<Eigen::Index>(delta.vertices.size()), 3);
    for (std::size_t i = 0; i < delta.vertices.size(); ++i)
      delta.deltas.row(static_cast<Eigen::Index>(i)) =
          (to_part * displacement.row(welded[at(delta.vertices[i])]).transpose()).transpose().cast<float>();
    if (!delta.vertices.empty()) shape.parts.push_back(std::move(delta));
  }
  if (shape.parts.empty()) shape.parts.push_back({0, {}, Points(0, 3), {}, {}});
  return shape;
}

int flipped_triangles(const Surface& surface, const PointsD& deltas) {
  int count = 0;
  std::vector<char> moves(static_cast<std::size_t>(deltas.rows()));
  for (Eigen::Index v = 0; v < deltas.rows(); ++v)
    moves[static_cast<std::size_t>(v)] = deltas.row(v).squaredNorm() > 0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const auto& corners = surface.triangles.row(t);
    if (!moves[at(corners[0])] && !moves[at(corners[1])] && !moves[at(corners[2])]) continue;
    const auto normal = [&](bool moved) {
      Eigen::Vector3d corner[3];
      for (int k = 0; k < 3; ++k) {
        corner[k] = surface.positions.row(surface.triangles(t, k)).transpose();
        if (moved) corner[k] += deltas.row(surface.triangles(t, k)).transpose();
      }
      return Eigen::Vector3d((corner[1] - corner[0]).cross(corner[2] - corner[0]));
    };
    count += normal(false).dot(normal(true)) < 0;
  }
  return count;
}

WeightMatrix pooled_skin_weights(const Character& source, const Pool& pool, const JointList& joints) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < pool.first_copy.size(); ++v) {
    const auto [p, vertex] = pool.first_copy[v];
    const Part& part = source.parts[at(p)];
    const int row = static_cast<int>(v);
    if (part.skin < 0) {
      const int node = holding_joint(source, part);
      if (node >= 0) entries.emplace_back(row, joints.joint_of_node[at(node)], 1.0);
      continue;
    }
    if (part.skin_weights.empty()) continue;
    double sum = 0;
    const int begin = part.skin_weights.offsets[at(vertex)], end = part.skin_weights.offsets[at(vertex) + 1];
    for (int i = begin; i < end; ++i) sum += part.skin_weights.weights[at(i)];
    for (int i = begin; i < end && sum > 0; ++i)
      entries.emplace_back(row, joints.skin_joint[at(part.skin)][at(part.skin_weights.joints[at(i)])],
                           part.skin_weights.weights[at(i)] / sum);
  }
  WeightMatrix weights(static_cast<Eigen::Index>(pool.first_copy.size()),
                       static_cast<Eigen::Index>(joints.nodes.size()));
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

WeightMatrix select_rows(const WeightMatrix& matrix, const std::vector<int>& rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (WeightMatrix::InnerIterator entry(matrix, rows[r]); entry; ++entry)
      entries.emplace_back(static_cast<int>(r), static_cast<int>(entry.col()), entry.value());
  WeightMatrix result(static_cast<Eigen::Index>(rows.size()), matrix.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void assign_uvs(const UvLayout& source, const PointsD& guide, const Pool& pool, const PoolSurface& skin,
                int part, Mesh& mesh) {
  Faces skin_faces;
  std::vector<char> is_skin(mesh.faces.size(), 0);
  bool any = false;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    is_skin[f] = !mesh.faces[f].empty() && skin.row_of[at(pool.welded[at(part)][at(mesh.faces[f][0])])] >= 0;
    any = any || is_skin[f];
    if (is_skin[f]) skin_faces.push_back(mesh.faces[f]);
  }
  if (!any) return;
  PointsD positions(mesh.positions.rows(), 3);
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
    positions.row(v) = pool.positions.row(pool.welded[at(part)][static_cast<std::size_t>(v)]);
  const UvSet carried = carry_uvs(source, guide, positions, skin_faces);
  UvSet set;
  set.coordinates = carried.coordinates;
  set.corners.assign(mesh.faces.corner_count(), -1);
  std::size_t next = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < mesh.faces[f].size() && is_skin[f]; ++c)
      set.corners[at(mesh.faces.offset(f)) + c] = carried.corners[next++];
  mesh.uvs.assign(1, std::move(set));
}

int skin_material(const Character& source, const Pool& pool, const PoolSurface& skin) {
  std::map<int, std::size_t> count;
  for (const int t : skin.triangles)
    for (const FaceGroup& group : source.parts[at(pool.triangle_part[at(t)])].mesh.groups)
      if (pool.triangle_face[at(t)] >= group.face_begin && pool.triangle_face[at(t)] < group.face_end)
        ++count[group.material];
  int best = -1;
  std::size_t most = 0;
  for (const auto& [material, triangles] : count)
    if (triangles > most && texture_of(source, material, TextureSlot::base_color)) {
      best = material;
      most = triangles;
    }
  return best;
}

void hang_material(int material, const Appearance& looks, Mesh& mesh) {
  const UvSet& uv = mesh.uvs.front();
  const auto has_uvs = [&](int f) {
    return uv.corners.empty() || uv.corners[at(mesh.faces.offset(at(f)))] >= 0;
  };
  const int faces = static_cast<int>(mesh.faces.size());
  if (mesh.groups.empty()) {
    for (int f = 0; f < faces; ++f) {
      const int wanted = has_uvs(f) ? material : -1;
      if (mesh.groups.empty() || mesh.groups.back().material != wanted)
        mesh.groups.push_back({"", wanted, f, f, 0, static_cast<int>(mesh.vertex_count())});
      mesh.groups.back().face_end = f + 1;
    }
    return;
  }
  for (FaceGroup& group : mesh.groups) {
    int with = 0;
    for (int f = group.face_begin; f < group.face_end; ++f) with += has_uvs(f);
    const bool plain = group.material < 0 || looks.materials[at(group.material)].carried.empty();
    if (plain && 2 * with > group.face_end - group.face_begin) group.material = material;
  }
}

}  // namespace mien::detail
