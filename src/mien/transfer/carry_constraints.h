#pragma once
/// Constraints and controls of one character on another that got its joints and sliders.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/transfer/carry_skeleton.h"

namespace mien {

/// The source's constraints on the carried skeleton. Turns about a node's own axes and shares stay; lengths grow as the node's
/// translations do; what counts from the parent's frame, or from model space (the up direction), moves as the node's rest does.
///   target   has the carried nodes
///   dropped  receives one line a constraint that needs a node which was not carried
std::vector<Constraint> carry_constraints(const Character& source, const Character& target,
                                          const CarriedSkeleton& skeleton, std::vector<std::string>& dropped);

/// The source's control interface; sliders keep their numbers, nodes get those of the carried skeleton. Controls of what was not carried
/// are left out.
std::vector<Control> carry_controls(const Character& source, const Character& target,
                                    const CarriedSkeleton& skeleton, std::vector<std::string>& dropped);

}  // namespace mien
