#include "mien/geometry/bspline.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "mien/core/error.h"

namespace mien {
namespace {

constexpr int chords_a_span = 8;

void require_controls(int controls) {
  if (controls < 4)
    throw invalid_input("curve", "has " + std::to_string(controls) + " control points",
                        "a cubic needs four or more");
}

/// The knot span [knots[s], knots[s + 1]) that holds `u`, between 3 and #C - 1.
int span_of(std::span<const double> knots, double u) {
  const auto begin = knots.begin() + 3, end = knots.end() - 4;
  const auto above = std::upper_bound(begin, end, u);
  int span = static_cast<int>(above - knots.begin()) - 1;
  const int last = static_cast<int>(knots.size()) - 5;
  span = std::clamp(span, 3, last);
  while (span > 3 && knots[span] == knots[span + 1]) --span;
  return span;
}

/// The `degree` + 1 basis functions of that degree on one span.
std::array<double, 4> basis_of_degree(std::span<const double> knots, int span, double u, int degree) {
  std::array<double, 4> values{1, 0, 0, 0};
  for (int d = 1; d <= degree; ++d) {
    double carried = 0;
    for (int r = 0; r < d; ++r) {
      const double right = knots[span + r + 1], left = knots[span + r + 1 - d];
      const double share = right > left ? values[r] / (right - left) : 0;
      values[r] = carried + (right - u) * share;
      carried = (u - left) * share;
    }
    values[d] = carried;
  }
  return values;
}

double clamped(std::span<const double> knots, double u) {
  return std::clamp(u, knots[3], knots[knots.size() - 4]);
}

Eigen::Vector3d combine(const PointsD& controls, const SplineBasis& basis) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 4; ++k) sum += basis.values[k] * controls.row(basis.first + k).transpose();
  return sum;
}

/// Length along the polyline up to each point, from 0 to 1.
std::vector<double> length_parameters(const PointsD& points) {
  std::vector<double> at(static_cast<std::size_t>(points.rows()), 0);
  for (Eigen::Index i = 1; i < points.rows(); ++i)
    at[i] = at[i - 1] + (points.row(i) - points.row(i - 1)).norm();
  if (!(at.back() > 0)) throw invalid_input("curve", "has no length", "points that differ");
  for (double& value : at) value /= at.back();
  return at;
}

void require_points(const PointsD& points) {
  if (points.rows() < 2)
    throw invalid_input("curve", "has " + std::to_string(points.rows()) + " points", "two or more");
  if (!points.allFinite()) throw invalid_input("curve", "has a point that is not finite");
}

/// One stretch of a Catmull-Rom curve (Barry and Goldman's pyramid) between b and c.
Eigen::Vector3d catmull_rom(const std::array<Eigen::Vector3d, 4>& p, const std::array<double, 4>& t,
                            double at) {
  const auto mix = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double ta,
                       double tb) -> Eigen::Vector3d { return ((tb - at) * a + (at - ta) * b) / (tb - ta); };
  const Eigen::Vector3d a1 = mix(p[0], p[1], t[0], t[1]), a2 = mix(p[1], p[2], t[1], t[2]),
                        a3 = mix(p[2], p[3], t[2], t[3]);
  return mix(mix(a1, a2, t[0], t[2]), mix(a2, a3, t[1], t[3]), t[1], t[2]);
}

PointsD without_repeats(const PointsD& points) {
  PointsD kept(points.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (count == 0 || points.row(i) != kept.row(count - 1)) kept.row(count++) = points.row(i);
  kept.conservativeResize(count, Eigen::NoChange);
  if (count < 2) throw invalid_input("curve", "has no length", "points that differ");
  return kept;
}

PointsD evenly(const PointsD& dense, int samples) {
  const std::vector<double> at = length_parameters(dense);
  PointsD result(samples, 3);
  std::size_t next = 1;
  for (int i = 0; i < samples; ++i) {
    const double wanted = static_cast<double>(i) / (samples - 1);
    while (next + 1 < at.size() && at[next] < wanted) ++next;
    const double span = at[next] - at[next - 1];
    const double share = span > 0 ? std::clamp((wanted - at[next - 1]) / span, 0.0, 1.0) : 0;
    const auto row = static_cast<Eigen::Index>(next);
    result.row(i) = (1 - share) * dense.row(row - 1) + share * dense.row(row);
  }
  return result;
}

}  // namespace

