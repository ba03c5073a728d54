#pragma once
/// Free-form deformation lattices (Sederberg and Parry 1986): a grid of control points that fills a piece of space.

#include <array>
#include <optional>
#include <string>

#include "mien/geometry/mesh.h"

namespace mien {

/// All of a lattice but its control points, which move: grid point (i, j, k) is control i + count[0] (j + count[1] k). Along each
/// axis the basis is the clamped uniform B-spline of that degree, over [0, 1].
struct Lattice {
  std::array<int, 3> count{2, 2, 2};   ///< control points along s, t and u, two or more
  std::array<int, 3> degree{1, 1, 1};  ///< 1 to count - 1; count - 1 is the Bernstein basis of the paper
  int control_count() const { return count[0] * count[1] * count[2]; }
  bool operator==(const Lattice&) const = default;
};

/// What is wrong with a descriptor for this many control points, in words; empty: nothing.
std::string fault_of(const Lattice& lattice, std::size_t control_count);

/// The share of each control point in the point at `coordinates`, clamped into [0, 1]^3; they sum to one.
///   returns  control_count()
Eigen::VectorXd lattice_basis(const Lattice& lattice, const Eigen::Vector3d& coordinates);

/// The control points with which the lattice maps [0, 1]^3 evenly onto `box`.
///   throws  invalid_input: what fault_of finds, a box without volume
PointsD lattice_controls(const Lattice& lattice, const Box& box);

/// Where in [0, 1]^3 the lattice with these control points has `point`; nothing when it is outside. The control points may be bent,
/// as they are after a transfer.
///   method  Newton's method from the closest of a grid of samples, to 1e-12 of the box's diagonal
std::optional<Eigen::Vector3d> lattice_coordinates(const Lattice& lattice, const PointsD& controls,
                                                   const Eigen::Vector3d& point);

}  // namespace mien
