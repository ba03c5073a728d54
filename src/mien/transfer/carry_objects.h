#pragma once
/// Influence objects on the target (thesis 4.7.2 and 4.7.3): where their control points are, what they are bound to, what they
/// move.

#include <string>
#include <vector>

#include "mien/transfer/rig_map.h"

namespace mien {

/// All objects of the source in their order. Control points go through the map of space, as joints do; degrees, knots, rational
/// weights, lattice and mesh structure stay. Weight maps and coefficients are carried along the correspondence, each target vertex
/// the mix of its source vertices' rows, so that a vertex's coefficients still sum to one.
///   target   the parts that the bindings name
///   dropped  receives one line an object whose node was not carried: it stays where it is then
///   cost     linear in the bindings' entries
std::vector<InfluenceObject> carry_objects(const Character& source, const Character& target,
                                           const RigMap& map, std::vector<std::string>& dropped);

/// What a shape does to the objects: displacements of control points by the rule of the skin's, times `factor`.
std::vector<ObjectMove> carry_object_moves(const Character& source, const std::vector<ObjectMove>& moves,
                                           const RigMap& map, double factor);

}  // namespace mien
