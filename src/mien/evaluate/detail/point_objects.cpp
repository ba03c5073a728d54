#include "mien/evaluate/detail/point_objects.h"

namespace mien::detail {

PointObjects::PointObjects(const Character& character, const ConstraintSolver& constraints,
                           const PointSites& sites)
    : sites_(sites), layout_(character, constraints), weights_(character.shapes.size()) {
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    for (const ObjectMove& move : character.shapes[s].objects)
      if (move.controls.rows() > 0) shape_moves_.push_back({static_cast<int>(s), move});
}

void PointObjects::move(const std::vector<Transform>& locals, const Eigen::MatrixXd& weights,
                        std::span<const ObjectMove> moves, PartMotions& motions) {
  for (std::size_t p = 0; p < motions.size(); ++p) {
    weights_.values = weights.col(static_cast<Eigen::Index>(p));
    motions[p].place_nodes(layout_, locals);
    motions[p].set(layout_, weights_, moves);
  }
}

Eigen::Vector3d PointObjects::shift(const Site& site, const Eigen::Vector3d& bare,
                                    const PartMotions& motions) const {
  const int part = sites_.parts[site.column];
  const Eigen::Vector3d bound = layout_.field().to_model(part) * bare.homogeneous();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = site.object_begin; k < site.object_end; ++k) {
    const SiteObject& object = sites_.objects[k];
    const ObjectPose& pose = motions[site.column].poses()[object.object];
    if (!pose.moves) continue;
    if (layout_.is_frame(object.object)) sum += object.weight * (pose.frame * bound.homogeneous() - bound);
    for (int e = object.begin; e < object.end; ++e)
      sum += object.weight * sites_.shares[e].coefficient *
             pose.displacements.row(sites_.shares[e].control).transpose();
  }
  return layout_.field().to_part(part) * sum;
}

Eigen::Matrix3d PointObjects::turn(const Site& site, const PartMotions& motions) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int k = site.object_begin; k < site.object_end; ++k) {
    const SiteObject& object = sites_.objects[k];
    const ObjectPose& pose = motions[site.column].poses()[object.object];
    if (pose.moves && layout_.is_frame(object.object))
      sum += object.weight * (pose.frame.leftCols<3>() - Eigen::Matrix3d::Identity());
  }
  const int part = sites_.parts[site.column];
  return Eigen::Matrix3d::Identity() +
         layout_.field().to_part(part) * sum * layout_.field().to_model(part).leftCols<3>();
}

Eigen::Vector3d PointObjects::slope(const Site& site, const ObjectMove& move,
                                    const PartMotions& motions) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = site.object_begin; k < site.object_end; ++k) {
    const SiteObject& object = sites_.objects[k];
    if (object.object != move.object) continue;
    const ObjectPose& pose = motions[site.column].poses()[object.object];
    const auto carried = [&](int control) -> Eigen::Vector3d {
      const Eigen::Vector3d shift = move.controls.row(control).transpose();
      return pose.moves ? pose.motions[static_cast<std::size_t>(control)].leftCols<3>() * shift : shift;
    };
    if (layout_.is_frame(object.object)) sum += object.weight * carried(0);
    for (int e = object.begin; e < object.end; ++e)
      sum += object.weight * sites_.shares[e].coefficient * carried(sites_.shares[e].control);
  }
  return layout_.field().to_part(sites_.parts[site.column]) * sum;
}

}  // namespace mien::detail
