#pragma once
/// What a character's limit constraints leave of the ranges of a drag's joints.

#include <vector>

#include "mien/pose/solve_pins.h"

namespace mien::detail {

/// The joints with their ranges narrowed by the limits on their nodes that count from rest and are obeyed in full. Turns are taken
/// axis by axis: exact about one axis; beyond, evaluation limits what is left. A range that a limit does not meet becomes its nearer
/// end.
std::vector<DraggedJoint> within_limits(const Character& character, std::vector<DraggedJoint> joints);

}  // namespace mien::detail
