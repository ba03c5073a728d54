#include "mien/geometry/triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace mien {
namespace {

template <class Vector>
double closest_on_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector ab = b - a;
  const double squared = ab.squaredNorm();
  return squared > 0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
}

template <class Vector>
Eigen::Vector3d closest_on_edges(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector* corner[3] = {&a, &b, &c};
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double best_distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vector &from = *corner[k], &to = *corner[(k + 1) % 3];
    const double t = closest_on_segment(p, from, to);
    const double distance = (from + t * (to - from) - p).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best.setZero();
      best[k] = 1 - t;
      best[(k + 1) % 3] = t;
    }
  }
  return best;
}

}  // namespace

template <class Vector>
Eigen::Vector3d closest_barycentric(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  // The signs of six dot products say in which corner's, edge's or face's Voronoi region the point lies (Ericson 2005,
  // 5.1.5). Divisions by zero happen on degenerate triangles alone, which the last branch takes.
  const Vector ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vector bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const Vector cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (va > 0 && vb > 0 && vc > 0) {
    const double scale = 1 / (va + vb + vc), v = vb * scale, w = vc * scale;
    return {1 - v - w, v, w};
  }
  return closest_on_edges(p, a, b, c);
}

using Vector6d = Eigen::Matrix<double, 6, 1>;
template Eigen::Vector3d closest_barycentric(const Eigen::Vector3d&, const Eigen::Vector3d&,
                                             const Eigen::Vector3d&, const Eigen::Vector3d&);
template Eigen::Vector3d closest_barycentric(const Vector6d&, const Vector6d&, const Vector6d&,
                                             const Vector6d&);

TrianglePoint closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d weights = closest_barycentric(p, a, b, c);
  // From `a` on, so that a point on a corner comes back as that corner to the last digit.
  if (weights[0] == 1) return {weights, a};
  if (weights[1] == 1) return {weights, b};
  if (weights[2] == 1) return {weights, c};
  return {weights, a + weights[1] * (b - a) + weights[2] * (c - a)};
}

Eigen::Vector3d barycentric_on_plane(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                     const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, normal = ab.cross(ac);
  const double squared_area = normal.squaredNorm();
  if (!(squared_area > 0)) return {1, 0, 0};
  const double v = ap.cross(ac).dot(normal) / squared_area;
  const double w = ab.cross(ap).dot(normal) / squared_area;
  return {1 - v - w, v, w};
}

}  // namespace mien
