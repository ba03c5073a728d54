// The humanoid's bones and the preset expressions as vrm-c/vrm-specification, VRMC_vrm-1.0, lists them.
#include "mien/io/detail/vrm_rules.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

constexpr VrmBoneRule bone_rules[] = {
    {"hips", "", true},
    {"spine", "hips", true},
    {"chest", "spine"},
    {"upperChest", "chest", false, true},
    {"neck", "upperChest"},
    {"head", "neck", true},
    {"leftEye", "head"},
    {"rightEye", "head"},
    {"jaw", "head"},
    {"leftUpperLeg", "hips", true},
    {"leftLowerLeg", "leftUpperLeg", true},
    {"leftFoot", "leftLowerLeg", true},
    {"leftToes", "leftFoot"},
    {"rightUpperLeg", "hips", true},
    {"rightLowerLeg", "rightUpperLeg", true},
    {"rightFoot", "rightLowerLeg", true},
    {"rightToes", "rightFoot"},
    {"leftShoulder", "upperChest"},
    {"leftUpperArm", "leftShoulder", true},
    {"leftLowerArm", "leftUpperArm", true},
    {"leftHand", "leftLowerArm", true},
    {"rightShoulder", "upperChest"},
    {"rightUpperArm", "rightShoulder", true},
    {"rightLowerArm", "rightUpperArm", true},
    {"rightHand", "rightLowerArm", true},
    {"leftThumbMetacarpal", "leftHand"},
    {"leftThumbProximal", "leftThumbMetacarpal", false, true},
    {"leftThumbDistal", "leftThumbProximal", false, true},
    {"leftIndexProximal", "leftHand"},
    {"leftIndexIntermediate", "leftIndexProximal", false, true},
    {"leftIndexDistal", "leftIndexIntermediate", false, true},
    {"leftMiddleProximal", "leftHand"},
    {"leftMiddleIntermediate", "leftMiddleProximal", false, true},
    {"leftMiddleDistal", "leftMiddleIntermediate", false, true},
    {"leftRingProximal", "leftHand"},
    {"leftRingIntermediate", "leftRingProximal", false, true},
    {"leftRingDistal", "leftRingIntermediate", false, true},
    {"leftLittleProximal", "leftHand"},
    {"leftLittleIntermediate", "leftLittleProximal", false, true},
    {"leftLittleDistal", "leftLittleIntermediate", false, true},
    {"rightThumbMetacarpal", "rightHand"},
    {"rightThumbProximal", "rightThumbMetacarpal", false, true},
    {"rightThumbDistal", "rightThumbProximal", false, true},
    {"rightIndexProximal", "rightHand"},
    {"rightIndexIntermediate", "rightIndexProximal", false, true},
    {"rightIndexDistal", "rightIndexIntermediate", false, true},
    {"rightMiddleProximal", "rightHand"},
    {"rightMiddleIntermediate", "rightMiddleProximal", false, true},
    {"rightMiddleDistal", "rightMiddleIntermediate", false, true},
    {"rightRingProximal", "rightHand"},
    {"rightRingIntermediate", "rightRingProximal", false, true},
    {"rightRingDistal", "rightRingIntermediate", false, true},
    {"rightLittleProximal", "rightHand"},
    {"rightLittleIntermediate", "rightLittleProximal", false, true},
    {"rightLittleDistal", "rightLittleIntermediate", false, true},
};

constexpr std::string_view presets[] = {
    "happy", "angry", "sad",       "relaxed",    "surprised", "aa",       "ih",       "ou",        "ee",
    "oh",    "blink", "blinkLeft", "blinkRight", "lookUp",    "lookDown", "lookLeft", "lookRight", "neutral"};

const VrmBoneRule* rule_of(std::string_view name) {
  const auto found = std::find_if(std::begin(bone_rules), std::end(bone_rules),
                                  [&](const VrmBoneRule& rule) { return rule.name == name; });
  return found == std::end(bone_rules) ? nullptr : found;
}

bool hangs_below(const Character& character, int node, int above) {
  for (int n = character.nodes[static_cast<std::size_t>(node)].parent; n >= 0;
       n = character.nodes[static_cast<std::size_t>(n)].parent)
    if (n == above) return true;
  return false;
}

