#pragma once

#include <vector>

#include "mien/report/detail/data.h"

namespace mien::detail {

/// The joints that hold most skin weight around the target's face, at most `most`, with their counterpart by name.
std::vector<JointRow> measure_joints(const ReportInput& input, std::size_t most);

/// One joint's skin weight, one #V a part; parts without skin weights are left empty.
std::vector<Eigen::VectorXf> weight_map(const Character& character, int node);

}  // namespace mien::detail
