#pragma once
/// Where a head is: many placements of one template head, each improved by closest points, the best one kept.

#include <Eigen/Core>
#include <vector>

#include "mien/core/progress.h"
#include "mien/transfer/detail/template_head.h"

namespace mien::detail {

/// x -> scale R (I + E) x + translation, E symmetric: a similarity and how the head is wider, longer or deeper.
struct Placement {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Matrix3d linear() const { return scale * rotation * (Eigen::Matrix3d::Identity() + strain); }
  PointsD operator()(const PointsD& points) const {
    return (points * linear().transpose()).rowwise() + translation.transpose();
  }
};

/// How badly a placed template fits, in face sizes; smaller is better.
struct PlacementScore {
  double forward = 0;   ///< template to target: clipped distance, more weight on the face
  double backward = 0;  ///< target's open skin around the face to template
  double turned = 0;    ///< 1 - cosine between the normals, of what lies close
  double strain = 0;    ///< |E|
  double relief = 0;    ///< correlation of what stands out on the two faces
  double total() const {
    return forward + backward + 0.05 * turned + 0.05 * strain * strain + 0.05 * (1 - relief);
  }
};

struct PlacedHead {
  Placement placement;  ///< canonical template space to the target's model space
  PlacementScore score;
};

/// A point of the template that is known to be somewhere on the target.
struct KnownPoint {
  Eigen::Vector3d at;    ///< canonical template space
  Eigen::Vector3d goal;  ///< target's model space
};

/// Robust iterative closest points from many starts (research recipe of five scales, three heights and three pitches,
/// first upright, then in 60 orientations when no upright one fits), on few samples, then the best on more, then the
/// last with strains. Known points, where there are three or more, give starts of their own and pull.
///   cost  about 0.5 s upright, 2 s otherwise
std::vector<PlacedHead> place_head(const TemplateHead& head, const SoughtHead& target,
                                   const std::vector<KnownPoint>& known, const Progress& progress);

}  // namespace mien::detail
