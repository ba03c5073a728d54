#pragma once
/// The control interface of a character, made from a configuration (thesis 4.9).

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/control_config.h"

namespace mien {

/// Regions, pads and columns for faces whose names `actions_of` knows (ARKit, Live Link, ICT, Face Cap, MakeHuman, FACS, VRM,
/// visemes) and for joints by the usual words of their names. No limits, no names of a production's own.
const ControlConfig& default_control_config();

struct MadeControls {
  Character
      character;  ///< with the new controls in place of its own, and with the limits of the configuration
  std::vector<std::string> other_sliders, other_joints;  ///< what no region took
  std::vector<std::string> unused;  ///< rules of the configuration that fit nothing: "limits jaw*"
};

/// Gives every slider and every joint of the skins a control in a region. Pads take the place of their sliders' controls. Limits
/// change sliders' minimum and maximum, and become a limit constraint `NAME limits` on a joint. Pairs of sides are each
/// other's mirror.
///   throws  invalid_input: a configuration with two regions or pads of one name, a region without one, a rule without a
///           pattern, a range upside down, a column that names no region, a size that is not above 0
///   cost    names x patterns
MadeControls make_controls(const Character& character,
                           const ControlConfig& config = default_control_config());

}  // namespace mien
