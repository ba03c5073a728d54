#pragma once
/// Skinning with any number of influences.

#include <Eigen/Core>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// What each joint does to a point of the bind pose: its model matrix times its inverse bind matrix.
///   model    #N, node space to model space
///   returns  #J of `skin`, model space (bind pose) to model space
///   throws   invalid_input: a joint out of range, inverse bind matrices that differ in number from the
///            joints
std::vector<Eigen::Matrix4d> joint_matrices(const Skin& skin, const std::vector<Eigen::Matrix4d>& model);

/// That skin weights are of `vertices` vertices and name joints below `joint_count`.
///   throws  invalid_input: offsets that do not match, a joint out of range
void check_skin_weights(Eigen::Index vertices, const SkinWeights& weights, std::size_t joint_count);

/// Each vertex moved by the mean of its joints' matrices, weighted by its skin weights.
///   positions  #V x 3, model space, bind pose
///   returns    #V x 3, model space. A vertex without influences stays. Skin weights are divided by their
///              sum, so that a sum that is one only to float precision does not move the bind pose
///   throws     invalid_input: offsets that do not match #V, a joint out of range
///   cost       one matrix product an influence
///   method     Magnenat-Thalmann et al. 1988, as in glTF 2.0
PointsD skin_linear(const PointsD& positions, const SkinWeights& weights,
                    const std::vector<Eigen::Matrix4d>& joints);

/// By the method that the skin names: skin_linear, or skin_dual_quaternion of dual_quaternion.h.
PointsD skin_points(const PointsD& positions, const SkinWeights& weights, const Skin& skin,
                    const std::vector<Eigen::Matrix4d>& joints);

}  // namespace mien
