#pragma once
// A small face in code: a grid of quads with smooth local shapes, a slider each; correctives, in-betweens and a jaw joint on
// request.

#include <cmath>
#include <random>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/character/sliders.h"
#include "mien/evaluate/evaluate.h"

namespace mien::test {

constexpr int grid = 12;

inline Shape bump(const Character& face, const std::string& name, const Eigen::Vector2d& at,
                  const Eigen::Vector3d& move) {
  Shape shape{name, {PartDelta{}}};
  const Points& points = face.parts[0].mesh.positions;
  std::vector<Eigen::Vector3f> deltas;
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const double far = (points.row(v).head<2>().cast<double>().transpose() - at).squaredNorm();
    if (far > 0.5) continue;
    shape.parts[0].vertices.push_back(static_cast<int>(v));
    deltas.push_back((std::exp(-6 * far) * move).cast<float>());
  }
  shape.parts[0].deltas.resize(static_cast<Eigen::Index>(deltas.size()), 3);
  for (std::size_t i = 0; i < deltas.size(); ++i)
    shape.parts[0].deltas.row(static_cast<Eigen::Index>(i)) = deltas[i].transpose();
  return shape;
}

inline Character small_face(int shapes) {
  Character face;
  face.parts.resize(1);
  face.parts[0].name = "Face";
  Mesh& mesh = face.parts[0].mesh;
  mesh.positions.resize(grid * grid, 3);
  for (int r = 0; r < grid; ++r)
    for (int c = 0; c < grid; ++c) {
      const double x = 2.0 * c / (grid - 1) - 1, y = 2.0 * r / (grid - 1) - 1;
      mesh.positions.row(r * grid + c) = Eigen::RowVector3d(x, y, 0.5 - 0.3 * (x * x + y * y)).cast<float>();
      if (r + 1 < grid && c + 1 < grid)
        mesh.faces.push_back({r * grid + c, r * grid + c + 1, (r + 1) * grid + c + 1, (r + 1) * grid + c});
    }
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int s = 0; s < shapes; ++s) {
    const Eigen::Vector2d at(uniform(random), uniform(random));
    const Eigen::Vector3d move(uniform(random), uniform(random), uniform(random));
    face.shapes.push_back(bump(face, "shape" + std::to_string(s), at, 0.2 * move));
  }
  complete_sliders(face);
  return face;
}

/// `count` product, smallest and smooth correctives of two sliders each, and an in-between on the first slider.
inline void add_correctives(Character& face, int count) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int sliders = static_cast<int>(face.sliders.size());
  for (int c = 0; c < count; ++c) {
    const Eigen::Vector2d at(uniform(random), uniform(random));
    const Eigen::Vector3d move(uniform(random), uniform(random), uniform(random));
    face.shapes.push_back(bump(face, "corrective" + std::to_string(c), at, 0.08 * move));
    const int a = c % sliders, b = (a + 1 + c / sliders) % sliders;
    face.correctives.push_back(
        {static_cast<int>(face.shapes.size()) - 1, static_cast<CorrectiveRule>(c % 3), {{a, 1}, {b, 1}}});
  }
  face.shapes.push_back(bump(face, "half", {0.2, 0.1}, {0, 0.1, 0.05}));
  face.sliders[0].stops = {{0.5, static_cast<int>(face.shapes.size()) - 1}, {1, 0}};
}

/// A joint at the grid's lower edge that carries its lower half.
inline void add_jaw(Character& face) {
  face.nodes.resize(2);
  face.nodes[0].name = "head";
  face.nodes[1].name = "jaw";
  face.nodes[1].parent = 0;
  face.nodes[1].rest.translation = {0, 0, -0.5};
  face.skins.resize(1);
  face.skins[0].joints = {0, 1};
  face.skins[0].inverse_bind = {Eigen::Matrix4d::Identity(), face.nodes[1].rest.matrix().inverse()};
  Part& part = face.parts[0];
  part.skin = 0;
  part.skin_weights.offsets = {0};
  for (Eigen::Index v = 0; v < part.mesh.positions.rows(); ++v) {
    const int joint = part.mesh.positions(v, 1) < 0 ? 1 : 0;
    part.skin_weights.joints.push_back(joint);
    part.skin_weights.weights.push_back(1);
    part.skin_weights.offsets.push_back(static_cast<int>(v) + 1);
  }
}

inline Pin pin_at(int vertex, const Eigen::Vector3d& move) {
  Pin pin;
  SurfacePoint point;
  point.vertex = vertex;
  pin.at = point;
  pin.goal = move;
  pin.goal_is_move = true;
  return pin;
}

inline Eigen::Vector3d vertex_at(const Character& face, const RigPose& pose, int vertex) {
  return evaluate(face, pose_of(face, pose))[0].row(vertex).transpose().cast<double>();
}

}  // namespace mien::test
