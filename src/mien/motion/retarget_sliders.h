#pragma once
/// A captured slider stream onto a character's sliders.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/take.h"
#include "mien/naming/link_sliders.h"

namespace mien {

struct RetargetOptions {
  /// Replaces what link_sliders finds, when it is not empty.
  std::vector<SliderLink> links;
  /// Seconds at which the actor's face is neutral: each stream is calibrated to be 0 there and 1 where it was 1.
  /// Absent: streams are taken as they are.
  std::optional<double> neutral_at;
  /// Factor on a slider's value, by its name.
  std::map<std::string, double> gains;
  /// Values beyond the slider's range are kept instead of clamped.
  bool overdrive = false;
  /// Seconds over which noise is smoothed: a bilateral filter in time, which leaves changes of more than about 0.2
  /// (blinks, plosives) as quick as they are. 0: none.
  double smooth = 0.05;
  /// Turn the joints named head and eyes by the take's rotations, when they exist and no slider does the same.
  bool joints = true;
};

struct RetargetResult {
  Clip clip;                          ///< a slider channel a driven slider, a rotation channel a driven joint
  std::vector<SliderLink> links;      ///< what was used
  std::vector<std::string> unmapped;  ///< streams that drive nothing
  std::vector<std::string> still;     ///< sliders that nothing drives
};

/// The take as a clip of `character`, one key a frame.
///   throws  invalid_input: a link that names no stream or slider, no stream that drives anything, a neutral time outside
///           the take, options that are not finite
///   cost    linear in frames x streams
///   method  direct mapping of sliders; Live Link's rotations are radians about the model's axes, yaw about y, pitch about
///           x, roll about z
RetargetResult retarget(const SliderTake& take, const Character& character,
                        const RetargetOptions& options = {});

/// The filter of `RetargetOptions::smooth` on one stream, sampled at `seconds`.
///   values   #frames
///   reach    standard deviation in time, seconds
///   level    standard deviation in value: larger changes are kept
///   method   Tomasi and Manduchi 1998, in one dimension; symmetric in time, so that nothing lags
Eigen::VectorXd smooth_stream(const Eigen::VectorXd& values, const std::vector<double>& seconds, double reach,
                              double level);

}  // namespace mien
