#pragma once
/// Slider values into shape weights.

#include <Eigen/Core>
#include <string_view>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// The shape weights at these slider values: what the stops give, plus the correctives; what drives one shape
/// twice adds up, what drives none weighs 0.
///   returns  #S
///   throws   invalid_input: a number of values other than the sliders', a value that is not finite, a slider or corrective
///            that names a shape or slider out of range
///   cost     linear in stops and corrective inputs
ShapeWeights shape_weights(const Character& character, const SliderValues& sliders);

/// The derivative of `shape_weights`. Where it has a kink: the slope upwards of a slider at a stop, the slope
/// on the firing side of a corrective's input at 0, an equal share of equal inputs of a `smallest`.
///   returns  #S x #sliders
///   throws   as shape_weights
Eigen::MatrixXd shape_weight_slopes(const Character& character, const SliderValues& sliders);

/// Every slider at its rest value.
SliderValues rest_sliders(const Character& character);

/// `start` with the sliders of `expression`, in proportion to `amount`: 1 gives the saved values, 0 `start`.
///   throws  invalid_input: a slider out of range, a number of values other than the sliders'
SliderValues apply_expression(const Character& character, const Expression& expression,
                              const SliderValues& start, double amount = 1);

/// The local transforms as they are, the shape weights that the sliders give.
///   throws  as shape_weights
Pose pose_of(const Character& character, const RigPose& rig);

/// Everything at rest.
RigPose rest_rig_pose(const Character& character);

/// Gives each shape that no slider and no corrective drives a plain slider of its name, 0 to 1, in the order
/// of the shapes. Files are read this way: without this data a character has one slider a shape.
void complete_sliders(Character& character);

/// Index of the element with this name, or -1.
int find_slider(const Character& character, std::string_view name);

}  // namespace mien
