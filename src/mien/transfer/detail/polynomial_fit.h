#pragma once
/// The coarsest step of registration: one polynomial map of space for the whole skin.

#include <vector>

#include "mien/transfer/detail/displacement_solver.h"

namespace mien::detail {

/// Displacements of all vertices by one quadratic map of space, u(x) = C phi(x) with phi = (1, x, y, z, xx, xy, ...), that
/// meet the wishes in least squares. A spline of face landmarks is free to stretch a cranium that has none; here the
/// whole skin decides, and nothing can slide along it. `ridge` holds the non-constant terms back, relative to the wishes'
/// total weight.
///   rest     #V x 3, in face sizes around the origin
///   returns  #V x 3
///   cost     linear in wishes
PointsD fit_polynomial(const PointsD& rest, const std::vector<Wish>& wishes, double ridge);

}  // namespace mien::detail
