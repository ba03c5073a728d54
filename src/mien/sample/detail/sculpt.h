#pragma once
/// The flesh of a built-in head: a signed distance field blended from ellipsoids and capsules.
///
/// Lengths are centimetres, the head looks along +Z, Y is up, the character's left is at +X.

#include <Eigen/Core>
#include <vector>

namespace mien::sample {

using Eigen::Vector3d;

/// One lump of clay. Lumps are applied in order; each is blended with what came before over a distance.
struct Blob {
  enum class Kind { ellipsoid, capsule };
  enum class Op { add, cut };
  Kind kind = Kind::ellipsoid;
  Vector3d a = Vector3d::Zero();                       ///< centre of the ellipsoid, first end of the capsule
  Vector3d b = Vector3d::Zero();                       ///< radii of the ellipsoid, second end of the capsule
  double radius_a = 1, radius_b = 1;                   ///< of the capsule at its ends
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< model space to the ellipsoid's axes
  double blend = 1;                                    ///< how far the blend reaches
  Op op = Op::add;
  bool pair = false;  ///< applied at -x as well

  Blob& cut() {
    op = Op::cut;
    return *this;
  }
  Blob& both() {
    pair = true;
    return *this;
  }
  /// Turns the ellipsoid about x, then y, then z (degrees).
  Blob& turned(double x, double y, double z);
};

Blob ellipsoid(const Vector3d& centre, const Vector3d& radii, double blend);
Blob capsule(const Vector3d& a, double radius_a, const Vector3d& b, double radius_b, double blend);

/// A head's form. `distance` is negative inside; it is a bound rather than the exact distance, with a
/// gradient of length near one close to the surface.
class Sculpt {
 public:
  Sculpt() = default;
  explicit Sculpt(std::vector<Blob> blobs) : blobs_(std::move(blobs)) {}
  double distance(const Vector3d& p) const;
  /// Unit outward direction of the field, by differences.
  Vector3d normal(const Vector3d& p) const;
  /// The surface point reached by walking from `p` along the gradient.
  Vector3d project(const Vector3d& p, int steps = 4) const;
  /// The outermost crossing of the ray from `origin` (inside) along the unit `direction` within `reach`.
  Vector3d cast(const Vector3d& origin, const Vector3d& direction, double reach = 30) const;

 private:
  std::vector<Blob> blobs_;
};

}  // namespace mien::sample
