#include "mien/geometry/nurbs_surface.h"

#include <algorithm>
#include <cmath>

#include "mien/core/error.h"

namespace mien {
namespace {

constexpr int most_degree = 16;

std::string fault_along(const char* axis, int degree, int count, const std::vector<double>& knots) {
  if (degree < 1 || degree > most_degree)
    return "has degree " + std::to_string(degree) + " along " + axis + ", from 1 to " +
           std::to_string(most_degree);
  if (count <= degree)
    return "has " + std::to_string(count) + " control vertices along " + axis + ", more than its degree " +
           std::to_string(degree);
  if (knots.size() != static_cast<std::size_t>(count) + static_cast<std::size_t>(degree) + 1)
    return "has " + std::to_string(knots.size()) + " knots along " + axis + ", " +
           std::to_string(count + degree + 1) + " are needed";
  for (std::size_t k = 0; k < knots.size(); ++k)
    if (!std::isfinite(knots[k]) || (k > 0 && knots[k] < knots[k - 1]))
      return std::string("has knots along ") + axis + " that descend or are not finite";
  if (!(knots[static_cast<std::size_t>(degree)] < knots[static_cast<std::size_t>(count)]))
    return std::string("has knots along ") + axis + " without a domain";
  return {};
}

/// The basis functions of one direction (Piegl and Tiller, A2.1 and A2.2), zero ones included.
Eigen::VectorXd basis_along(int degree, int count, const std::vector<double>& knots, double u) {
  const auto knot = [&](int k) { return knots[static_cast<std::size_t>(k)]; };
  u = std::clamp(u, knot(degree), knot(count));
  int span =
      static_cast<int>(std::upper_bound(knots.begin() + degree, knots.begin() + count, u) - knots.begin()) -
      1;
  span = std::clamp(span, degree, count - 1);
  while (span > degree && knot(span) == knot(span + 1)) --span;
  std::vector<double> values(static_cast<std::size_t>(degree) + 1, 0.0);
  values[0] = 1;
  for (int d = 1; d <= degree; ++d) {
    double carried = 0;
    for (int r = 0; r < d; ++r) {
      const double left = u - knot(span + 1 - d + r), right = knot(span + 1 + r) - u;
      const double share = values[static_cast<std::size_t>(r)] / (right + left);
      values[static_cast<std::size_t>(r)] = carried + right * share;
      carried = left * share;
    }
    values[static_cast<std::size_t>(d)] = carried;
  }
  Eigen::VectorXd basis = Eigen::VectorXd::Zero(count);
  for (int d = 0; d <= degree; ++d) basis[span - degree + d] = values[static_cast<std::size_t>(d)];
  return basis;
}

}  // namespace

std::string fault_of(const NurbsSurface& surface, std::size_t vertex_count) {
  if (const std::string fault = fault_along("u", surface.degree_u, surface.count_u, surface.knots_u);
      !fault.empty())
    return fault;
  if (const std::string fault = fault_along("v", surface.degree_v, surface.count_v, surface.knots_v);
      !fault.empty())
    return fault;
  const std::size_t grid =
      static_cast<std::size_t>(surface.count_u) * static_cast<std::size_t>(surface.count_v);
  if (grid != vertex_count)
    return "is a grid of " + std::to_string(grid) + " control vertices, there are " +
           std::to_string(vertex_count);
  if (!surface.weights.empty() && surface.weights.size() != grid)
    return "has " + std::to_string(surface.weights.size()) + " weights, there are " + std::to_string(grid) +
           " control vertices";
  for (const double weight : surface.weights)
    if (!std::isfinite(weight) || !(weight > 0)) return "has a weight that is not above 0";
  return {};
}

Eigen::VectorXd nurbs_basis(const NurbsSurface& surface, double u, double v) {
  const Eigen::VectorXd along_u = basis_along(surface.degree_u, surface.count_u, surface.knots_u, u);
  const Eigen::VectorXd along_v = basis_along(surface.degree_v, surface.count_v, surface.knots_v, v);
  const Eigen::MatrixXd grid = along_u * along_v.transpose();
  Eigen::VectorXd basis = Eigen::Map<const Eigen::VectorXd>(grid.data(), grid.size());
  if (!surface.weights.empty())
    basis = basis.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(surface.weights.data(), basis.size()));
  return basis / basis.sum();
}

Mesh tessellate(const NurbsSurface& surface, const PointsD& controls, int samples_u, int samples_v) {
  if (const std::string fault = fault_of(surface, static_cast<std::size_t>(controls.rows())); !fault.empty())
    throw invalid_input("spline surface", fault);
  if (samples_u < 2 || samples_v < 2)
    throw invalid_input("tessellation", "has fewer than 2 samples along a side", "give 2 or more");
  const auto parameter = [](const std::vector<double>& knots, int degree, int count, int sample,
                            int samples) {
    const double low = knots[static_cast<std::size_t>(degree)], high = knots[static_cast<std::size_t>(count)];
    return low + (high - low) * sample / (samples - 1);
  };
  Mesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(samples_u) * samples_v, 3);
  for (int j = 0; j < samples_v; ++j)
    for (int i = 0; i < samples_u; ++i) {
      const double u = parameter(surface.knots_u, surface.degree_u, surface.count_u, i, samples_u);
      const double v = parameter(surface.knots_v, surface.degree_v, surface.count_v, j, samples_v);
      mesh.positions.row(static_cast<Eigen::Index>(j) * samples_u + i) =
          (nurbs_basis(surface, u, v).transpose() * controls).cast<float>();
    }
  for (int j = 0; j + 1 < samples_v; ++j)
    for (int i = 0; i + 1 < samples_u; ++i) {
      const int corner = j * samples_u + i;
      mesh.faces.push_back({corner, corner + 1, corner + 1 + samples_u, corner + samples_u});
    }
  return mesh;
}

}  // namespace mien
