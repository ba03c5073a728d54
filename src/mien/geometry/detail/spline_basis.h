#pragma once
/// One direction of a spline of any degree over any knots: what curves, surfaces and lattices share.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace mien::detail {

/// What is wrong with the knots of `count` control points, in words; empty: nothing.
///   points  what the control points are called: "control vertices"
///   along   " along u", or nothing
std::string fault_of_knots(const std::string& points, const std::string& along, int degree, int count,
                           const std::vector<double>& knots);

/// What is wrong with the weights of `count` control points; none: nothing.
std::string fault_of_weights(const std::string& points, std::size_t count,
                             const std::vector<double>& weights);

/// Knots over [0, 1] with equal spans whose first and last control point are the ends. `count` is above `degree`.
std::vector<double> clamped_knots(int count, int degree);

/// The basis functions at `u`, taken at the domain's border outside of it.
///   returns  #count, degree + 1 of them not zero
///   method   Piegl and Tiller 1997, A2.1 and A2.2
Eigen::VectorXd spline_basis(int degree, int count, const std::vector<double>& knots, double u);

/// Their derivatives; outside of the domain those at its border.
Eigen::VectorXd spline_basis_slope(int degree, int count, const std::vector<double>& knots, double u);

/// Shares in proportion to the basis times the weights, which sum to one.
Eigen::VectorXd rational(Eigen::VectorXd basis, const std::vector<double>& weights);

}  // namespace mien::detail
