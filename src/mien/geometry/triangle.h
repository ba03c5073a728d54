#pragma once
/// One triangle in space.

#include <Eigen/Core>

namespace mien {

struct TrianglePoint {
  Eigen::Vector3d barycentric;  ///< weights of a, b, c; >= 0, sum one
  Eigen::Vector3d position;
};

/// The point of triangle (a, b, c) that is closest to `p`. Degenerate triangles are treated as their longest
/// edge or point.
TrianglePoint closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Weights of the point of triangle (a, b, c) that is closest to `p`, in a space of any dimension: for `Vector` = Vector3d
/// and Matrix<double, 6, 1>. Degenerate triangles are treated alike.
template <class Vector>
Eigen::Vector3d closest_barycentric(const Vector& p, const Vector& a, const Vector& b, const Vector& c);

/// Weights w with w[0] a + w[1] b + w[2] c = the foot of `p` on the triangle's plane, sum one; negative
/// outside. A degenerate triangle gives (1, 0, 0).
Eigen::Vector3d barycentric_on_plane(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                     const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace mien
