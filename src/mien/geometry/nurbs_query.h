#pragma once
/// Closest points of spline curves and surfaces, and control points that pass through given points.

#include <memory>
#include <vector>

#include "mien/geometry/mesh.h"
#include "mien/geometry/nurbs_curve.h"
#include "mien/geometry/nurbs_surface.h"

namespace mien {

/// Closest points of one curve, asked many times from any thread.
class NurbsCurveQuery {
 public:
  struct Hit {
    double u = 0;
    double distance = 0;
  };
  ///   controls  #C x 3
  ///   throws    invalid_input: what fault_of finds
  NurbsCurveQuery(NurbsCurve curve, PointsD controls);

  /// The closest point of a polyline with eight chords a knot span, refined by golden sections to 1e-6 of a chord. Equally close
  /// ones: the lowest parameter.
  ///   cost  about 50 us
  Hit closest(const Eigen::Vector3d& point) const;
  /// The distance to the polyline alone: within a hundredth of the curve's own. 0.2 us.
  double rough_distance(const Eigen::Vector3d& point) const;

  Eigen::Vector3d at(double u) const;

 private:
  NurbsCurve curve_;
  PointsD controls_;
  std::vector<double> parameters_;
  PointsD samples_;
};

/// Closest points of one surface, asked many times from any thread.
class NurbsSurfaceQuery {
 public:
  struct Hit {
    double u = 0, v = 0;
    double distance = 0;
  };
  ///   controls  count_u count_v x 3
  ///   throws    invalid_input: what fault_of finds
  NurbsSurfaceQuery(NurbsSurface surface, PointsD controls);
  ~NurbsSurfaceQuery();

  /// The closest point of a mesh with six quads a knot span and direction, refined by Gauss-Newton steps of the best length.
  ///   cost  about 30 us
  Hit closest(const Eigen::Vector3d& point) const;

  Eigen::Vector3d at(double u, double v) const;

 private:
  struct Samples;
  NurbsSurface surface_;
  PointsD controls_;
  std::unique_ptr<Samples> samples_;
};

/// Knots over [0, 1] with equal spans; clamped: the first and last control point are the ends.
///   throws  invalid_input: a degree below 1, not more control points than the degree
std::vector<double> clamped_knots(int controls, int degree);

/// Control points with which the curve comes closest to `points` in the least-squares sense; parameters follow the polyline's
/// length. As many points as control points: through all of them.
///   points  #P x 3 in order
///   throws  invalid_input: what fault_of finds; fewer points than control points, all of them coincident, numbers that are not finite
PointsD fit_controls(const NurbsCurve& curve, const PointsD& points);

/// Control vertices with which the surface passes through a grid of points: point (i, j) is row i + count_u j, at the mean of the
/// knots of control vertex (i, j).
///   points  count_u count_v x 3
///   throws  invalid_input: what fault_of finds, numbers that are not finite, a rational surface
PointsD fit_controls(const NurbsSurface& surface, const PointsD& points);

}  // namespace mien
