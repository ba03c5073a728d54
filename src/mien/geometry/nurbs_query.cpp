// Coarse samples find the piece, a local search finds the point in it. Every knot is a sample, so that no piece has a kink inside; a
// golden section needs no derivative, which rational curves of any degree make long to write and no faster.
#include "mien/geometry/nurbs_query.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "mien/core/error.h"
#include "mien/geometry/detail/spline_basis.h"
#include "mien/geometry/surface_query.h"

namespace mien {
namespace {

constexpr int chords_a_span = 8, quads_a_span = 6;
constexpr int golden_steps = 30, newton_steps = 8;
constexpr double golden = 0.6180339887498949;
constexpr double difference = 1e-5;  ///< of the domain, for slopes of a surface

/// Even parameters between all distinct knots of the domain.
std::vector<double> sample_parameters(int degree, int count, const std::vector<double>& knots, int a_span) {
  std::vector<double> parameters{knots[static_cast<std::size_t>(degree)]};
  for (int k = degree; k < count; ++k) {
    const double low = knots[static_cast<std::size_t>(k)], high = knots[static_cast<std::size_t>(k) + 1];
    for (int s = 1; s <= a_span && low < high; ++s) parameters.push_back(low + (high - low) * s / a_span);
  }
  return parameters;
}

void require_points(const PointsD& points) {
  if (!points.allFinite()) throw invalid_input("points to fit", "are not finite", "finite numbers");
}

}  // namespace

NurbsCurveQuery::NurbsCurveQuery(NurbsCurve curve, PointsD controls)
    : curve_(std::move(curve)), controls_(std::move(controls)) {
  if (const std::string fault = fault_of(curve_, static_cast<std::size_t>(controls_.rows())); !fault.empty())
    throw invalid_input("spline curve", fault);
  parameters_ = sample_parameters(curve_.degree, curve_.control_count(), curve_.knots, chords_a_span);
  samples_.resize(static_cast<Eigen::Index>(parameters_.size()), 3);
  for (std::size_t s = 0; s < parameters_.size(); ++s)
    samples_.row(static_cast<Eigen::Index>(s)) = at(parameters_[s]).transpose();
}

Eigen::Vector3d NurbsCurveQuery::at(double u) const {
  return (nurbs_basis(curve_, u).transpose() * controls_).transpose();
}

namespace {

double chord_distance(const PointsD& samples, Eigen::Index s, const Eigen::Vector3d& point) {
  const Eigen::Vector3d from = samples.row(s).transpose(), way = samples.row(s + 1).transpose() - from;
  const double length = way.squaredNorm();
  const double t = length > 0 ? std::clamp((point - from).dot(way) / length, 0.0, 1.0) : 0.0;
  return (from + t * way - point).norm();
}

}  // namespace

double NurbsCurveQuery::rough_distance(const Eigen::Vector3d& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index s = 0; s + 1 < samples_.rows(); ++s)
    least = std::min(least, chord_distance(samples_, s, point));
  return least;
}

NurbsCurveQuery::Hit NurbsCurveQuery::closest(const Eigen::Vector3d& point) const {
  Eigen::Index nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index s = 0; s + 1 < samples_.rows(); ++s)
    if (const double distance = chord_distance(samples_, s, point); distance < least) {
      least = distance;
      nearest = s;
    }
  const auto distance_at = [&](double u) { return (at(u) - point).norm(); };
  Hit best{0, std::numeric_limits<double>::infinity()};
  const auto offer = [&](double u, double distance) {
    if (distance < best.distance) best = {u, distance};
  };
  const Eigen::Index last = samples_.rows() - 2;
  for (Eigen::Index s = std::max<Eigen::Index>(nearest - 1, 0); s <= std::min(nearest + 1, last); ++s) {
    double low = parameters_[static_cast<std::size_t>(s)],
           high = parameters_[static_cast<std::size_t>(s) + 1];
    offer(low, distance_at(low));
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = distance_at(a), at_b = distance_at(b);
    for (int step = 0; step < golden_steps; ++step) {
      if (at_a <= at_b) {
        high = b;
        b = a;
        at_b = at_a;
        at_a = distance_at(a = high - golden * (high - low));
      } else {
        low = a;
        a = b;
        at_a = at_b;
        at_b = distance_at(b = low + golden * (high - low));
      }
    }
    offer((low + high) / 2, distance_at((low + high) / 2));
    const double end = parameters_[static_cast<std::size_t>(s) + 1];
    offer(end, distance_at(end));
  }
  return best;
}

