// Points are found by Newton's method on the lattice continued linearly beyond [0, 1]^3: an iterate may leave the cube and come
// back, where one that is held inside sticks to a face of a bent lattice. Control points are taken relative to their centre, so that
// a lattice far from the origin loses no digits.
#include "mien/geometry/lattice.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "mien/core/error.h"
#include "mien/geometry/detail/spline_basis.h"

namespace mien {
namespace {

constexpr int most_controls = 1000000;
constexpr int most_steps = 60, most_halvings = 20, most_starts = 4;
constexpr double longest_step = 0.5;  ///< of the cube's side
constexpr double tolerance = 1e-12;   ///< of the box's diagonal
/// Coordinates may be this far outside: what the tolerance of a point on the border comes to.
constexpr double border = 1e-9;

constexpr const char* axis_names[3] = {" along s", " along t", " along u"};

/// One axis, prepared.
struct Axis {
  Axis(int count, int degree) : count(count), degree(degree), knots(detail::clamped_knots(count, degree)) {}
  Eigen::VectorXd basis(double u) const {
    const double inside = std::clamp(u, 0.0, 1.0);
    Eigen::VectorXd values = detail::spline_basis(degree, count, knots, inside);
    if (u != inside) values += (u - inside) * slope(inside);
    return values;
  }
  Eigen::VectorXd slope(double u) const { return detail::spline_basis_slope(degree, count, knots, u); }
  int count, degree;
  std::vector<double> knots;
};

std::array<Axis, 3> axes_of(const Lattice& lattice) {
  return {Axis(lattice.count[0], lattice.degree[0]), Axis(lattice.count[1], lattice.degree[1]),
          Axis(lattice.count[2], lattice.degree[2])};
}

Eigen::VectorXd product(const Eigen::VectorXd& s, const Eigen::VectorXd& t, const Eigen::VectorXd& u) {
  Eigen::VectorXd shares(s.size() * t.size() * u.size());
  Eigen::Index at = 0;
  for (Eigen::Index k = 0; k < u.size(); ++k)
    for (Eigen::Index j = 0; j < t.size(); ++j, at += s.size())
      shares.segment(at, s.size()) = t[j] * u[k] * s;
  return shares;
}

void require_fit(const Lattice& lattice, std::size_t control_count) {
  if (const std::string fault = fault_of(lattice, control_count); !fault.empty())
    throw invalid_input("lattice", fault);
}

/// The lattice's map of space, and its inverse by Newton's method.
class LatticeMap {
 public:
  LatticeMap(const Lattice& lattice, const PointsD& controls)
      : axes_(axes_of(lattice)),
        centre_(controls.colwise().mean()),
        controls_(controls.rowwise() - centre_),
        low_(controls_.colwise().minCoeff()),
        high_(controls_.colwise().maxCoeff()) {}

  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& point) const {
    const Eigen::RowVector3d goal = point.transpose() - centre_;
    const double accept = tolerance * std::max((high_ - low_).norm(), 1e-300);
    // No point leaves the hull of the control points.
    if (((goal.array() < low_.array() - accept) || (goal.array() > high_.array() + accept)).any()) return {};
    for (const Eigen::Vector3d& start : starts(goal))
      if (const auto found = newton(start, goal, accept)) return found;
    return {};
  }

 private:
  Eigen::RowVector3d at(const Eigen::Vector3d& c) const {
    return product(axes_[0].basis(c[0]), axes_[1].basis(c[1]), axes_[2].basis(c[2])).transpose() * controls_;
  }
  std::vector<Eigen::Vector3d> starts(const Eigen::RowVector3d& goal) const;
  std::optional<Eigen::Vector3d> newton(Eigen::Vector3d c, const Eigen::RowVector3d& goal,
                                        double accept) const;

