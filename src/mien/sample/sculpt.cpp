// Blending: the quadratic smooth minimum, which bulges a union by at most blend / 4 where two lumps meet and
// leaves everything farther than `blend` from the seam alone.

#include "mien/sample/detail/sculpt.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace mien::sample {

Blob& Blob::turned(double x, double y, double z) {
  const double degree = std::numbers::pi / 180;
  const Eigen::Matrix3d rotation =
      (Eigen::AngleAxisd(z * degree, Vector3d::UnitZ()) * Eigen::AngleAxisd(y * degree, Vector3d::UnitY()) *
       Eigen::AngleAxisd(x * degree, Vector3d::UnitX()))
          .toRotationMatrix();
  turn = rotation.transpose();
  return *this;
}

Blob ellipsoid(const Vector3d& centre, const Vector3d& radii, double blend) {
  Blob blob;
  blob.a = centre;
  blob.b = radii;
  blob.blend = blend;
  return blob;
}

Blob capsule(const Vector3d& a, double radius_a, const Vector3d& b, double radius_b, double blend) {
  Blob blob;
  blob.kind = Blob::Kind::capsule;
  blob.a = a;
  blob.b = b;
  blob.radius_a = radius_a;
  blob.radius_b = radius_b;
  blob.blend = blend;
  return blob;
}

namespace {

double distance_to(const Blob& blob, const Vector3d& p) {
  if (blob.kind == Blob::Kind::capsule) {
    const Vector3d axis = blob.b - blob.a, from = p - blob.a;
    const double t = std::clamp(from.dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    return (from - t * axis).norm() - (blob.radius_a + t * (blob.radius_b - blob.radius_a));
  }
  const Vector3d local = blob.turn * (p - blob.a);
  const Vector3d scaled = local.cwiseQuotient(blob.b);
  const double k0 = scaled.norm(), k1 = scaled.cwiseQuotient(blob.b).norm();
  return k1 > 1e-9 ? k0 * (k0 - 1) / k1 : -blob.b.minCoeff();
}

double smooth_min(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - h * h * blend / 4;
}

double apply(const Blob& blob, double so_far, const Vector3d& p) {
  const double d = distance_to(blob, p);
  return blob.op == Blob::Op::add ? smooth_min(so_far, d, blob.blend) : -smooth_min(-so_far, d, blob.blend);
}

}  // namespace

double Sculpt::distance(const Vector3d& p) const {
  const Vector3d mirrored(-p.x(), p.y(), p.z());
  double d = 1e3;
  for (const Blob& blob : blobs_) {
    d = apply(blob, d, p);
    if (blob.pair) d = apply(blob, d, mirrored);
  }
  return d;
}

Vector3d Sculpt::normal(const Vector3d& p) const {
  // Tetrahedral differences: four samples instead of six.
  const double h = 0.02;
  static const Vector3d corner[4] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& c : corner) sum += c * distance(p + h * c);
  const double length = sum.norm();
  return length > 1e-12 ? Vector3d(sum / length) : Vector3d(Vector3d::UnitZ());
}

Vector3d Sculpt::project(const Vector3d& p, int steps) const {
  Vector3d q = p;
  for (int i = 0; i < steps; ++i) {
    const double d = distance(q);
    if (std::abs(d) < 1e-5) break;
    q -= d * normal(q);
  }
  return q;
}

Vector3d Sculpt::cast(const Vector3d& origin, const Vector3d& direction, double reach) const {
  double outside = reach;
  while (outside > 0) {
    const double d = distance(origin + outside * direction);
    if (d < 1e-4) break;
    outside -= std::max(0.7 * d, 1e-3);
  }
  return origin + std::max(outside, 0.0) * direction;
}

}  // namespace mien::sample
