#pragma once
/// What is wrong with pins and options before anything is solved.

#include <string>
#include <vector>

#include "mien/pose/solve_pins.h"

namespace mien::detail {

///   throws  invalid_input: as PinSolver says, but for what only the rig's derivative shows
///   others_move  something besides sliders may move
void check_pins(const Character& character, const std::vector<Pin>& pins, bool others_move = false);
void check_start(const Character& character, const RigPose& start);
void check_options(const Character& character, const SolvePinsOptions& options);

/// Hard pins that sit on one point must agree; goals are absolute here, `tolerance` a length.
void check_hard_pins(const std::vector<Pin>& pins, double tolerance);

/// Throws unless the point lies on a part of the character.
void check_surface_point(const Character& character, const SurfacePoint& point, const std::string& place);

/// "pin 3": pins count from 1 in messages.
std::string pin_name(std::size_t index);

}  // namespace mien::detail
