#pragma once
/// Cubic B-spline curves.

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien {

/// c(u) = sum_l B_l(u) controls_l over u in [knots[3], knots[#C]].
struct BSpline {
  PointsD controls;           ///< #C x 3, four or more
  std::vector<double> knots;  ///< #C + 4, not descending, knots[3] < knots[#C]

  int control_count() const { return static_cast<int>(controls.rows()); }
  double low() const { return knots[3]; }
  double high() const { return knots[knots.size() - 4]; }
  bool operator==(const BSpline& other) const {
    return knots == other.knots && controls.rows() == other.controls.rows() && controls == other.controls;
  }
};

/// The four basis functions that are not zero at a parameter.
struct SplineBasis {
  int first = 0;  ///< the first of the four control points
  std::array<double, 4> values{};
};

/// Knots over [0, 1] with equal spans: clamped ones repeat their ends, so that the curve starts at its first control point
/// and ends at its last.
///   throws  invalid_input: fewer than four control points
std::vector<double> clamped_knots(int controls);
std::vector<double> uniform_knots(int controls);

///   throws  invalid_input: fewer than four control points, another number of knots, descending knots, a domain without
///           length, numbers that are not finite
void require_valid(const BSpline& curve);

/// Basis functions and their derivatives at `u`, clamped into the domain. `knots` as in BSpline (not checked).
///   method  de Boor's recurrence
SplineBasis basis_at(std::span<const double> knots, double u);
SplineBasis basis_derivatives_at(std::span<const double> knots, double u);

Eigen::Vector3d point_at(const BSpline& curve, double u);
Eigen::Vector3d derivative_at(const BSpline& curve, double u);

/// #U x 3.
PointsD points_at(const BSpline& curve, std::span<const double> parameters);

struct SplineFitOptions {
  int controls = 10;          ///< four or more
  std::vector<double> knots;  ///< #controls + 4; none: clamped_knots(controls)
  /// Weight of the second differences of the control points against the mean squared distance: keeps what the points leave
  /// open smooth, and moves the curve by far less than its points are apart.
  double smoothing = 1e-5;
};

/// The curve closest to `points` in the least-squares sense; parameters follow the polyline's length.
///   points  #P x 3 in order, two or more different ones
///   throws  invalid_input: fewer than two points, all of them coincident, numbers that are not finite; knots as above
///   cost    O(#P + controls^3)
BSpline fit_bspline(const PointsD& points, const SplineFitOptions& options = {});

/// A smooth curve through all points (centripetal Catmull-Rom), as `samples` points evenly by length; two points give
/// their segment.
///   throws  invalid_input: fewer than two points, fewer than two samples, all points coincident
PointsD sample_through(const PointsD& points, int samples);

/// Closest points of one curve, asked many times.
class CurveQuery {
 public:
  struct Hit {
    double parameter = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double distance = 0;
  };

  ///   throws  invalid_input: a curve that is not valid
  explicit CurveQuery(const BSpline& curve);

  /// The closest point of the curve: of a polyline with eight chords a knot span, then refined by Newton steps. Equally close
  /// ones: the lowest parameter.
  ///   cost  about 0.2 us for ten control points
  Hit closest(const Eigen::Vector3d& point) const;

 private:
  BSpline curve_;
  std::vector<double> parameters_;
  PointsD samples_;
};

}  // namespace mien
