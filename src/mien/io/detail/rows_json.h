#pragma once
/// Rows of three doubles as a flat array of JSON numbers, which keeps every bit.

#include <vector>

#include "mien/geometry/mesh.h"
#include "mien/io/detail/json.h"

namespace mien::detail {

Json rows_json(const PointsD& rows);

/// The rows of a flat array; what is left over after the last whole row is left out.
PointsD rows_of(const std::vector<double>& numbers);

}  // namespace mien::detail