std::vector<double> clamped_knots(int controls) {
  require_controls(controls);
  std::vector<double> knots(static_cast<std::size_t>(controls) + 4, 0);
  const int spans = controls - 3;
  for (int k = 0; k <= spans; ++k) knots[k + 3] = static_cast<double>(k) / spans;
  for (int k = 0; k < 4; ++k) knots[controls + k] = 1;
  return knots;
}

std::vector<double> uniform_knots(int controls) {
  require_controls(controls);
  std::vector<double> knots(static_cast<std::size_t>(controls) + 4);
  for (int k = 0; k < controls + 4; ++k) knots[k] = static_cast<double>(k - 3) / (controls - 3);
  return knots;
}

void require_valid(const BSpline& curve) {
  require_controls(curve.control_count());
  const std::size_t wanted = static_cast<std::size_t>(curve.control_count()) + 4;
  if (curve.knots.size() != wanted)
    throw invalid_input("curve", "has " + std::to_string(curve.knots.size()) + " knots",
                        std::to_string(wanted) + ", four more than control points");
  if (!curve.controls.allFinite()) throw invalid_input("curve", "has a control point that is not finite");
  for (std::size_t k = 0; k < wanted; ++k)
    if (!std::isfinite(curve.knots[k]) || (k > 0 && curve.knots[k] < curve.knots[k - 1]))
      throw invalid_input("curve, knot " + std::to_string(k), "is not finite or below the one before it",
                          "knots that do not descend");
  if (!(curve.low() < curve.high()))
    throw invalid_input("curve", "has knots without length between the fourth from each end",
                        "a longer range");
}

SplineBasis basis_at(std::span<const double> knots, double u) {
  u = clamped(knots, u);
  const int span = span_of(knots, u);
  return {span - 3, basis_of_degree(knots, span, u, 3)};
}

SplineBasis basis_derivatives_at(std::span<const double> knots, double u) {
  u = clamped(knots, u);
  const int span = span_of(knots, u);
  const std::array<double, 4> lower = basis_of_degree(knots, span, u, 2);
  SplineBasis result{span - 3, {}};
  for (int k = 0; k < 4; ++k) {
    const int l = span - 3 + k;  // B_l' = 3 (N_l / (t_l+3 - t_l) - N_l+1 / (t_l+4 - t_l+1)), N of degree 2
    const double first = knots[l + 3] - knots[l], second = knots[l + 4] - knots[l + 1];
    if (k > 0 && first > 0) result.values[k] += 3 * lower[k - 1] / first;
    if (k < 3 && second > 0) result.values[k] -= 3 * lower[k] / second;
  }
  return result;
}

Eigen::Vector3d point_at(const BSpline& curve, double u) {
  return combine(curve.controls, basis_at(curve.knots, u));
}

Eigen::Vector3d derivative_at(const BSpline& curve, double u) {
  return combine(curve.controls, basis_derivatives_at(curve.knots, u));
}

PointsD points_at(const BSpline& curve, std::span<const double> parameters) {
  PointsD points(static_cast<Eigen::Index>(parameters.size()), 3);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) = point_at(curve, parameters[i]).transpose();
  return points;
}

