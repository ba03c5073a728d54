#include "mien/symmetry/find_mirror_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mien/core/error.h"
#include "mien/geometry/similarity.h"
#include "mien/geometry/surface_query.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

constexpr int most_samples = 4000;
constexpr int rounds = 8, last_rounds = 20;

/// All parts in model space at rest, as one surface.
struct WholeSurface {
  PointsD positions;
  Triangles triangles;
};

PointsD in_model_space(const Part& part, const std::vector<Eigen::Matrix4d>& model) {
  PointsD positions = part.mesh.positions.cast<double>();
  if (part.skin >= 0 || part.node < 0) return positions;
  const Eigen::Matrix4d& matrix = model[static_cast<std::size_t>(part.node)];
  positions = positions * matrix.topLeftCorner<3, 3>().transpose();
  positions.rowwise() += matrix.topRightCorner<3, 1>().transpose();
  return positions;
}

WholeSurface whole_surface(const Character& character) {
  const std::vector<Eigen::Matrix4d> model = model_matrices(character);
  WholeSurface whole;
  for (const Part& part : character.parts) {
    const PointsD positions = in_model_space(part, model);
    const Triangles triangles = triangulate(part.mesh.faces);
    const Eigen::Index first = whole.positions.rows(), first_triangle = whole.triangles.rows();
    whole.positions.conservativeResize(first + positions.rows(), Eigen::NoChange);
    whole.positions.bottomRows(positions.rows()) = positions;
    whole.triangles.conservativeResize(first_triangle + triangles.rows(), Eigen::NoChange);
    whole.triangles.bottomRows(triangles.rows()) = triangles.array() + static_cast<int>(first);
  }
  if (whole.triangles.rows() == 0) throw invalid_input("character", "has no faces", "give a surface");
  return whole;
}

/// Across the box's axes, x first, and across the axes of inertia, for heads that are turned.
std::vector<MirrorPlane> starts(const PointsD& samples, const Box& box) {
  std::vector<MirrorPlane> planes;
  for (int axis = 0; axis < 3; ++axis) planes.push_back({Eigen::Vector3d::Unit(axis), box.centre()[axis]});
  const Eigen::RowVector3d centre = samples.colwise().mean();
  const PointsD off = samples.rowwise() - centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> inertia(off.transpose() * off);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d normal = inertia.eigenvectors().col(axis);
    planes.push_back({normal, normal.dot(centre.transpose())});
  }
  return planes;
}

struct Fitter {
  const PointsD& samples;
  const SurfaceQuery& query;

  double mean_distance(const MirrorPlane& plane) const {
    double sum = 0;
    for (Eigen::Index s = 0; s < samples.rows(); ++s)
      sum += query.closest(plane.mirrored(samples.row(s).transpose())).distance;
    return sum / static_cast<double>(samples.rows());
  }

  /// One step of closest points: sample and partner should have the plane half-way between them.
  MirrorPlane refined(const MirrorPlane& plane) const {
    PointsD partners(samples.rows(), 3);
    Eigen::VectorXd weights(samples.rows());
    const double usual = std::max(mean_distance(plane), 1e-12);
    for (Eigen::Index s = 0; s < samples.rows(); ++s) {
      const SurfaceQuery::Hit hit = query.closest(plane.mirrored(samples.row(s).transpose()));
      partners.row(s) = hit.position.transpose();
      weights[s] = 1 / (1 + std::pow(hit.distance / usual, 2));
    }
    // The reflection nearest to sample -> partner: a rigid motion of the mirrored samples, which is a reflection again when
    // its rotation is taken half-way.
    PointsD mirrored(samples.rows(), 3);
    for (Eigen::Index s = 0; s < samples.rows(); ++s)
      mirrored.row(s) = plane.mirrored(samples.row(s).transpose()).transpose();
    const Similarity motion = fit_similarity(mirrored, partners, weights);
    const Eigen::AngleAxisd turn(motion.rotation);
    MirrorPlane next;
    next.normal = (Eigen::AngleAxisd(turn.angle() / 2, turn.axis()) * plane.normal).normalized();
    double offset = 0;
    for (Eigen::Index s = 0; s < samples.rows(); ++s)
      offset += weights[s] * next.normal.dot((samples.row(s) + partners.row(s)).transpose()) / 2;
    next.offset = offset / weights.sum();
    return next;
  }
};

/// Positive: names with a left side lie on the plane's left.
double left_vote(const Character& character, const MirrorPlane& plane,
                 const std::vector<Eigen::Matrix4d>& model) {
  const auto sign_of = [](const std::string& name) {
    const Side side = side_of_name(name);
    return side == Side::left ? 1.0 : side == Side::right ? -1.0 : 0.0;
  };
  std::vector<PointsD> positions;
  for (const Part& part : character.parts) positions.push_back(in_model_space(part, model));
  double vote = 0;
  for (const Landmark& landmark : character.landmarks) {
    const auto part = static_cast<std::size_t>(landmark.at.part);
    vote += sign_of(landmark.name) *
            plane.side(position_of(character.parts[part].mesh, positions[part].cast<float>(), landmark.at));
  }
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints)
      vote += sign_of(character.nodes[static_cast<std::size_t>(joint)].name) *
              plane.side(model[static_cast<std::size_t>(joint)].topRightCorner<3, 1>());
  for (const Shape& shape : character.shapes)
    for (const PartDelta& delta : shape.parts) {
      if (sign_of(shape.name) == 0) break;
      const PointsD& places = positions[static_cast<std::size_t>(delta.part)];
      for (std::size_t k = 0; k < delta.vertices.size(); ++k)
        vote += sign_of(shape.name) * delta.deltas.row(static_cast<Eigen::Index>(k)).norm() *
                (plane.side(places.row(delta.vertices[k]).transpose()) > 0 ? 1 : -1);
    }
  return vote;
}

}  // namespace

FoundPlane find_mirror_plane(const Character& character) {
  const WholeSurface whole = whole_surface(character);
  const SurfaceQuery query(whole.positions, whole.triangles);
  const Eigen::Index stride = std::max<Eigen::Index>(1, whole.positions.rows() / most_samples);
  PointsD samples((whole.positions.rows() + stride - 1) / stride, 3);
  for (Eigen::Index s = 0; s < samples.rows(); ++s) samples.row(s) = whole.positions.row(s * stride);
  const Fitter fitter{samples, query};
  const Box box = bounding_box(whole.positions);
  FoundPlane best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (MirrorPlane plane : starts(samples, box)) {
    for (int round = 0; round < rounds; ++round) plane = fitter.refined(plane);
    const double distance = fitter.mean_distance(plane);
    // Three-quarters: a nearly symmetric front and back (a ball) must not win over x by a hair.
    if (distance < 0.75 * best_distance) {
      best.plane = plane;
      best_distance = distance;
    }
  }
  for (int round = 0; round < last_rounds; ++round) best.plane = fitter.refined(best.plane);
  best_distance = fitter.mean_distance(best.plane);
  best.asymmetry = best_distance / std::max(box.diagonal(), 1e-300);
  const double vote = left_vote(character, best.plane, model_matrices(character));
  const bool flip = vote != 0 ? vote < 0 : best.plane.normal.x() < 0;
  if (flip) best.plane = {-best.plane.normal, -best.plane.offset};
  return best;
}

}  // namespace mien
