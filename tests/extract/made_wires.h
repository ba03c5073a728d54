#pragma once
/// What the tests of extraction share.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "mien/core/error.h"
#include "mien/extract/draw_wires.h"
#include "mien/sample/sample.h"

namespace mien::test {

inline const Character& human() {
  static const Character character = make_sample("human");
  return character;
}

inline const std::vector<Wire>& human_wires() {
  static const std::vector<Wire> wires = draw_wires(human(), face_wire_sketches(human(), 15));
  return wires;
}

template <typename Run>
std::string text_of_error(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Smooth moves of all wires, different ones each.
inline std::vector<WireMove> some_moves(const std::vector<Wire>& wires) {
  std::vector<WireMove> moves;
  for (std::size_t w = 0; w < wires.size(); ++w) {
    WireMove move;
    move.wire = static_cast<int>(w);
    const double size = 0.1 * wires[w].ranges[0];
    move.controls.resize(wires[w].curve.control_count(), 3);
    for (Eigen::Index l = 0; l < move.controls.rows(); ++l)
      for (int k = 0; k < 3; ++k) move.controls(l, k) = size * std::sin(1.0 + l + 2.0 * k + 3.0 * w);
    move.scale = 0.1 * std::cos(static_cast<double>(w));
    move.turns = PointsD::Zero(wires[w].turn_controls, 3);
    for (Eigen::Index t = 0; t < move.turns.rows(); ++t)
      for (int k = 0; k < 3; ++k) move.turns(t, k) = 0.2 * std::cos(1.0 + t + k + 2.0 * w);
    moves.push_back(std::move(move));
  }
  return moves;
}

/// Scaled, turned and moved as a whole: neutral, shapes and nodes.
inline Character moved_character(const Character& character, double scale) {
  Character moved = character;
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(0.7f, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix() *
      static_cast<float>(scale);
  for (Part& part : moved.parts) {
    part.mesh.positions = part.mesh.positions * turn.transpose();
    part.mesh.positions.rowwise() += Eigen::RowVector3f(1, -2, 3) * static_cast<float>(scale);
    part.mesh.normals.resize(0, 3);
    part.skin = -1;
    part.node = -1;
    part.skin_weights = {};
  }
  for (Shape& shape : moved.shapes)
    for (PartDelta& delta : shape.parts) {
      delta.deltas = Points(delta.deltas * turn.transpose());
      delta.normal_deltas.resize(0, 3);
    }
  return moved;
}

}  // namespace mien::test
