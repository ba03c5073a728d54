#pragma once
/// Poses in which influence objects move, as the reference evaluates them.

#include <memory>
#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien::detail {

/// Objects that rest cost a comparison of matrices and the blocks do the rest. One that moves may turn its vertices about a frame,
/// wherever shapes put them, which the blocks have no place for: then the whole pose goes through `evaluate`, which is right and slow.
class MovingObjects {
 public:
  ///   vertices  by part, those wanted, in their order; empty: all
  MovingObjects(const Character& character, const std::vector<std::vector<int>>& vertices);

  ///   throws  invalid_input: as `evaluate`
  bool move(const Pose& pose) const;

  /// Positions as rows of the wanted vertices, or in blocks of 16 lanes when `blocks` is given.
  ///   lane_rows  the row of each lane, -1: padding
  void evaluate(const Pose& pose, std::span<const std::int32_t> lane_rows, float* blocks, float* rows) const;

 private:
  struct Prepared;
  std::shared_ptr<const Prepared> prepared_;  ///< of characters with objects
};

}  // namespace mien::detail
