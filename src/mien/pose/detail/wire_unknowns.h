#pragma once
/// Wires as unknowns of a drag.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mien/character/character.h"

namespace mien::detail {

/// Three unknowns a control point, one for the scale and three a turn, wire after wire, each 0 at the start. One is a move of a
/// control point by the wire's longest range, a change of the scale by 1, a turn by a radian.
class WireUnknowns {
 public:
  ///   wires  those that may move, each once
  ///   start  what all wires do at the start
  WireUnknowns(const Character& character, std::span<const int> wires, std::vector<WireMove> start);

  int count() const { return static_cast<int>(units_.size()); }

  /// Adds shapes to `character` that move the vertices around `points` alone: first what the wires do at the start, then one for each
  /// unknown. They stand for the wires, which act on the surface where shapes do.
  void add_shapes(const std::vector<SurfacePoint>& points, Character& character) const;

  /// What all wires do: the start's moves, and x on top. Wires that x leaves alone keep the start's numbers.
  std::vector<WireMove> moves(const Eigen::Ref<const Eigen::VectorXd>& x) const;

 private:
  WireMove change(std::size_t wire, const Eigen::Ref<const Eigen::VectorXd>& x) const;
  struct Dragged {
    int wire = 0, first = 0, controls = 0, turns = 0;
  };
  std::vector<Dragged> wires_;
  std::vector<double> units_;
  std::vector<WireMove> start_;
};

}  // namespace mien::detail
