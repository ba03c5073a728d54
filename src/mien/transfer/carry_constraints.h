#pragma once
/// Constraints and controls on the target's nodes and sliders.

#include <string>
#include <vector>

#include "mien/transfer/rig_map.h"

namespace mien {

/// The constraints whose nodes were carried, in their order. Translation limits grow as lengths do at the node; what is said in
/// model space (`up`, and the axes of nodes without a parent) turns with the face; what is said in a node's own frame turned with
/// it already. Limits of a node without a parent become the box around their turned box: the same limits where the face turns by
/// right angles. What lies between nodes at rest follows their rests.
///   target   with the carried nodes in place
///   dropped  receives one line a constraint or source that is left behind because its node was not carried
std::vector<Constraint> carry_constraints(const Character& source, const Character& target, const RigMap& map,
                                          std::vector<std::string>& dropped);

/// The controls whose sliders and nodes were carried; mirror pairs name each other as before.
///   slider_of  per source slider: its index in the target, -1: not carried
std::vector<Control> carry_controls(const Character& source, const std::vector<int>& slider_of,
                                    const std::vector<int>& node_of, std::vector<std::string>& dropped);

}  // namespace mien
