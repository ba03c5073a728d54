#pragma once
/// Faces of any number of shapes, joints and vertices to evaluate, and the same as the arrays that peers take.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "mien/character/sliders.h"
#include "mien/deform/dual_quaternion.h"
#include "mien/deform/skin.h"
#include "mien/io/assemble.h"
#include "peers/evaluate.h"
#include "sphere_face.h"

namespace mien::bench {

using DeltaMap = std::map<int, Eigen::Vector3f>;  // by vertex

inline DeltaMap map_of(const PartDelta& delta) {
  DeltaMap map;
  for (std::size_t r = 0; r < delta.vertices.size(); ++r)
    map[delta.vertices[r]] = delta.deltas.row(static_cast<Eigen::Index>(r));
  return map;
}

inline Shape shape_of(const std::string& name, const DeltaMap& map) {
  PartDelta delta;
  delta.deltas.resize(static_cast<Eigen::Index>(map.size()), 3);
  for (const auto& [vertex, move] : map) {
    delta.deltas.row(static_cast<Eigen::Index>(delta.vertices.size())) = move;
    delta.vertices.push_back(vertex);
  }
  return {name, {delta}};
}

/// ICT-FaceKit's expressions; the noise of their files, below 1e-5 of the box, is taken out.
inline Character ict_face(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".obj" && name.rfind("identity", 0) != 0 && name.rfind("generic", 0) != 0)
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Character face = assemble(folder / "generic_neutral_mesh.obj", files);
  const auto noise = static_cast<float>(1e-5 * bounding_box(face.parts[0].mesh.positions).diagonal());
  for (Shape& shape : face.shapes) {
    DeltaMap map = map_of(shape.parts.at(0));
    std::erase_if(map, [&](const auto& item) { return item.second.norm() < noise; });
    shape = shape_of(shape.name, map);
  }
  return face;
}

/// A sphere the size of ICT's face with 57 round bumps over it.
inline Character procedural_face() {
  const Surface surface = sphere_face(26719, 0);
  Character face;
  face.parts.resize(1);
  Mesh& mesh = face.parts[0].mesh;
  mesh.positions = surface.positions.cast<float>();
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    mesh.faces.push_back({surface.triangles(t, 0), surface.triangles(t, 1), surface.triangles(t, 2)});
  for (int s = 0; s < 57; ++s) {
    const Eigen::RowVector3f centre = mesh.positions.row((s * 4691) % mesh.positions.rows());
    DeltaMap map;
    for (int v = 0; v < static_cast<int>(mesh.vertex_count()); ++v)
      if (const float r = (mesh.positions.row(v) - centre).norm() / 0.07f; r < 1)
        map[v] = (1 - r * r) * 0.2f * centre.transpose();
    face.shapes.push_back(shape_of("bump" + std::to_string(s), map));
  }
  return face;
}

/// The face with as many shapes: what it lacks are sums of two of its own.
inline Character face_of_shapes(std::size_t count) {
  const char* folder = std::getenv("MIEN_ICT");
  Character face = folder ? ict_face(folder) : procedural_face();
  for (std::size_t s = 0; face.shapes.size() < count; ++s) {
    DeltaMap sum = map_of(face.shapes[3 * s].parts[0]);
    for (const auto& [vertex, move] : map_of(face.shapes[3 * s + 1].parts[0]))
      sum.try_emplace(vertex, Eigen::Vector3f::Zero()).first->second += move;
    face.shapes.push_back(shape_of("sum" + std::to_string(s), sum));
  }
  face.sliders.clear();
  complete_sliders(face);
  return face;
}

/// Adds correctives of pairs of shapes until there are `count` shapes: each lives where both of its shapes do.
inline Character with_correctives(const Character& face, std::size_t count) {
  Character rich = face;
  const std::size_t own = face.shapes.size();
  std::vector<DeltaMap> maps;
  for (const Shape& shape : face.shapes) maps.push_back(map_of(shape.parts[0]));
  for (std::size_t apart = 1; apart < own; ++apart)
    for (std::size_t a = 0; a + apart < own && rich.shapes.size() < count; ++a) {
      DeltaMap both;
      for (const auto& [vertex, move] : maps[a])
        if (const auto other = maps[a + apart].find(vertex); other != maps[a + apart].end())
          both[vertex] = 0.3f * (move - other->second);
      if (!both.empty()) rich.shapes.push_back(shape_of("fix" + std::to_string(rich.shapes.size()), both));
    }
  return rich;
}

/// `times` vertices for each of the face's, next to one another and moved alike, as a finer mesh would have them.
inline Character refined(const Character& face, int times) {
  Character fine;
  fine.parts.resize(1);
  const Points& positions = face.parts[0].mesh.positions;
  Points& all = fine.parts[0].mesh.positions;
  all.resize(positions.rows() * times, 3);
  for (Eigen::Index v = 0; v < all.rows(); ++v)
    all.row(v) = positions.row(v / times) * (1 + 1e-4f * static_cast<float>(v % times));
  for (const Shape& shape : face.shapes) {
    PartDelta delta;
    const PartDelta& coarse = shape.parts[0];
    delta.deltas.resize(coarse.deltas.rows() * times, 3);
    for (std::size_t r = 0; r < coarse.vertices.size() * static_cast<std::size_t>(times); ++r) {
      const std::size_t from = r / static_cast<std::size_t>(times);
      delta.vertices.push_back(coarse.vertices[from] * times +
                               static_cast<int>(r % static_cast<std::size_t>(times)));
      delta.deltas.row(static_cast<Eigen::Index>(r)) = coarse.deltas.row(static_cast<Eigen::Index>(from));
    }
    fine.shapes.push_back({shape.name, {delta}});
  }
  return fine;
}

