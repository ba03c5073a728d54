#include "mien/deform/detail/influence_target.h"

#include <algorithm>
#include <map>

#include "mien/geometry/nurbs_query.h"
#include "mien/geometry/surface_query.h"
#include "mien/geometry/triangle.h"

namespace mien::detail {
namespace {

/// Shares below this move nothing that a float would hold.
constexpr double least_share = 1e-6;
constexpr int samples_a_control = 16;

ControlShares sparse(const Eigen::VectorXd& dense) {
  ControlShares shares;
  double total = 0;
  for (Eigen::Index c = 0; c < dense.size(); ++c)
    if (dense[c] > least_share) {
      shares.emplace_back(static_cast<int>(c), dense[c]);
      total += dense[c];
    }
  for (auto& [control, share] : shares) share /= total;
  return shares;
}

class CurveTarget : public InfluenceTarget {
 public:
  CurveTarget(const NurbsCurve& curve, const PointsD& controls)
      : curve_(curve), controls_(controls), query_(curve, controls) {}
  double distance(const Eigen::Vector3d& point) const override { return query_.rough_distance(point); }
  ControlShares shares(const Eigen::Vector3d& point) const override {
    return sparse(nurbs_basis(curve_, query_.closest(point).u));
  }
  PointsD samples() const override {
    return tessellate(curve_, controls_, samples_a_control * curve_.control_count());
  }

 private:
  NurbsCurve curve_;
  PointsD controls_;
  NurbsCurveQuery query_;
};

class SurfaceTarget : public InfluenceTarget {
 public:
  SurfaceTarget(const NurbsSurface& surface, const PointsD& controls)
      : surface_(surface), controls_(controls), query_(surface, controls) {}
  double distance(const Eigen::Vector3d& point) const override { return query_.closest(point).distance; }
  ControlShares shares(const Eigen::Vector3d& point) const override {
    const auto hit = query_.closest(point);
    return sparse(nurbs_basis(surface_, hit.u, hit.v));
  }
  PointsD samples() const override {
    return tessellate(surface_, controls_, samples_a_control / 2 * surface_.count_u,
                      samples_a_control / 2 * surface_.count_v)
        .positions.cast<double>();
  }

 private:
  NurbsSurface surface_;
  PointsD controls_;
  NurbsSurfaceQuery query_;
};

class MeshTarget : public InfluenceTarget {
 public:
  MeshTarget(const WrapMesh& mesh, const PointsD& controls, int smoothing)
      : triangles_(triangulate(mesh.faces)),
        controls_(controls),
        query_(controls, triangles_),
        smoothing_(static_cast<std::size_t>(smoothing)) {}
  double distance(const Eigen::Vector3d& point) const override { return query_.closest(point).distance; }
  ControlShares shares(const Eigen::Vector3d& point) const override;
  PointsD samples() const override {
    PointsD all(controls_.rows() + triangles_.rows(), 3);
    all.topRows(controls_.rows()) = controls_;
    for (Eigen::Index t = 0; t < triangles_.rows(); ++t)
      all.row(controls_.rows() + t) = (controls_.row(triangles_(t, 0)) + controls_.row(triangles_(t, 1)) +
                                       controls_.row(triangles_(t, 2))) /
                                      3;
    return all;
  }

 private:
  Triangles triangles_;
  PointsD controls_;
  SurfaceQuery query_;
  std::size_t smoothing_;
};

ControlShares MeshTarget::shares(const Eigen::Vector3d& point) const {
  struct Near {
    double distance;
    int triangle;
    Eigen::Vector3d barycentric;
  };
  std::vector<Near> all;
  for (int t = 0; t < static_cast<int>(triangles_.rows()); ++t) {
    const TrianglePoint closest = closest_point_on_triangle(
        point, controls_.row(triangles_(t, 0)).transpose(), controls_.row(triangles_(t, 1)).transpose(),
        controls_.row(triangles_(t, 2)).transpose());
    all.push_back({(closest.position - point).norm(), t, closest.barycentric});
  }
  const std::size_t kept = std::min(smoothing_, all.size());
  const std::size_t sorted = std::min(kept + 1, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(sorted), all.end(),
                    [](const Near& a, const Near& b) {
                      return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
                    });
  // All of a small mesh: as if one more triangle lay at twice the largest distance.
  const double outer = sorted > kept ? all[kept].distance : 2 * all[kept - 1].distance;
  std::map<int, double> sums;
  double total = 0;
  const auto add = [&](const Near& near, double weight) {
    for (int k = 0; k < 3; ++k) sums[triangles_(near.triangle, k)] += weight * near.barycentric[k];
    total += weight;
  };
  const double touching = 1e-9 * outer;
  for (std::size_t k = 0; k < kept && all[0].distance > touching; ++k) {
    const double gap = (outer - all[k].distance) / (outer * all[k].distance);
    if (gap > 0) add(all[k], gap * gap);
  }
  if (!(total > 0)) add(all[0], 1);
  ControlShares shares;
  for (const auto& [control, sum] : sums)
    if (sum > least_share * total) shares.emplace_back(control, sum / total);
  return shares;
}

class LatticeTarget : public InfluenceTarget {
 public:
  LatticeTarget(const Lattice& lattice, const PointsD& controls) : lattice_(lattice), controls_(controls) {}
  double distance(const Eigen::Vector3d&) const override { return 0; }
  ControlShares shares(const Eigen::Vector3d& point) const override {
    const auto coordinates = lattice_coordinates(lattice_, controls_, point);
    return coordinates ? sparse(lattice_basis(lattice_, *coordinates)) : ControlShares{};
  }
  PointsD samples() const override { return controls_; }

 private:
  Lattice lattice_;
  PointsD controls_;
};

class FrameTarget : public InfluenceTarget {
 public:
  explicit FrameTarget(const PointsD& controls) : controls_(controls) {}
  double distance(const Eigen::Vector3d& point) const override {
    return (controls_.row(0).transpose() - point).norm();
  }
  ControlShares shares(const Eigen::Vector3d&) const override { return {}; }
  PointsD samples() const override { return controls_; }

 private:
  PointsD controls_;
};

}  // namespace

std::unique_ptr<InfluenceTarget> target_of(const InfluenceObject& object, int smoothing) {
  if (const auto* curve = std::get_if<NurbsCurve>(&object.form))
    return std::make_unique<CurveTarget>(*curve, object.controls);
  if (const auto* surface = std::get_if<NurbsSurface>(&object.form))
    return std::make_unique<SurfaceTarget>(*surface, object.controls);
  if (const auto* mesh = std::get_if<WrapMesh>(&object.form))
    return std::make_unique<MeshTarget>(*mesh, object.controls, smoothing);
  if (const auto* lattice = std::get_if<Lattice>(&object.form))
    return std::make_unique<LatticeTarget>(*lattice, object.controls);
  return std::make_unique<FrameTarget>(object.controls);
}

}  // namespace mien::detail
