#pragma once
/// Captured markers onto a character: the sliders that bring its points where the markers went.

#include <map>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/take.h"
#include "mien/core/progress.h"

namespace mien {

struct FitMarkersOptions {
  std::map<std::string, std::string> landmarks;  ///< marker -> landmark; empty: equal names
  double neutral_at = 0;  ///< second at which the actor's face is neutral; every matched marker is seen then
  double rho = 3e-2;      ///< of direct manipulation (pose/solve_pins.h): more is calmer, less follows closer
  double smooth = 0.03;   ///< seconds, as RetargetOptions::smooth, on the sliders
  double gap =
      0.25;  ///< seconds: shorter gaps are bridged by a straight line, in longer ones a marker is left out
  Progress progress;
};

struct FitMarkersResult {
  Clip clip;                          ///< a slider channel a slider that moves
  std::vector<std::string> matched;   ///< markers, as the take has them
  std::vector<std::string> unmapped;  ///< markers without a landmark
  double scale = 1;                   ///< the actor's size to the character's
  double residual = 0;  ///< rms distance of points to their goals, over the rms motion of the goals
};

/// Frame by frame: the face's rigid motion is taken out by the markers that the rig moves least, judged again by how they
/// fit; each marker's way from its neutral place, turned and scaled to the character, is a goal for its landmark; the
/// sliders follow within their ranges as in direct manipulation, from rest, so that nothing drifts.
///   throws  invalid_input: fewer than 4 matched markers, or all on one line; a marker that is not seen at the neutral time; a
///           frame with fewer than 3 seen; a landmark that does not exist; no sliders; options out of range
///   cost    one small quadratic program a frame
FitMarkersResult fit_markers(const MarkerTake& take, const Character& character,
                             const FitMarkersOptions& options = {});

}  // namespace mien
