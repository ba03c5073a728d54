#pragma once

#include "mien/geometry/mesh.h"

namespace mien::detail {

/// The face's size, the unit of all limits: 3.6 times the landmarks' rms distance from their mean, which for the 68 iBUG
/// points is their box's diagonal and hardly changes when points on ears, crown or neck join them; held to what a face
/// can be of its skin, because a few landmarks may sit close together.
double face_size(const PointsD& landmarks, const PointsD& skin);

}  // namespace mien::detail
