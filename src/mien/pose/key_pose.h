#pragma once
/// Poses into clips: keys on what changed, and pins held through a range of frames.

#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/character/pose.h"
#include "mien/pose/solve_pins.h"

namespace mien {

/// The clip with keys at `seconds` on the sliders that `after` changes from `before` by more than 1e-6, and on no others. A
/// slider that the clip does not animate gets a channel of this one key; a cubic spline gets flat tangents there.
///   throws  invalid_input: sizes that differ from the character's; a time that is negative or not finite
Clip key_changes(const Character& character, const Clip& clip, const SliderValues& before,
                 const SliderValues& after, double seconds);

struct HoldOptions {
  double begin = 0, end = 0;  ///< seconds, both ends included; begin <= end
  double fps = 30;
  SolvePinsOptions solve;
};

/// The clip with the pins kept through the range: at every frame of it the sliders are solved from what the clip says there.
/// Goals are absolute, or moves from where the clip has the point. Sliders that no frame changes keep their channels as
/// they are; others get a key a frame within the range, and outside it what they had (as keys a frame, if their channel is no
/// linear one).
///   throws  invalid_input: as solve_pins; a range or fps out of order
Clip hold_pins(const Character& character, const Clip& clip, const std::vector<Pin>& pins,
               const HoldOptions& options);

}  // namespace mien
