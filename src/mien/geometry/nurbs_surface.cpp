#include "mien/geometry/nurbs_surface.h"

#include "mien/core/error.h"
#include "mien/geometry/detail/spline_basis.h"

namespace mien {
std::string fault_of(const NurbsSurface& surface, std::size_t vertex_count) {
  const std::string points = "control vertices";
  if (const std::string fault =
          detail::fault_of_knots(points, " along u", surface.degree_u, surface.count_u, surface.knots_u);
      !fault.empty())
    return fault;
  if (const std::string fault =
          detail::fault_of_knots(points, " along v", surface.degree_v, surface.count_v, surface.knots_v);
      !fault.empty())
    return fault;
  const std::size_t grid =
      static_cast<std::size_t>(surface.count_u) * static_cast<std::size_t>(surface.count_v);
  if (grid != vertex_count)
    return "is a grid of " + std::to_string(grid) + " control vertices, there are " +
           std::to_string(vertex_count);
  return detail::fault_of_weights(points, grid, surface.weights);
}

Eigen::VectorXd nurbs_basis(const NurbsSurface& surface, double u, double v) {
  const Eigen::VectorXd along_u = detail::spline_basis(surface.degree_u, surface.count_u, surface.knots_u, u);
  const Eigen::VectorXd along_v = detail::spline_basis(surface.degree_v, surface.count_v, surface.knots_v, v);
  const Eigen::MatrixXd grid = along_u * along_v.transpose();
  return detail::rational(Eigen::Map<const Eigen::VectorXd>(grid.data(), grid.size()), surface.weights);
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
