#include "mien/geometry/nurbs_curve.h"

#include "mien/core/error.h"
#include "mien/geometry/detail/spline_basis.h"

namespace mien {

std::string fault_of(const NurbsCurve& curve, std::size_t control_count) {
  const std::string points = "control points";
  if (const std::string fault =
          detail::fault_of_knots(points, "", curve.degree, static_cast<int>(control_count), curve.knots);
      !fault.empty())
    return fault;
  return detail::fault_of_weights(points, control_count, curve.weights);
}

Eigen::VectorXd nurbs_basis(const NurbsCurve& curve, double u) {
  return detail::rational(detail::spline_basis(curve.degree, curve.control_count(), curve.knots, u),
                          curve.weights);
}

PointsD tessellate(const NurbsCurve& curve, const PointsD& controls, int samples) {
  if (const std::string fault = fault_of(curve, static_cast<std::size_t>(controls.rows())); !fault.empty())
    throw invalid_input("spline curve", fault);
  if (samples < 2) throw invalid_input("tessellation", "has fewer than 2 samples", "give 2 or more");
  const double low = curve.knots[static_cast<std::size_t>(curve.degree)],
               high = curve.knots[static_cast<std::size_t>(curve.control_count())];
  PointsD points(samples, 3);
  for (int s = 0; s < samples; ++s)
    points.row(s) = nurbs_basis(curve, low + (high - low) * s / (samples - 1)).transpose() * controls;
  return points;
}

}  // namespace mien