/// `joints` joints spread over the face under one root; each vertex follows its nearest `influences`.
inline Character with_skin(const Character& face, int joints, int influences) {
  Character skinned = face;
  const Points& positions = face.parts[0].mesh.positions;
  const double size = bounding_box(positions).diagonal();
  Skin skin;
  skin.name = "skin";
  skinned.nodes.assign(1, Node{});
  skinned.nodes[0].name = "root";
  for (int j = 0; j < joints; ++j) {
    Node node;
    node.name = "joint" + std::to_string(j);
    node.parent = 0;
    node.rest.translation = positions.row((j * 7919) % positions.rows()).cast<double>();
    skinned.nodes.push_back(node);
    skin.joints.push_back(j + 1);
    skin.inverse_bind.push_back(node.rest.matrix().inverse());
  }
  skinned.skins = {skin};
  skinned.parts[0].skin = 0;
  SkinWeights& weights = skinned.parts[0].skin_weights;
  weights = {{0}, {}, {}};
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    std::vector<std::pair<double, int>> near;
    for (int j = 0; j < joints; ++j)
      near.push_back(
          {(skinned.nodes[j + 1].rest.translation - positions.row(v).transpose().cast<double>()).norm(), j});
    std::partial_sort(near.begin(), near.begin() + influences, near.end());
    double total = 0;
    for (int i = 0; i < influences; ++i) total += std::exp(-std::pow(near[i].first / (0.1 * size), 2));
    for (int i = 0; i < influences; ++i) {
      weights.joints.push_back(near[i].second);
      weights.weights.push_back(
          std::max(1e-6f, static_cast<float>(std::exp(-std::pow(near[i].first / (0.1 * size), 2)) / total)));
    }
    weights.offsets.push_back(static_cast<int>(weights.joints.size()));
  }
  return skinned;
}

inline Pose joint_pose(const Character& skinned) {
  Pose pose = rest_pose(skinned);
  const double size = bounding_box(skinned.parts[0].mesh.positions).diagonal();
  for (std::size_t n = 1; n < pose.locals.size(); ++n) {
    const double phase = static_cast<double>(n);
    pose.locals[n].rotation = Eigen::AngleAxisd(
        0.3 * std::sin(phase), Eigen::Vector3d(std::cos(phase), std::sin(2 * phase), 0.3).normalized());
    pose.locals[n].translation += 0.01 * size * Eigen::Vector3d(std::sin(3 * phase), std::cos(phase), 0);
  }
  return pose;
}

/// Shapes as dense columns and as lists.
struct DenseFace {
  std::vector<float> neutral, deltas, sparse_deltas;
  std::vector<int> begin{0}, vertices;
  explicit DenseFace(const Character& face) {
    const Points& positions = face.parts[0].mesh.positions;
    neutral.assign(positions.data(), positions.data() + positions.size());
    deltas.assign(neutral.size() * face.shapes.size(), 0.f);
    for (std::size_t s = 0; s < face.shapes.size(); ++s) {
      const PartDelta& delta = face.shapes[s].parts[0];
      for (std::size_t r = 0; r < delta.vertices.size(); ++r)
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
          const float move = delta.deltas(static_cast<Eigen::Index>(r), axis);
          deltas[s * neutral.size() + 3 * static_cast<std::size_t>(delta.vertices[r]) +
                 static_cast<std::size_t>(axis)] = move;
          sparse_deltas.push_back(move);
        }
      vertices.insert(vertices.end(), delta.vertices.begin(), delta.vertices.end());
      begin.push_back(static_cast<int>(vertices.size()));
    }
  }
  SparseShapes sparse() const {
    return {begin.data(), vertices.data(), sparse_deltas.data(), static_cast<int>(begin.size()) - 1};
  }
};

/// A skinned face in a pose as arrays.
struct PeerSkin {
  std::vector<float> points, matrices, quaternions;
  const SkinWeights& weights;
  int count;
  PeerSkin(const Character& skinned, const Pose& pose, int influences)
      : weights(skinned.parts[0].skin_weights), count(influences) {
    const Points& positions = skinned.parts[0].mesh.positions;
    points.assign(positions.data(), positions.data() + positions.size());
    for (const Eigen::Matrix4d& joint : joint_matrices(skinned.skins[0], model_matrices(skinned, pose))) {
      for (int k = 0; k < 12; ++k) matrices.push_back(static_cast<float>(joint(k / 4, k % 4)));
      const StretchedMotion motion = split_motion(joint);
      const DualQuaternion q = dual_quaternion(motion.rotation, motion.translation);
      for (const double x : q.real) quaternions.push_back(static_cast<float>(x));
      for (const double x : q.dual) quaternions.push_back(static_cast<float>(x));
    }
  }
  Influences influences() const { return {weights.joints.data(), weights.weights.data(), count}; }
};

}  // namespace mien::bench