  std::array<Axis, 3> axes_;
  Eigen::RowVector3d centre_;
  PointsD controls_;
  Eigen::RowVector3d low_, high_;
};

/// Samples of a grid, the nearest to the goal first.
std::vector<Eigen::Vector3d> LatticeMap::starts(const Eigen::RowVector3d& goal) const {
  std::array<std::vector<Eigen::VectorXd>, 3> bases;
  for (std::size_t a = 0; a < 3; ++a)
    for (int s = 0; s <= axes_[a].count; ++s)
      bases[a].push_back(axes_[a].basis(static_cast<double>(s) / axes_[a].count));
  struct Start {
    double distance;
    Eigen::Vector3d at;
  };
  std::vector<Start> all;
  const auto nx = bases[0][0].size(), ny = bases[1][0].size(), nz = bases[2][0].size();
  // One axis after the other: rows of controls, then of rows, then of layers.
  for (std::size_t k = 0; k < bases[2].size(); ++k) {
    PointsD layer = PointsD::Zero(nx * ny, 3);
    for (Eigen::Index z = 0; z < nz; ++z)
      layer += bases[2][k][z] * controls_.middleRows(z * nx * ny, nx * ny);
    for (std::size_t j = 0; j < bases[1].size(); ++j) {
      PointsD row = PointsD::Zero(nx, 3);
      for (Eigen::Index y = 0; y < ny; ++y) row += bases[1][j][y] * layer.middleRows(y * nx, nx);
      for (std::size_t i = 0; i < bases[0].size(); ++i) {
        const Eigen::RowVector3d sample = bases[0][i].transpose() * row;
        all.push_back({(sample - goal).squaredNorm(),
                       {static_cast<double>(i) / axes_[0].count, static_cast<double>(j) / axes_[1].count,
                        static_cast<double>(k) / axes_[2].count}});
      }
    }
  }
  const auto count = std::min<std::size_t>(most_starts, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(),
                    [](const Start& a, const Start& b) { return a.distance < b.distance; });
  std::vector<Eigen::Vector3d> nearest;
  for (std::size_t s = 0; s < count; ++s) nearest.push_back(all[s].at);
  return nearest;
}

std::optional<Eigen::Vector3d> LatticeMap::newton(Eigen::Vector3d c, const Eigen::RowVector3d& goal,
                                                  double accept) const {
  Eigen::RowVector3d rest = goal - at(c);
  for (int step = 0; step < most_steps && rest.norm() > accept; ++step) {
    std::array<Eigen::VectorXd, 3> basis, slope;
    for (int a = 0; a < 3; ++a) {
      basis[a] = axes_[a].basis(c[a]);
      slope[a] = axes_[a].slope(std::clamp(c[a], 0.0, 1.0));
    }
    Eigen::Matrix3d jacobian;
    jacobian.col(0) = (product(slope[0], basis[1], basis[2]).transpose() * controls_).transpose();
    jacobian.col(1) = (product(basis[0], slope[1], basis[2]).transpose() * controls_).transpose();
    jacobian.col(2) = (product(basis[0], basis[1], slope[2]).transpose() * controls_).transpose();
    Eigen::Vector3d way = jacobian.fullPivLu().solve(rest.transpose());
    if (!way.allFinite()) return {};
    if (way.norm() > longest_step) way *= longest_step / way.norm();
    bool closer = false;
    for (int half = 0; half < most_halvings && !closer; ++half, way /= 2) {
      const Eigen::RowVector3d left = goal - at(c + way);
      if (!(left.norm() < rest.norm())) continue;
      c += way;
      rest = left;
      closer = true;
    }
    if (!closer) break;
  }
  if (rest.norm() > accept || c.minCoeff() < -border || c.maxCoeff() > 1 + border) return {};
  return c.cwiseMax(0.0).cwiseMin(1.0);
}

}  // namespace

std::string fault_of(const Lattice& lattice, std::size_t control_count) {
  double total = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (lattice.count[a] < 2)
      return "has " + std::to_string(lattice.count[a]) + " control points" + axis_names[a] + ", 2 or more";
    if (lattice.degree[a] < 1 || lattice.degree[a] >= lattice.count[a])
      return "has degree " + std::to_string(lattice.degree[a]) + axis_names[a] + ", from 1 to " +
             std::to_string(lattice.count[a] - 1);
    total *= lattice.count[a];
  }
  if (total > most_controls) return "has more than " + std::to_string(most_controls) + " control points";
  if (static_cast<std::size_t>(lattice.control_count()) != control_count)
    return "is a grid of " + std::to_string(lattice.control_count()) + " control points, there are " +
           std::to_string(control_count);
  return {};
}

Eigen::VectorXd lattice_basis(const Lattice& lattice, const Eigen::Vector3d& coordinates) {
  const std::array<Axis, 3> axes = axes_of(lattice);
  const Eigen::Vector3d inside = coordinates.cwiseMax(0.0).cwiseMin(1.0);
  return product(axes[0].basis(inside[0]), axes[1].basis(inside[1]), axes[2].basis(inside[2]));
}

PointsD lattice_controls(const Lattice& lattice, const Box& box) {
  double grid = 1;
  for (const int count : lattice.count) grid *= count;
  require_fit(lattice, grid <= most_controls ? static_cast<std::size_t>(lattice.control_count()) : 0);
  const Eigen::Vector3d size = box.high - box.low;
  if (!size.allFinite() || !box.low.allFinite() || !(size.minCoeff() > 0))
    throw invalid_input("lattice", "fills a box without volume", "a box with three sides above 0");
  // Control points at the means of their knots: a spline of any degree is linear then.
  std::array<std::vector<double>, 3> places;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double> knots = detail::clamped_knots(lattice.count[a], lattice.degree[a]);
    for (int c = 0; c < lattice.count[a]; ++c)
      places[a].push_back(
          std::accumulate(knots.begin() + c + 1, knots.begin() + c + 1 + lattice.degree[a], 0.0) /
          lattice.degree[a]);
  }
  PointsD controls(lattice.control_count(), 3);
  Eigen::Index row = 0;
  for (const double u : places[2])
    for (const double t : places[1])
      for (const double s : places[0])
        controls.row(row++) = (box.low + size.cwiseProduct(Eigen::Vector3d(s, t, u))).transpose();
  return controls;
}

std::optional<Eigen::Vector3d> lattice_coordinates(const Lattice& lattice, const PointsD& controls,
                                                   const Eigen::Vector3d& point) {
  require_fit(lattice, static_cast<std::size_t>(controls.rows()));
  return LatticeMap(lattice, controls).inverse(point);
}

}  // namespace mien
