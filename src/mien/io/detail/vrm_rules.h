#pragma once
/// What VRMC_vrm 1.0 asks of bones and expressions.

#include <span>
#include <string_view>

#include "mien/character/character.h"
#include "mien/character/vrm_avatar.h"

namespace mien::detail {

struct VrmBoneRule {
  std::string_view name, parent;  ///< "": the root of all
  bool required = false;
  bool needs_parent = false;  ///< its parent must be there too
};
std::span<const VrmBoneRule> vrm_bone_rules();

/// happy ... neutral.
std::span<const std::string_view> vrm_presets();

///   throws  invalid_input: as write_vrm
void check_vrm(const Character& character, const VrmAvatar& avatar);

}  // namespace mien::detail
