#pragma once
/// The UVs of pieces of a pool.

#include <optional>

#include "mien/transfer/detail/pool.h"
#include "mien/transfer/uv_layout.h"

namespace mien::detail {

/// The surface's first UV set by triangle, nothing when no part of it has UVs.
std::optional<UvLayout> uv_layout(const Character& character, const Pool& pool, const PoolSurface& surface);

}  // namespace mien::detail