struct NurbsSurfaceQuery::Samples {
  std::vector<double> u, v;
  Triangles triangles;
  std::unique_ptr<SurfaceQuery> query;
};

NurbsSurfaceQuery::NurbsSurfaceQuery(NurbsSurface surface, PointsD controls)
    : surface_(std::move(surface)), controls_(std::move(controls)), samples_(std::make_unique<Samples>()) {
  if (const std::string fault = fault_of(surface_, static_cast<std::size_t>(controls_.rows()));
      !fault.empty())
    throw invalid_input("spline surface", fault);
  Samples& s = *samples_;
  s.u = sample_parameters(surface_.degree_u, surface_.count_u, surface_.knots_u, quads_a_span);
  s.v = sample_parameters(surface_.degree_v, surface_.count_v, surface_.knots_v, quads_a_span);
  const int nu = static_cast<int>(s.u.size()), nv = static_cast<int>(s.v.size());
  PointsD positions(static_cast<Eigen::Index>(nu) * nv, 3);
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i)
      positions.row(static_cast<Eigen::Index>(j) * nu + i) = at(s.u[i], s.v[j]).transpose();
  s.triangles.resize(2 * static_cast<Eigen::Index>(nu - 1) * (nv - 1), 3);
  Eigen::Index row = 0;
  for (int j = 0; j + 1 < nv; ++j)
    for (int i = 0; i + 1 < nu; ++i) {
      const int corner = j * nu + i;
      s.triangles.row(row++) << corner, corner + 1, corner + 1 + nu;
      s.triangles.row(row++) << corner, corner + 1 + nu, corner + nu;
    }
  s.query = std::make_unique<SurfaceQuery>(positions, s.triangles);
}

NurbsSurfaceQuery::~NurbsSurfaceQuery() = default;

Eigen::Vector3d NurbsSurfaceQuery::at(double u, double v) const {
  return (nurbs_basis(surface_, u, v).transpose() * controls_).transpose();
}

NurbsSurfaceQuery::Hit NurbsSurfaceQuery::closest(const Eigen::Vector3d& point) const {
  const Samples& s = *samples_;
  const SurfaceQuery::Hit hit = s.query->closest(point);
  const auto nu = static_cast<int>(s.u.size());
  Eigen::Vector2d c = Eigen::Vector2d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int vertex = s.triangles(hit.triangle, k);
    c += hit.barycentric[k] * Eigen::Vector2d(s.u[vertex % nu], s.v[vertex / nu]);
  }
  const Eigen::Vector2d low(s.u.front(), s.v.front()), high(s.u.back(), s.v.back());
  const Eigen::Vector2d step = difference * (high - low);
  Eigen::Vector3d away = point - at(c[0], c[1]);
  for (int n = 0; n < newton_steps; ++n) {
    Eigen::Matrix<double, 3, 2> slope;
    for (int a = 0; a < 2; ++a) {
      Eigen::Vector2d before = c, after = c;
      before[a] = std::max(c[a] - step[a], low[a]);
      after[a] = std::min(c[a] + step[a], high[a]);
      slope.col(a) = (at(after[0], after[1]) - at(before[0], before[1])) / (after[a] - before[a]);
    }
    const Eigen::Vector2d way = slope.colPivHouseholderQr().solve(away);
    if (!way.allFinite()) break;
    const auto stepped = [&](double t) -> Eigen::Vector2d {
      return (c + t * way).cwiseMax(low).cwiseMin(high);
    };
    const auto rest = [&](const Eigen::Vector2d& at_uv) -> Eigen::Vector3d {
      return point - at(at_uv[0], at_uv[1]);
    };
    // The surface's bend makes the whole step too long or short: the parabola through both ends says by how much.
    const double gain = (slope * way).squaredNorm();
    const double bend = rest(stepped(1)).squaredNorm() - away.squaredNorm() + 2 * gain;
    const Eigen::Vector2d next = stepped(bend > 0 ? std::clamp(gain / bend, 0.1, 2.0) : 1.0);
    const Eigen::Vector3d left = rest(next);
    if (!(left.norm() < away.norm())) break;
    c = next;
    away = left;
  }
  return {c[0], c[1], away.norm()};
}

