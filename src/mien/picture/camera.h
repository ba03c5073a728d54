#pragma once
/// Where a still is taken from.

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// Sides of a face that looks along +Z with +Y up. `left` shows the character's left side (+X).
enum class View { front, left, right, three_quarter };

/// "front", "left", "right" or "three-quarter".
///   throws  invalid_input: another name
View view_of_name(std::string_view name);
std::string_view name_of(View view);

/// A pinhole camera; model space.
struct Camera {
  Eigen::Vector3d eye = Eigen::Vector3d(0, 0, 1);
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  double field_of_view = 20;  ///< vertical, degrees; 20 is a portrait lens
};

struct FrameOptions {
  View view = View::front;
  double aspect = 1;     ///< width / height of the picture
  double margin = 0.06;  ///< part of the picture left empty on each side
  /// Model space to a space where the face looks along +Z with +Y up: for faces that stand otherwise.
  Eigen::Matrix3d facing = Eigen::Matrix3d::Identity();
};

/// The camera that holds all `points`.
///   throws  invalid_input: no points, or points that are not finite
Camera frame_points(const Points& points, const FrameOptions& options = {});

/// The camera that holds the head in any of its shapes: everything or, where a body hangs on it, what the
/// shapes move and its surroundings, with room for each shape at weight 1. Framed once in rest, it keeps a
/// row of stills comparable.
///   posed  one #V x 3 a part, model space (`evaluate`)
Camera frame_head(const Character& character, const std::vector<Points>& posed,
                  const FrameOptions& options = {});

}  // namespace mien
