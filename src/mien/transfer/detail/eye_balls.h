#pragma once
/// Lids lie on the eyes: carried displacements may not sink them in.

#include <vector>

#include "mien/transfer/detail/inner_pieces.h"

namespace mien::detail {

struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// The least-squares sphere of every target piece that is an eye and round (rms distance from it below 8 % of its radius).
std::vector<Ball> eye_balls(const PieceInput& input, const std::vector<PiecePlan>& plans);

/// Pushes displaced skin out of the eyes along their radii: to 1.5 % of the radius above the ball, or to where it lay in
/// the neutral if that was closer. Skin that lay inside stays as it is.
///   positions, deltas  #V x 3, target model space; `deltas` is changed
void keep_out_of_eyes(const std::vector<Ball>& balls, const PointsD& positions, PointsD& deltas);

}  // namespace mien::detail
