#pragma once
/// What a joint is, whatever it is called: names of VRM 1.0's humanoid, Rigify, MakeHuman's default rig and Mixamo.

#include <string>
#include <string_view>
#include <vector>

#include "mien/character/character.h"
#include "mien/naming/rename.h"

namespace mien {

enum class JointConvention { vrm, rigify, makehuman, mixamo };
constexpr int joint_convention_count = 4;

/// "vrm", "rigify", "makehuman", "mixamo".
std::string_view name_of(JointConvention convention);
///   throws  invalid_input: no such convention
JointConvention joint_convention_of_name(std::string_view name);

/// All joints that some convention names, each once: VRM's bones in the specification's order (`hips` ... `rightLittleDistal`), then
/// those of the face (`leftUpperLid`, `tongue` ...).
const std::vector<std::string>& joint_names();

/// What the convention calls each joint, "" where it has no name for it.
///   returns  as many as joint_names()
std::vector<std::string> joint_names_in(JointConvention convention);

/// The convention that knows most of these names, and how many.
struct FoundJointConvention {
  JointConvention convention = JointConvention::vrm;
  int known = 0;
};
FoundJointConvention find_joint_convention(const std::vector<std::string>& names);

/// What each of these names is, -1: not known: as the convention says that knows most of them, then by usual words (`Head`, `eye_L`,
/// `upperarm_r`). Case, separators, ways of writing sides, `DEF-`, `ORG-` and what stands in front of a colon do not matter; the
/// first of two names of one joint has it.
///   returns  indices into joint_names()
std::vector<int> joints_of(const std::vector<std::string>& names);

/// What the convention would call the joints of the character's skins; others are left out.
NamePairs joint_names_for(const Character& character, JointConvention convention);

}  // namespace mien
