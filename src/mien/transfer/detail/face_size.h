#pragma once

#include "mien/geometry/mesh.h"

namespace mien::detail {

/// The face's size, the unit of all limits: the diagonal of the landmarks' box, held to what a face can be of its skin
/// because a few landmarks may sit close together.
double face_size(const PointsD& landmarks, const PointsD& skin);

}  // namespace mien::detail
