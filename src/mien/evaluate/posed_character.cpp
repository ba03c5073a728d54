// Skinning of either kind is an affine map for each vertex: what it does to the origin and to the three unit vectors is
// its matrix, and normals go by that matrix's cofactors, which need no inverse and know mirrors.
#include "mien/evaluate/posed_character.h"

#include <array>
#include <cmath>
#include <string>

#include "mien/character/weld.h"
#include "mien/core/error.h"
#include "mien/deform/skin.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/detail/check_pose.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

/// Copies of a vertex count as one where the file's normals agree to this: a hard edge stays hard.
constexpr float same_normal = 1e-3f;

using Linear = std::vector<Eigen::Matrix3d>;

/// What the skin or the node does to directions at each vertex.
Linear linear_maps(const Character& character, const Pose& pose, const Part& part) {
  const auto count = static_cast<Eigen::Index>(part.mesh.vertex_count());
  const auto model = posed_matrices(character, pose);
  Linear maps(part.mesh.vertex_count(), Eigen::Matrix3d::Identity());
  if (part.skin < 0) {
    if (part.node >= 0) maps.assign(maps.size(), model[part.node].topLeftCorner<3, 3>());
    return maps;
  }
  if (part.skin_weights.empty()) return maps;
  const Skin& skin = character.skins[part.skin];
  const auto joints = joint_matrices(skin, model);
  const auto moved = [&](const Eigen::Vector3d& point) {
    return skin_points(PointsD(point.transpose().replicate(count, 1)), part.skin_weights, skin, joints);
  };
  const PointsD origin = moved(Eigen::Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    const PointsD unit = moved(Eigen::Vector3d::Unit(axis)) - origin;
    for (Eigen::Index v = 0; v < count; ++v) maps[static_cast<std::size_t>(v)].col(axis) = unit.row(v);
  }
  return maps;
}

Eigen::Matrix3d cofactors(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
  return result;
}

/// `rows` with the deltas of active shapes, before skinning.
PointsD with_deltas(const Character& character, const Pose& pose, int part, PointsD rows,
                    Points PartDelta::*deltas) {
  Eigen::VectorXd weights(static_cast<Eigen::Index>(character.shapes.size()));
  detail::weights_on_part(pose, part, weights);
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    for (const PartDelta& delta : character.shapes[s].parts)
      for (Eigen::Index r = 0; delta.part == part && r < (delta.*deltas).rows(); ++r)
        rows.row(delta.vertices[static_cast<std::size_t>(r)]) +=
            weights[static_cast<Eigen::Index>(s)] * (delta.*deltas).row(r).cast<double>();
  return rows;
}

Eigen::RowVector3f unit(const Eigen::Vector3d& direction, const Eigen::RowVector3f& otherwise) {
  const double length = direction.norm();
  return length > 0 ? Eigen::RowVector3f((direction / length).transpose().cast<float>()) : otherwise;
}

Points transformed_normals(const Character& character, const Pose& pose, int part, const Linear& maps) {
  const Mesh& mesh = character.parts[part].mesh;
  const PointsD shaped =
      with_deltas(character, pose, part, mesh.normals.cast<double>(), &PartDelta::normal_deltas);
  Points normals = mesh.normals;
  for (Eigen::Index v = 0; v < normals.rows(); ++v)
    normals.row(v) =
        unit(cofactors(maps[static_cast<std::size_t>(v)]) * shaped.row(v).transpose(), normals.row(v));
  return normals;
}

Points4 transformed_tangents(const Character& character, const Pose& pose, int part, const Linear& maps,
                             const Points& normals) {
  const Mesh& mesh = character.parts[part].mesh;
  const PointsD shaped = with_deltas(character, pose, part, mesh.tangents.leftCols<3>().cast<double>(),
                                     &PartDelta::tangent_deltas);
  Points4 tangents = mesh.tangents;
  for (Eigen::Index v = 0; v < tangents.rows(); ++v) {
    Eigen::Vector3d t = maps[static_cast<std::size_t>(v)] * shaped.row(v).transpose();
    if (normals.rows() > 0) {
      const Eigen::Vector3d n = normals.row(v).cast<double>();
      t -= n.dot(t) * n;
    }
    tangents.row(v).head<3>() = unit(t, tangents.row(v).head<3>());
  }
  return tangents;
}

Points recomputed_normals(const Character& character, int part, const Points& posed) {
  const Mesh& mesh = character.parts[part].mesh;
  Weld weld = weld_seams(character, part);
  int count = static_cast<int>(weld.size());
  for (Eigen::Index v = 0; v < mesh.normals.rows(); ++v) {
    int& number = weld.of[static_cast<std::size_t>(v)];
    const int same = weld.representative[static_cast<std::size_t>(number)];
    if ((mesh.normals.row(v) - mesh.normals.row(same)).norm() > same_normal) number = count++;
  }
  Points positions(count, 3);
  for (Eigen::Index v = 0; v < posed.rows(); ++v)
    positions.row(weld.of[static_cast<std::size_t>(v)]) = posed.row(v);
  const Points welded = vertex_normals(positions, triangulate(weld_faces(mesh.faces, weld)));
  Points normals(posed.rows(), 3);
  for (Eigen::Index v = 0; v < posed.rows(); ++v)
    normals.row(v) = welded.row(weld.of[static_cast<std::size_t>(v)]);
  return normals;
}