void check_meta(const VrmMeta& meta) {
  if (meta.name.empty()) throw invalid_input("VRM meta", "has no name", "give the avatar's name");
  if (meta.authors.empty() ||
      std::any_of(meta.authors.begin(), meta.authors.end(), [](const auto& a) { return a.empty(); }))
    throw invalid_input("VRM meta", "has no author", "name one or more");
  if (meta.license_url.empty())
    throw invalid_input("VRM meta", "has no licence URL", "https://vrm.dev/licenses/1.0/");
}

using BoneNodes = std::map<std::string_view, int>;

BoneNodes bone_nodes(const Character& character, const VrmAvatar& avatar) {
  BoneNodes nodes;
  std::set<int> taken;
  for (const VrmBone& bone : avatar.bones) {
    const std::string place = "VRM bone " + bone.name;
    if (!rule_of(bone.name))
      throw invalid_input(place, "is not one of the humanoid's", "hips, spine, head ...");
    if (bone.node < 0 || bone.node >= static_cast<int>(character.nodes.size()))
      throw invalid_input(place, "names node " + std::to_string(bone.node),
                          "there are " + std::to_string(character.nodes.size()));
    if (!nodes.emplace(bone.name, bone.node).second)
      throw invalid_input(place, "is there twice", "give it one node");
    const Node& node = character.nodes[static_cast<std::size_t>(bone.node)];
    if (!taken.insert(bone.node).second)
      throw invalid_input(place, "shares node " + node.name + " with another bone", "give each its own");
    if (!(node.rest.scale.minCoeff() > 0))
      throw invalid_input(place, "has a scale that is not above 0", "scales above 0, as VRM asks");
  }
  return nodes;
}

/// The nearest bone above that is there.
void check_parent(const Character& character, const VrmBoneRule& rule, const BoneNodes& nodes) {
  if (rule.needs_parent && !nodes.contains(rule.parent))
    throw invalid_input("VRM bone " + std::string(rule.name), "has no " + std::string(rule.parent),
                        "give both or neither");
  const VrmBoneRule* above = rule_of(rule.parent);
  while (above && !nodes.contains(above->name)) above = rule_of(above->parent);
  if (above && !hangs_below(character, nodes.at(rule.name), nodes.at(above->name)))
    throw invalid_input("VRM bone " + std::string(rule.name),
                        "does not hang below " + std::string(above->name),
                        "the humanoid's order from the hips outwards");
}

void check_bones(const Character& character, const VrmAvatar& avatar) {
  const BoneNodes nodes = bone_nodes(character, avatar);
  for (const VrmBoneRule& rule : bone_rules) {
    if (nodes.contains(rule.name))
      check_parent(character, rule, nodes);
    else if (rule.required)
      throw invalid_input("VRM bone " + std::string(rule.name), "is missing", "VRM requires it");
  }
}

void check_expressions(const Character& character, const VrmAvatar& avatar) {
  std::set<std::string> names;
  for (const VrmExpression& expression : avatar.expressions) {
    const std::string place = "VRM expression " + expression.name;
    if (expression.name.empty()) throw invalid_input("VRM expression", "has no name", "give it one");
    if (!names.insert(expression.name).second)
      throw invalid_input(place, "is there twice", "give each its own name");
    const bool known =
        std::find(std::begin(presets), std::end(presets), expression.name) != std::end(presets);
    if (expression.is_preset && !known)
      throw invalid_input(place, "is no preset of VRM's", "make it a custom one");
    if (!expression.is_preset && known) throw invalid_input(place, "has the name of a preset", "make it one");
    for (const VrmBind& bind : expression.binds) {
      if (bind.shape < 0 || bind.shape >= static_cast<int>(character.shapes.size()))
        throw invalid_input(place, "names shape " + std::to_string(bind.shape),
                            "there are " + std::to_string(character.shapes.size()));
      if (!(bind.weight >= 0 && bind.weight <= 1))
        throw invalid_input(place,
                            "weighs " + character.shapes[static_cast<std::size_t>(bind.shape)].name + " by " +
                                std::to_string(bind.weight),
                            "give weights in [0, 1]");
    }
  }
}

}  // namespace

std::span<const VrmBoneRule> vrm_bone_rules() {
  return bone_rules;
}

std::span<const std::string_view> vrm_presets() {
  return presets;
}

void check_vrm(const Character& character, const VrmAvatar& avatar) {
  check_meta(avatar.meta);
  check_bones(character, avatar);
  check_expressions(character, avatar);
}

}  // namespace mien::detail
