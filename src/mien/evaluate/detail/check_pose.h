#pragma once
/// What every evaluator asks of a pose, and of what slopes are taken by.

#include "mien/character/character.h"
#include "mien/character/pose.h"
#include "mien/evaluate/point_evaluator.h"

namespace mien::detail {

///   throws  invalid_input: a number of locals or shape weights other than the character's, one that is not finite, an
///           exception for a part or a shape that does not exist
void check_pose(const Character& character, const Pose& pose);

/// The shape weights on one part: the pose's own with its exceptions for that part.
///   weights  #S, written
void weights_on_part(const Pose& pose, int part, Eigen::Ref<Eigen::VectorXd> weights);

///   throws  invalid_input: a shape, slider or node that does not exist
void check_freedoms(const Character& character, const Freedoms& freedoms);

}  // namespace mien::detail
