#pragma once
/// A character as a VRM 1.0 avatar: which node is which bone, which shapes are which expression.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/vrm_avatar.h"

namespace mien {

struct VrmPlan {
  Character
      character;  ///< with the nodes that were made; the old ones keep their numbers and their places in model space
  VrmAvatar avatar;
  std::vector<std::string> made_bones;       ///< required by VRM, not in the character
  std::vector<std::string> missing_presets;  ///< nothing of the character does them
};

/// Bones by the joints' names (naming/joint.h). What VRM requires and the character has not is made: hips and spine above the head, in
/// place, so that nothing moves; limbs in a T-pose below, sized by the head. Expressions by what the sliders do (link_sliders.h):
/// the presets that can be made, of several shapes where no single one fits; the character's saved expressions and each slider as
/// custom ones. An emotion that moves the mouth or closes the eyes tones lip sync or blinks down while it is on. The gaze goes by eye
/// bones, else by the expressions lookUp and so on.
///   throws  invalid_input: what validate finds; a character without parts
///   cost    linear in sliders x presets
VrmPlan plan_vrm(const Character& character, const VrmMeta& meta);

}  // namespace mien
