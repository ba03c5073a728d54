#pragma once
/// By what everything that is not skin gets from the source to the target: one set of maps for objects, wires, constraints,
/// controls and clips, so that what belongs together stays together.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/transfer/carry_skeleton.h"
#include "mien/transfer/carry_skin_weights.h"

namespace mien {

struct RigMap {
  SpaceMap space;  ///< places, directions and lengths; the one that joints are placed by
  /// Displacements `moves` (#P x 3, source model space) of the places `at` (#P x 3) as they look on the target, by the rule that
  /// the skin's displacements follow.
  std::function<PointsD(const PointsD& at, const PointsD& moves)> move;
  /// Per-vertex attributes along the correspondence. Linear. Rows are the vertices of all parts, part after part: #V source x
  /// K to #V target x K.
  std::function<WeightMatrix(const WeightMatrix&)> rows;
  /// The same place on the target's skin; nothing where there is none.
  std::function<std::optional<SurfacePoint>(const SurfacePoint&)> surface_point;
  std::vector<int> node_of;                  ///< per source node: its index in the target, -1: not carried
  std::vector<std::vector<int>> skin_joint;  ///< per source skin, per joint: index into the target's one skin
};

/// The first row of each part's vertices in `RigMap::rows`, and behind the last the number of all.
std::vector<int> first_rows(const Character& character);

}  // namespace mien
