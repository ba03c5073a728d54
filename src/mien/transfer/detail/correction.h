#pragma once
/// Given points correct what was found: a smooth field through their residuals, mirrored where one side is given alone.

#include <Eigen/Core>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien::detail {

/// One given point: where it is on the template and how far it is from where it was found, both canonical.
struct Residual {
  int row = 0;  ///< of the template's points
  Eigen::RowVector3d at = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d value = Eigen::RowVector3d::Zero();
};

/// Adds, for residuals whose mirror row has none, the mirror image.
///   mirror  per row of the template's points: the row on the other side, -1: none
std::vector<Residual> with_mirror_images(const std::vector<Residual>& given, const PointsD& points,
                                         const std::vector<int>& mirror);

/// The field's values at `points` (#P x 3): Gaussian-process regression of zero mean with kernel exp(-d / 0.25) and the
/// noise of a clicked point; falls to zero away from the residuals.
PointsD correction(const std::vector<Residual>& residuals, const PointsD& points);

/// #G: each given residual minus what the others (and their mirror images) say about it.
PointsD surprises(const std::vector<Residual>& given, const PointsD& points, const std::vector<int>& mirror);

}  // namespace mien::detail
