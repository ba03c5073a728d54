#pragma once
/// Lid margins and the lip line, found without names: level curves of openness around the largest cavities; and the
/// border where a neck ends.

#include <array>
#include <vector>

#include "mien/transfer/detail/displacement_solver.h"
#include "mien/transfer/register_surfaces.h"

namespace mien::detail {

/// A piece of a level curve inside one triangle.
struct CurvePiece {
  std::array<int, 3> vertices{};
  std::array<double, 3> from{}, to{};  ///< barycentric ends
  int level = 0;
};

/// The level curves of `openness` at 0.3, 0.5 and 0.7 around the three largest connected regions below 0.3: on a head
/// the mouth and the eyes. Surfaces with open holes in their place have none there. Then, as a level of its own, the
/// surface's open borders that are longer than `least_border` (a neck's; not the rims of open eyes).
std::vector<CurvePiece> feature_curves(const Surface& surface, const Eigen::VectorXd& openness,
                                       double least_border);

/// Wishes that pull the moving surface's curves across onto the fixed surface's and let them slide along, both ways; each
/// level and direction has the weights' sum `weight`. Matches further than a few medians, or 0.05, are rejected.
///   positions in face sizes
std::vector<Wish> match_curves(const std::vector<CurvePiece>& moving, const Surface& moving_surface,
                               const std::vector<CurvePiece>& fixed, const Surface& fixed_surface,
                               double weight);

}  // namespace mien::detail
