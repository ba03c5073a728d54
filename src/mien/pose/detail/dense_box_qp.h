#pragma once
/// A small dense box-constrained quadratic program, for problems whose matrix is no sum of few rows.

#include <Eigen/Core>

namespace mien::detail {

/// min over x in [low, high] of 1/2 x'Hx - q'x, H symmetric positive definite.
///   x        a guess in, the solution out
///   returns  whether it converged (it does, but for rounding)
///   method   primal active set: the minimum over the free variables, up to the first limit on the way; when it is reached,
///            the held variable that most wants to leave its limit is freed. The value falls at every step.
///   cost     one factorisation of the free block a step
bool minimise_in_box(const Eigen::MatrixXd& h, const Eigen::VectorXd& q, const Eigen::VectorXd& low,
                     const Eigen::VectorXd& high, Eigen::VectorXd& x);

}  // namespace mien::detail
