#pragma once
/// What an influence object reaches on the skin, and which joints carry its control points.

#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/object_sketch.h"

namespace mien {

/// The object's bindings on the character as bound. A vertex takes its point of the object:
///   curve, surface     the closest point's basis
///   lattice            the basis at its coordinates; vertices outside are not bound. The weight is `strength` times the fades of the
///                      three axes
///   mesh               barycentric coordinates of the closest points of the nearest triangles, which share the vertex with the
///                      weights ((R - d) / (R d))^2, R the distance of the first triangle left out (Franke and Nielson 1980): smooth
///                      across the mesh's edges, and exact on the mesh
///   cluster, locator   its frame
///   throws  invalid_input: what fault_of finds; a range, fade or strength that is none; a part or vertex out of range; drawn weights
///           outside of (0, 1]; an object that reaches no vertex
///   cost    about 50 us a vertex in reach, on all cores
std::vector<InfluenceBinding> bind_influence(const Character& character, const InfluenceObject& object,
                                             const InfluenceReach& reach);

/// Skin weights of control points: those of the skin's closest points, for points on the skin its own.
///   controls  #C x 3, model space, bind pose
///   skin      whose parts are asked
///   only      nodes that may carry; none: all joints of the skin. What the others would carry goes to them in proportion; a control
///             point that none of them carries follows the first
///   throws    invalid_input: a skin that does not exist or that no part has, a node that is not one of its joints
SkinWeights bind_controls(const Character& character, const PointsD& controls, int skin,
                          std::span<const int> only = {});

}  // namespace mien
