#pragma once
/// The normal equations of extraction: made and factored once, solved for every shape.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "mien/deform/wires.h"

namespace mien::detail {

/// Where the unknowns of the wires are: q has one row a control point; sigma and the turns follow one another wire by wire.
struct WireColumns {
  explicit WireColumns(std::span<const Wire> wires);
  std::vector<int> controls;  ///< per wire: first control point among all
  std::vector<int> coupled;   ///< per wire: its sigma among the coupled basis functions; its turns follow
  std::vector<int> unknowns;  ///< per coupled basis function: its first unknown (sigma has one, a turn three)
  int control_count = 0, coupled_count = 0, unknown_count = 0;
};

/// One expression's right-hand side or solution.
struct WireVector {
  PointsD controls;         ///< control_count x 3
  Eigen::VectorXd coupled;  ///< unknown_count
};

/// min sum_i weight_i |(A x - d)_i|^2 + ridge |x|^2, control points and the rest in units of their mean diagonal entries. With q alike on each axis
///   [ M x I3   E ] [ q ]   [ g ]
///   [ E'       D ] [ s ] = [ h ]
/// M (control points) is factored once for the three axes, sigma and the turns s are eliminated: D - E' (M x I3)^-1 E.
class WireSystem {
 public:
  ///   weights  per part and row of the field: how much the vertex counts
  WireSystem(const WireField& field, std::span<const Wire> wires, std::vector<std::vector<float>> weights,
             double ridge);

  const WireColumns& columns() const { return columns_; }
  WireVector zero() const;
  /// Adds one vertex's displacement (model space) to a right-hand side.
  void add(int part, int row, const Eigen::Vector3d& displacement, WireVector& right) const;
  WireVector solve(const WireVector& right) const;

 private:
  void factor(Eigen::MatrixXd controls, const Eigen::MatrixXd& cross, Eigen::MatrixXd coupled, double ridge);
  const WireField& field_;
  WireColumns columns_;
  std::vector<std::vector<float>> weights_;
  std::vector<int> turns_;  ///< per wire: how many turns meet at one vertex, 0 or 4
  Eigen::LLT<Eigen::MatrixXd> controls_, schur_;
  Eigen::MatrixXd eliminated_;  ///< (M x I3)^-1 E, axes one after the other
};

}  // namespace mien::detail
