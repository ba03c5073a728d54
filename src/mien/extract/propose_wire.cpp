#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "mien/core/error.h"
#include "mien/deform/bind_wires.h"
#include "mien/deform/wires.h"
#include "mien/extract/detail/deltas.h"
#include "mien/extract/improve_wires.h"

namespace mien {
namespace {

constexpr double neighbourhood = 0.06;  ///< of the box: what counts as "around" a vertex

/// Per vertex of the part: the sum of squares that the wires leave over, by what the vertex counts.
Eigen::VectorXd energy_of(const Character& character, const ExtractResult& result, int part) {
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(character.parts[part].mesh.positions.rows());
  for (std::size_t s = 0; s < result.shapes.size(); ++s) {
    Points left = detail::dense_delta(character, character.shapes[s], part);
    for (const PartDelta& delta : result.shapes[s].rebuilt)
      if (delta.part == part)
        for (std::size_t i = 0; i < delta.vertices.size(); ++i)
          left.row(delta.vertices[i]) -= delta.deltas.row(static_cast<Eigen::Index>(i));
    energy += left.cast<double>().rowwise().squaredNorm();
  }
  if (!result.vertex_weights.empty() && result.vertex_weights[part].size() > 0)
    energy.array() *= result.vertex_weights[part].cast<double>().array();
  for (Eigen::Index v = 0; v < energy.size(); ++v) {
    const bool reached =
        std::any_of(result.character.wires.begin(), result.character.wires.end(), [&](const Wire& wire) {
          return std::any_of(wire.bindings.begin(), wire.bindings.end(), [&](const WireBinding& binding) {
            return binding.part == part &&
                   std::binary_search(binding.vertices.begin(), binding.vertices.end(), static_cast<int>(v));
          });
        });
    if (!reached) energy[v] = 0;
  }
  return energy;
}

}  // namespace

WireSketch propose_wire(const Character& character, const ExtractResult& result) {
  int part = -1;
  double most = 0;
  for (const WireFit& fit : result.shapes)
    if (fit.largest > most) {
      most = fit.largest;
      part = fit.part;
    }
  if (part < 0 || !(most > 0)) throw invalid_input("shapes", "are rebuilt without error", "nothing to add");
  const PointsD positions = bind_positions(character, part);
  const Eigen::VectorXd energy = energy_of(character, result, part);
  const double radius = neighbourhood * result.box;
  double best = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitX();
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    if (!(energy[v] > 0)) continue;
    double sum = 0;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Eigen::Index w = 0; w < positions.rows(); ++w) {
      const Eigen::Vector3d offset = (positions.row(w) - positions.row(v)).transpose();
      if (!(offset.squaredNorm() < radius * radius)) continue;
      sum += energy[w];
      spread += energy[w] * offset * offset.transpose();
    }
    if (sum <= best) continue;
    best = sum;
    centre = positions.row(v).transpose();
    direction = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  }
  WireSketch sketch;
  sketch.name = "extra_" + std::to_string(result.character.wires.size() + 1);
  sketch.feature = "extra";
  const auto nearest = [&](const Eigen::Vector3d& to) {
    Eigen::Index vertex = 0;
    double least = -1;
    for (Eigen::Index v = 0; v < positions.rows(); ++v)
      if (const double d = (positions.row(v).transpose() - to).squaredNorm();
          energy[v] > 0 && (least < 0 || d < least)) {
        least = d;
        vertex = v;
      }
    SurfacePoint point;
    point.part = part;
    point.vertex = static_cast<int>(vertex);
    return point;
  };
  for (const double along : {-1.0, -0.33, 0.33, 1.0}) {
    const SurfacePoint point = nearest(centre + along * radius * direction);
    if (sketch.points.empty() || sketch.points.back().vertex != point.vertex) sketch.points.push_back(point);
  }
  const WireBinder binder(character);
  while (sketch.points.size() > 1 && sketch.points.size() < 4)
    sketch.points.insert(sketch.points.begin() + 1, binder.between(sketch.points[0], sketch.points[1], 0.5));
  return sketch;
}

}  // namespace mien
