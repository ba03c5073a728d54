#pragma once
/// A skeleton's motion onto another skeleton.

#include <map>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

struct RetargetJointsResult {
  Clip clip;                        ///< rotation channels of the target's joints, and the root's translation
  std::vector<std::string> mapped;  ///< "Head -> head"
  std::vector<std::string> unmapped;  ///< animated source joints that drive nothing
};

/// The motion of `clip` on the target's joints of the same names (case and separators do not matter; what the name
/// carries in front of ":" is left out), or those that `names` (source joint -> target joint) says. A target joint turns in
/// model space as its source joint turns from its rest; joints between follow as they hang. The topmost mapped joint that
/// the source moves is moved too, by the ratio of the two skeletons' sizes.
///   source   at rest in the same attitude as the target: a T-pose does not become an A-pose
///   throws   invalid_input: `names` names no joint, no joint is driven, a channel out of range
///   cost     linear in keys x joints
RetargetJointsResult retarget_joints(const Character& source, const Clip& clip, const Character& target,
                                     const std::map<std::string, std::string>& names = {});

}  // namespace mien
