#pragma once
/// What is wrong with skin weights, of vertices and of control points.

#include <optional>

#include "mien/character/validate.h"

namespace mien::detail {

/// The first problem of the skin weights of `count` rows.
///   place  of the thing that has them
///   row    what a row is called: "vertex"
std::optional<Problem> skin_problem(const SkinWeights& skin, std::size_t count, std::size_t joint_count,
                                    const std::string& place, const std::string& row);

}  // namespace mien::detail
