#pragma once
/// Putting carried attributes into the target's own parts and vertex order.

#include <vector>

#include "mien/character/character.h"
#include "mien/transfer/carry_skeleton.h"
#include "mien/transfer/carry_skin_weights.h"
#include "mien/transfer/carry_uvs.h"
#include "mien/transfer/detail/pool.h"

namespace mien::detail {

/// The target without its rig: meshes, UVs, materials, landmarks. With `skinned`, each part gets a root node of its own
/// and its vertices in model space (a skin ignores the node's transform); else the nodes that hold parts stay as they
/// are, with their ancestors.
Character bare_target(const Character& target, const Pool& pool, bool skinned);

/// A shape of `character` (the bare target) from displacements of pooled vertices (#W x 3, model space); those shorter
/// than `least` are left out. Every part that holds the displaced gets an entry, the first part always.
Shape shape_of_target(const Shape& source, const Pool& pool, const Character& character,
                      const PointsD& displacement, double least);

/// The number of triangles whose normal turns by more than a right angle under `deltas` (#V x 3).
int flipped_triangles(const Surface& surface, const PointsD& deltas);

/// Skin weights of pooled vertices (#W x #J), parts that hang below a joint bound to it.
WeightMatrix pooled_skin_weights(const Character& source, const Pool& pool, const JointList& joints);

WeightMatrix select_rows(const WeightMatrix& matrix, const std::vector<int>& rows);

/// Gives part `part`'s skin faces UVs from the guide; faces off the skin get none. Leaves the mesh alone when no face
/// of it is skin.
void assign_uvs(const UvLayout& source, const PointsD& guide, const Pool& pool, const PoolSurface& skin,
                int part, Mesh& mesh);

/// The material with a base-colour image that most triangles of the source's skin have; -1: none.
int skin_material(const Character& source, const Pool& pool, const PoolSurface& skin);

/// Puts a material on the faces that have UVs, where nothing but plain colours was.
void hang_material(int material, const Appearance& looks, Mesh& mesh);

}  // namespace mien::detail
