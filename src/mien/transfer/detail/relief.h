#pragma once
/// What a surface stands out by: noses, lips and brows up, sockets down.

#include "mien/transfer/register_surfaces.h"

namespace mien::detail {

/// #V: how far each vertex stands out, along its normal, over the surface smoothed with `radius`
/// ((M + radius^2 L) x' = M x), in units of the radius. 0 on a plane; invariant under similarity.
///   cost  one sparse factorisation
Eigen::VectorXd relief(const Surface& surface, const PointsD& normals, double radius);

/// Weighted correlation of two columns in [-1, 1]; 0 where one is constant.
double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& weights);

}  // namespace mien::detail