BSpline fit_bspline(const PointsD& points, const SplineFitOptions& options) {
  require_points(points);
  BSpline curve{PointsD::Zero(std::max(0, options.controls), 3), options.knots};
  require_controls(options.controls);
  if (curve.knots.empty()) curve.knots = clamped_knots(options.controls);
  require_valid(curve);
  const std::vector<double> at = length_parameters(points);
  const int controls = options.controls;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(controls, controls);
  PointsD right = PointsD::Zero(controls, 3);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const SplineBasis basis = basis_at(curve.knots, curve.low() + at[i] * (curve.high() - curve.low()));
    for (int a = 0; a < 4; ++a) {
      right.row(basis.first + a) += basis.values[a] * points.row(static_cast<Eigen::Index>(i));
      for (int b = 0; b < 4; ++b)
        normal(basis.first + a, basis.first + b) += basis.values[a] * basis.values[b];
    }
  }
  const double weight = options.smoothing * static_cast<double>(at.size());
  for (int l = 0; l + 2 < controls; ++l) {
    const double row[3] = {1, -2, 1};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) normal(l + a, l + b) += weight * row[a] * row[b];
  }
  curve.controls = normal.ldlt().solve(right);
  return curve;
}

PointsD sample_through(const PointsD& points, int samples) {
  require_points(points);
  if (samples < 2)
    throw invalid_input("curve", "is to have " + std::to_string(samples) + " samples", "two or more");
  const PointsD p = without_repeats(points);
  const Eigen::Index count = p.rows();
  const int a_stretch = std::max(2, 4 * samples / static_cast<int>(count - 1));
  PointsD dense((count - 1) * a_stretch + 1, 3);
  Eigen::Index row = 0;
  const auto point = [&](Eigen::Index i) -> Eigen::Vector3d {  // ends continue straight
    if (i < 0) return (2 * p.row(0) - p.row(1)).transpose();
    if (i >= count) return (2 * p.row(count - 1) - p.row(count - 2)).transpose();
    return p.row(i).transpose();
  };
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    const std::array<Eigen::Vector3d, 4> four{point(i - 1), point(i), point(i + 1), point(i + 2)};
    std::array<double, 4> t{};
    for (int k = 1; k < 4; ++k) t[k] = t[k - 1] + std::sqrt((four[k] - four[k - 1]).norm());
    for (int s = 0; s < a_stretch; ++s)
      dense.row(row++) = catmull_rom(four, t, t[1] + (t[2] - t[1]) * s / a_stretch).transpose();
  }
  dense.row(row) = p.row(count - 1);
  return evenly(dense, samples);
}

CurveQuery::CurveQuery(const BSpline& curve) : curve_(curve) {
  require_valid(curve_);
  for (int span = 3; span < curve_.control_count(); ++span) {
    const double from = curve_.knots[span], to = curve_.knots[span + 1];
    for (int s = 0; to > from && s < chords_a_span; ++s)
      parameters_.push_back(from + (to - from) * s / chords_a_span);
  }
  parameters_.push_back(curve_.high());
  samples_ = points_at(curve_, parameters_);
}

CurveQuery::Hit CurveQuery::closest(const Eigen::Vector3d& point) const {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity(), share = 0;
  for (std::size_t s = 0; s + 1 < parameters_.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s);
    const Eigen::Vector3d a = samples_.row(row), chord = samples_.row(row + 1).transpose() - a;
    const double length = chord.squaredNorm();
    const double t = length > 0 ? std::clamp((point - a).dot(chord) / length, 0.0, 1.0) : 0;
    const double distance = (a + t * chord - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = s;
      share = t;
    }
  }
  double u = parameters_[best] + share * (parameters_[best + 1] - parameters_[best]);
  Hit hit{u, point_at(curve_, u), 0};
  hit.distance = (hit.position - point).norm();
  for (int step = 0; step < 2; ++step) {  // Gauss-Newton; kept only where it comes closer
    const Eigen::Vector3d tangent = derivative_at(curve_, u);
    const double speed = tangent.squaredNorm();
    if (!(speed > 0)) break;
    u = std::clamp(u + tangent.dot(point - hit.position) / speed, curve_.low(), curve_.high());
    const Eigen::Vector3d position = point_at(curve_, u);
    const double distance = (position - point).norm();
    if (!(distance < hit.distance)) break;
    hit = {u, position, distance};
  }
  return hit;
}

}  // namespace mien
