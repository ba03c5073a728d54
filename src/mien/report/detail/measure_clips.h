#pragma once

#include <vector>

#include "mien/report/detail/data.h"

namespace mien::detail {

/// Relative deformation curves of the source's first clips: between joints, and between landmarks on the surface.
std::vector<ClipRows> measure_clips(const ReportInput& input);

}  // namespace mien::detail
