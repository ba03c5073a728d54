#pragma once
/// The thesis's pipeline (4.7.1): the baseline.

#include <vector>

#include "mien/transfer/correspondence.h"
#include "mien/transfer/register_surfaces.h"

namespace mien {

/// Dense correspondence as the thesis has it: the exact thin-plate spline of the landmarks, then every warped source
/// vertex projected to the closest point of the target (eq. 4.7), with no test of normals and nothing against folds.
/// Openness is left empty. Cost: one closest-point pass.
Registration thesis_registration(const Surface& source, const Surface& target,
                                 const PointsD& source_landmarks, const PointsD& target_landmarks);

/// Every target vertex's closest point on the guide (4.7.2), all accepted.
std::vector<SourcePoint> thesis_correspondence(const Registration& registration, const Surface& source,
                                               const Surface& target);

}  // namespace mien