/// Per vertex, the direction in which u grows along the surface; w says whether v grows along normal x tangent.
Points4 recomputed_tangents(const Mesh& mesh, const Points& posed, const Points& normals) {
  if (mesh.uvs.empty() || !mesh.uvs[0].corners.empty() || normals.rows() == 0) return {};
  const Points2& uv = mesh.uvs[0].coordinates;
  PointsD along_u = PointsD::Zero(posed.rows(), 3), along_v = along_u;
  const Triangles triangles = triangulate(mesh.faces);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const int a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
    const Eigen::RowVector3d p = (posed.row(b) - posed.row(a)).cast<double>(),
                             q = (posed.row(c) - posed.row(a)).cast<double>();
    const Eigen::RowVector2d s = (uv.row(b) - uv.row(a)).cast<double>(),
                             r = (uv.row(c) - uv.row(a)).cast<double>();
    const double sign =
        s.x() * r.y() - s.y() * r.x() < 0 ? -1 : 1;  // of the UV triangle's area; its size would weigh
    for (const int corner : {a, b, c}) {
      along_u.row(corner) += sign * (r.y() * p - s.y() * q);
      along_v.row(corner) += sign * (s.x() * q - r.x() * p);
    }
  }
  Points4 tangents(posed.rows(), 4);
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    const Eigen::Vector3d n = normals.row(v).cast<double>(), u = along_u.row(v);
    const Eigen::Vector3d any = n.unitOrthogonal();
    tangents.row(v).head<3>() = unit(u - n.dot(u) * n, any.transpose().cast<float>());
    tangents(v, 3) = n.cross(u).dot(along_v.row(v)) < 0 ? -1.f : 1.f;
  }
  return tangents;
}

Points normals_of(const Character& character, const Pose& pose, int part, const Points& posed,
                  SurfaceFrames frames, const Linear& maps) {
  if (frames == SurfaceFrames::recomputed) return recomputed_normals(character, part, posed);
  if (frames == SurfaceFrames::transformed && character.parts[part].mesh.normals.rows() > 0)
    return transformed_normals(character, pose, part, maps);
  return {};
}

/// One part's mesh with positions, normals and tangents as posed.
void pose_mesh(const Character& character, const Pose& pose, int part, const Points& posed,
               SurfaceFrames frames, Mesh& mesh) {
  const Mesh& source = character.parts[part].mesh;
  const bool has_normals = source.normals.rows() > 0, has_tangents = source.tangents.rows() > 0;
  const Linear maps = frames == SurfaceFrames::transformed && (has_normals || has_tangents)
                          ? linear_maps(character, pose, character.parts[part])
                          : Linear{};
  mesh.positions = posed;
  mesh.normals.resize(0, 3);
  mesh.tangents.resize(0, 4);
  if (has_normals) mesh.normals = normals_of(character, pose, part, posed, frames, maps);
  if (has_tangents && frames == SurfaceFrames::transformed)
    mesh.tangents = transformed_tangents(character, pose, part, maps, mesh.normals);
  if (has_tangents && frames == SurfaceFrames::recomputed)
    mesh.tangents = recomputed_tangents(source, posed, mesh.normals);
}

}  // namespace

Points posed_normals(const Character& character, const Pose& pose, int part, SurfaceFrames frames) {
  if (part < 0 || part >= static_cast<int>(character.parts.size()))
    throw invalid_input("part " + std::to_string(part), "does not exist",
                        "a part from 0 to " + std::to_string(static_cast<int>(character.parts.size()) - 1));
  const std::vector<Points> posed = evaluate(character, pose);
  const Linear maps =
      frames == SurfaceFrames::transformed ? linear_maps(character, pose, character.parts[part]) : Linear{};
  return normals_of(character, pose, part, posed[part], frames, maps);
}

Character posed_character(const Character& character, const Pose& pose, SurfaceFrames frames) {
  const std::vector<Points> posed = evaluate(character, pose);
  Character still;
  still.name = character.name;
  still.parts = character.parts;
  still.landmarks = character.landmarks;
  still.curves = character.curves;
  still.appearance = character.appearance;
  for (std::size_t p = 0; p < still.parts.size(); ++p) {
    Part& part = still.parts[p];
    pose_mesh(character, pose, static_cast<int>(p), posed[p], frames, part.mesh);
    part.node = part.skin = -1;
    part.skin_weights = {};
  }
  return still;
}

}  // namespace mien
