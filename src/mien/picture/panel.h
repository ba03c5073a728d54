#pragma once
/// The control interface as an animator sees it.

#include "mien/character/character.h"
#include "mien/character/pose.h"
#include "mien/picture/picture.h"

namespace mien {

struct PanelOptions {
  int row = 22;  ///< pixels a row
};

/// Character::controls where they lie: sliders with a mark at their value and one at 0, pads with a point, joints with their turns about
/// x, y and z from rest; the regions' names above.
///   pose    what the controls show
///   throws  invalid_input: no controls, what `validate` finds wrong with them, numbers of sliders or locals other than the
///           character's, a panel larger than a picture may be
Picture draw_panel(const Character& character, const RigPose& pose, const PanelOptions& options = {});

}  // namespace mien