std::vector<double> clamped_knots(int controls, int degree) {
  if (degree < 1 || controls <= degree)
    throw invalid_input(
        "knots",
        "are asked for " + std::to_string(controls) + " control points of degree " + std::to_string(degree),
        "a degree from 1, and more control points than it");
  return detail::clamped_knots(controls, degree);
}

PointsD fit_controls(const NurbsCurve& curve, const PointsD& points) {
  const int controls = curve.control_count();
  if (const std::string fault = fault_of(curve, static_cast<std::size_t>(std::max(controls, 0)));
      !fault.empty())
    throw invalid_input("spline curve", fault);
  require_points(points);
  if (points.rows() < controls)
    throw invalid_input("points to fit", "number " + std::to_string(points.rows()),
                        std::to_string(controls) + " or more, one a control point");
  std::vector<double> way{0};
  for (Eigen::Index p = 1; p < points.rows(); ++p)
    way.push_back(way.back() + (points.row(p) - points.row(p - 1)).norm());
  if (!(way.back() > 0)) throw invalid_input("points to fit", "are all in one place", "points that differ");
  const double low = curve.knots[static_cast<std::size_t>(curve.degree)],
               high = curve.knots[static_cast<std::size_t>(controls)];
  Eigen::MatrixXd basis(points.rows(), controls);
  for (Eigen::Index p = 0; p < points.rows(); ++p)
    basis.row(p) =
        nurbs_basis(curve, low + (high - low) * way[static_cast<std::size_t>(p)] / way.back()).transpose();
  return basis.completeOrthogonalDecomposition().solve(points);
}

PointsD fit_controls(const NurbsSurface& surface, const PointsD& points) {
  if (const std::string fault = fault_of(surface, static_cast<std::size_t>(points.rows())); !fault.empty())
    throw invalid_input("spline surface", fault);
  require_points(points);
  if (!surface.weights.empty())
    throw invalid_input("spline surface", "is rational", "control vertices, or a surface without weights");
  const auto along = [](int degree, int count, const std::vector<double>& knots) {
    Eigen::MatrixXd basis(count, count);
    for (int i = 0; i < count; ++i) {
      const double mean =
          std::accumulate(knots.begin() + i + 1, knots.begin() + i + 1 + degree, 0.0) / degree;
      basis.row(i) = detail::spline_basis(degree, count, knots, mean).transpose();
    }
    return Eigen::MatrixXd(basis.completeOrthogonalDecomposition().pseudoInverse());
  };
  const Eigen::MatrixXd back_u = along(surface.degree_u, surface.count_u, surface.knots_u),
                        back_v = along(surface.degree_v, surface.count_v, surface.knots_v);
  PointsD controls(points.rows(), 3);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd column = points.col(axis);
    const Eigen::MatrixXd solved =
        back_u * column.reshaped(surface.count_u, surface.count_v) * back_v.transpose();
    controls.col(axis) = solved.reshaped();
  }
  return controls;
}

}  // namespace mien
