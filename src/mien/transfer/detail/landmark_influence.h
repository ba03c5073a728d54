#pragma once
/// How far landmarks reach over a surface, and how exact they are.

#include <Eigen/Core>
#include <vector>

#include "mien/geometry/surface_query.h"
#include "mien/transfer/register_surfaces.h"

namespace mien::detail {

/// The places of a surface closest to the points, in their order.
std::vector<SurfaceQuery::Hit> closest_points(const SurfaceQuery& surface, const PointsD& points);

/// Places that face somewhere, #V x 6: turned away by a radian is as far as `turn`.
Eigen::MatrixXd facing(const PointsD& positions, const PointsD& normals, double turn);

/// #V: 0 within `near` of a landmark, 1 from `far` on, smooth between; 1 where there are none.
///   landmarks, places  #L and #V rows of as many coordinates: places in space, or `facing`
Eigen::VectorXd far_from(const Eigen::MatrixXd& landmarks, const Eigen::MatrixXd& places, double near,
                         double far);

/// #L: how much further off than a well-clicked landmark of a fine mesh each of these may be, squared. One that sits on a
/// vertex had no better vertex near: it may belong a seventh of an edge away.
///   unit  the face's size; a landmark is clicked as well as half a percent of it
Eigen::VectorXd landmark_spread(const std::vector<SurfaceQuery::Hit>& at, const Surface& surface,
                                double unit);

}  // namespace mien::detail
