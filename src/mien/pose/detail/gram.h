#pragma once
/// D'D over all vertices.

#include <Eigen/Core>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien::detail {

/// #S x #S: the products of all shapes' motions over all vertices of all parts, model space, joints as in `pose`.
/// Cost: linear in vertices x (shapes that move each)^2; the same at any thread count.
Eigen::MatrixXd shape_products(const Character& character, const Pose& pose);

}  // namespace mien::detail
