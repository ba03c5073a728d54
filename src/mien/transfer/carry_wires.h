#pragma once
/// Wires on the target: reference curves, reach, and what shapes do to them.

#include <string>
#include <vector>

#include "mien/transfer/rig_map.h"

namespace mien {

/// All wires of the source in their order. Control points of the reference curve go through the map of space; ranges grow as
/// lengths do at the curve. Falloff and parameter of each vertex are carried along the correspondence, hand-made corrections
/// included; where it mixes vertices of distant parameters (the corners of a mouth) the parameter is that of the curve's closest
/// point. The surface points that a wire was drawn through go along when all of them have a place on the target.
///   cost  linear in the bindings' entries
std::vector<Wire> carry_wires(const Character& source, const Character& target, const RigMap& map);

/// What a shape does with the wires: control points' displacements by the rule of the skin's, turns turned with the face, scales
/// as they are; all times `factor`.
std::vector<WireMove> carry_wire_moves(const Character& source, const std::vector<WireMove>& moves,
                                       const RigMap& map, double factor);

/// Where on the source a wire's turn acts: the middle of its part of the curve.
Eigen::Vector3d turn_place(const Wire& wire, int turn);

}  // namespace mien
