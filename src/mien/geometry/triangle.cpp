#include "mien/geometry/triangle.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace mien {
namespace {

double closest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double squared = ab.squaredNorm();
  return squared > 0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

TrianglePoint closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  // Inside the triangle's prism the foot on the plane is closest; otherwise one of the edges holds the point.
  const Eigen::Vector3d ab = b - a, ac = c - a, normal = ab.cross(ac);
  const double squared_area = normal.squaredNorm();
  if (squared_area > 0) {
    const Eigen::Vector3d ap = p - a;
    const double v = ap.cross(ac).dot(normal) / squared_area;
    const double w = ab.cross(ap).dot(normal) / squared_area;
    if (v >= 0 && w >= 0 && v + w <= 1) return {{1 - v - w, v, w}, a + v * ab + w * ac};
  }
  const Eigen::Vector3d* corner[3] = {&a, &b, &c};
  TrianglePoint best{};
  double best_distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d &from = *corner[k], &to = *corner[(k + 1) % 3];
    const double t = closest_on_segment(p, from, to);
    const Eigen::Vector3d position = from + t * (to - from);
    const double distance = (position - p).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best.position = position;
      best.barycentric.setZero();
      best.barycentric[k] = 1 - t;
      best.barycentric[(k + 1) % 3] = t;
    }
  }
  return best;
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
