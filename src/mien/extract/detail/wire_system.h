#pragma once
/// The normal equations of extraction: made and factored once, solved for every shape.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <span>
#include <vector>

#include "mien/deform/wires.h"

namespace mien::detail {

/// Where the unknowns of the wires are: q has one row a control point; sigma and the turns follow one another wire by wire.
struct WireColumns {
  explicit WireColumns(std::span<const Wire> wires);
  std::vector<int> controls;  ///< per wire: first control point among all
  std::vector<int> coupled;   ///< per wire: its sigma among the coupled basis functions; its turns follow
  std::vector<int> unknowns;  ///< per coupled basis function: its first unknown (sigma has one, a turn three)
  std::vector<int> turns;     ///< per wire: how many turns meet at one vertex, 0 or 4
  int control_count = 0, coupled_count = 0, unknown_count = 0;

  int control_count_of(int wire) const { return end_of(controls, wire, control_count) - controls[wire]; }
  int turn_count_of(int wire) const { return end_of(coupled, wire, coupled_count) - coupled[wire] - 1; }

 private:
  static int end_of(const std::vector<int>& begin, int wire, int end) {
    return wire + 1 < static_cast<int>(begin.size()) ? begin[wire + 1] : end;
  }
};

/// Right-hand sides or solutions of any number of expressions, side by side.
struct WireVectors {
  Eigen::MatrixXd controls;  ///< control_count x 3 #expressions: x, y, z of the first, then of the second ...
  Eigen::MatrixXd coupled;   ///< unknown_count x #expressions
};

/// min sum_i weight_i |(A x - d)_i|^2 + ridge |x|^2, control points and the rest in units of their mean diagonal entries. With q alike on each axis
///   [ M x I3   E ] [ q ]   [ g ]
///   [ E'       D ] [ s ] = [ h ]
/// M = L L' (control points) is factored once for the three axes; sigma and the turns s are eliminated: D - Y'Y, Y = (L x I3)^-1 E.
class WireSystem {
 public:
  ///   weights  per part and row of the field: how much the vertex counts
  WireSystem(const WireField& field, std::span<const Wire> wires, std::vector<std::vector<float>> weights,
             double ridge);

  const WireColumns& columns() const { return columns_; }
  WireVectors zero(Eigen::Index expressions) const;
  /// Adds the displacements of some of a part's rows to one right-hand side.
  ///   rows           of the field
  ///   displacements  #rows x 3, model space
  void add(int part, std::span<const int> rows, const PointsD& displacements, Eigen::Index expression,
           WireVectors& right) const;
  WireVectors solve(const WireVectors& right) const;

 private:
  void factor(Eigen::MatrixXd controls, Eigen::MatrixXd cross, Eigen::MatrixXd coupled, double ridge);
  const WireField& field_;
  WireColumns columns_;
  std::vector<std::vector<float>> weights_;
  Eigen::LLT<Eigen::MatrixXd> controls_, schur_;
  Eigen::MatrixXd eliminated_;  ///< Y, axes one after the other
};

}  // namespace mien::detail
