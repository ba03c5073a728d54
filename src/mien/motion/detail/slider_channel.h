#pragma once
/// What the retargeters of sliders and of markers share.

#include <Eigen/Core>
#include <vector>

#include "mien/character/character.h"

namespace mien::detail {

/// Of a slider's range: the smoothing of captures takes larger changes for motion, smaller ones for noise.
inline constexpr double quick_change = 0.1;

/// One linear key a frame.
Channel slider_channel(int slider, const std::vector<double>& seconds, const Eigen::VectorXd& values);

}  // namespace mien::detail
