#pragma once
/// Non-uniform rational B-spline curves of any degree (Piegl and Tiller 1997, chapters 3 and 4).

#include <string>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien {

/// All of a curve but its control points, which move.
struct NurbsCurve {
  int degree = 3;
  /// #C + degree + 1, not descending; the domain is [knots[degree], knots[#C]].
  std::vector<double> knots;
  std::vector<double> weights;  ///< #C, > 0; none: all 1 (not rational)
  int control_count() const { return static_cast<int>(knots.size()) - degree - 1; }
  bool operator==(const NurbsCurve&) const = default;
};

/// What is wrong with a descriptor for this many control points, in words; empty: nothing.
std::string fault_of(const NurbsCurve& curve, std::size_t control_count);

/// The share of each control point in the point at `u`: the rational basis functions, which sum to one. `u` outside the domain is
/// taken at its border.
///   returns  #C, degree + 1 of them not zero
Eigen::VectorXd nurbs_basis(const NurbsCurve& curve, double u);

/// The curve's points at `samples` even parameters, end to end.
///   controls  #C x 3
///   throws    invalid_input: what fault_of finds, fewer than 2 samples
PointsD tessellate(const NurbsCurve& curve, const PointsD& controls, int samples);

}  // namespace mien
