// VRM: vrm-c/vrm-specification, VRMC_vrm-1.0 humanoid. Rigify: Blender's human meta-rig, whose face bones count from the middle (lip.T.L
// begins at the lips' middle). MakeHuman: its default rig. Mixamo: mixamorig. Left names are written; right ones follow.
#include "mien/naming/joint.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "mien/core/error.h"
#include "mien/naming/detail/tables.h"

namespace mien {
namespace {

using detail::plain_name;
using detail::PlainName;

constexpr std::array<const char*, joint_convention_count> joint_convention_names{"vrm", "rigify", "makehuman",
                                                                                 "mixamo"};

/// One joint in each convention, in JointConvention's order; "" where there is none. `words`: other usual names, by "|".
struct JointRow {
  std::array<std::string_view, joint_convention_count> names;
  std::string_view words;
};

/// Without a side, and of the left.
constexpr JointRow body_rows[] = {
    {{"hips", "spine", "root", "Hips"}, "pelvis"},
    {{"spine", "spine.001", "spine05", "Spine"}, "spine1|spine01"},
    {{"chest", "spine.002", "spine03", "Spine1"}, "spine02"},
    {{"upperChest", "spine.003", "spine01", "Spine2"}, ""},
    {{"neck", "spine.004", "neck01", "Neck"}, ""},
    {{"head", "spine.006", "head", "Head"}, "skull"},
    {{"leftEye", "eye.L", "eye.L", "LeftEye"}, "eyeball.L"},
    {{"jaw", "jaw", "jaw", "Jaw"}, "mandible"},
    {{"leftUpperLeg", "thigh.L", "upperleg01.L", "LeftUpLeg"}, "upleg.L"},
    {{"leftLowerLeg", "shin.L", "lowerleg01.L", "LeftLeg"}, "calf.L|leg.L"},
    {{"leftFoot", "foot.L", "foot.L", "LeftFoot"}, ""},
    {{"leftToes", "toe.L", "toe1-1.L", "LeftToeBase"}, "ball.L|toes.L"},
    {{"leftShoulder", "shoulder.L", "clavicle.L", "LeftShoulder"}, "collar.L"},
    {{"leftUpperArm", "upper_arm.L", "upperarm01.L", "LeftArm"}, ""},
    {{"leftLowerArm", "forearm.L", "lowerarm01.L", "LeftForeArm"}, ""},
    {{"leftHand", "hand.L", "wrist.L", "LeftHand"}, ""},
    {{"leftThumbMetacarpal", "thumb.01.L", "finger1-1.L", "LeftHandThumb1"}, ""},
    {{"leftThumbProximal", "thumb.02.L", "finger1-2.L", "LeftHandThumb2"}, ""},
    {{"leftThumbDistal", "thumb.03.L", "finger1-3.L", "LeftHandThumb3"}, ""},
    {{"leftIndexProximal", "f_index.01.L", "finger2-1.L", "LeftHandIndex1"}, ""},
    {{"leftIndexIntermediate", "f_index.02.L", "finger2-2.L", "LeftHandIndex2"}, ""},
    {{"leftIndexDistal", "f_index.03.L", "finger2-3.L", "LeftHandIndex3"}, ""},
    {{"leftMiddleProximal", "f_middle.01.L", "finger3-1.L", "LeftHandMiddle1"}, ""},
    {{"leftMiddleIntermediate", "f_middle.02.L", "finger3-2.L", "LeftHandMiddle2"}, ""},
    {{"leftMiddleDistal", "f_middle.03.L", "finger3-3.L", "LeftHandMiddle3"}, ""},
    {{"leftRingProximal", "f_ring.01.L", "finger4-1.L", "LeftHandRing1"}, ""},
    {{"leftRingIntermediate", "f_ring.02.L", "finger4-2.L", "LeftHandRing2"}, ""},
    {{"leftRingDistal", "f_ring.03.L", "finger4-3.L", "LeftHandRing3"}, ""},
    {{"leftLittleProximal", "f_pinky.01.L", "finger5-1.L", "LeftHandPinky1"}, ""},
    {{"leftLittleIntermediate", "f_pinky.02.L", "finger5-2.L", "LeftHandPinky2"}, ""},
    {{"leftLittleDistal", "f_pinky.03.L", "finger5-3.L", "LeftHandPinky3"}, ""},
};
constexpr JointRow face_rows[] = {
    {{"", "face", "", ""}, "face"},
    {{"", "chin", "", ""}, "chin"},
    {{"", "nose", "", ""}, "nose"},
    {{"", "tongue", "tongue00", ""}, "tongue"},
    {{"", "tongue.001", "tongue01", ""}, "tongue2|tongueMid"},
    {{"", "tongue.002", "tongue02", ""}, "tongue3|tongueTip"},
    {{"", "teeth.T", "", ""}, "upperTeeth"},
    {{"", "teeth.B", "", ""}, "lowerTeeth"},
    {{"", "lid.T.L", "", ""}, "upperLid.L|lidUpper.L|eyelidUpper.L"},
    {{"", "lid.B.L", "", ""}, "lowerLid.L|lidLower.L|eyelidLower.L"},
    {{"", "brow.T.L", "oculi02.L", ""}, "brow.L|eyebrow.L"},
    {{"", "brow.B.L", "oculi01.L", ""}, "browLower.L"},
    {{"", "cheek.T.L", "levator03.L", ""}, "cheek.L"},
    {{"", "cheek.B.L", "risorius03.L", ""}, "cheekLower.L"},
    {{"", "lip.T.L", "oris04.L", ""}, "lipUpper.L"},
    {{"", "lip.B.L", "oris06.L", ""}, "lipLower.L"},
    {{"", "ear.L", "", ""}, "ear.L"},
    {{"", "forehead.L", "", ""}, "forehead.L"},
    {{"", "temple.L", "temporalis01.L", ""}, "temple.L"},
};

/// mien's own names of the face's joints, in face_rows' order.
constexpr std::array<std::string_view, std::size(face_rows)> face_names{
    "face",         "chin",          "nose",         "tongue",         "tongueMiddle",
    "tongueTip",    "upperTeeth",    "lowerTeeth",   "leftUpperLid",   "leftLowerLid",
    "leftBrow",     "leftBrowLower", "leftCheek",    "leftCheekLower", "leftUpperLip",
    "leftLowerLip", "leftEar",       "leftForehead", "leftTemple"};

struct Joint {
  std::string name;
  std::array<std::string, joint_convention_count> names;
  std::vector<std::string> words;
};

std::string other_side(std::string_view name) {
  const std::string mirrored = mirrored_name(name);
  return mirrored.empty() ? std::string(name) : mirrored;
}

std::vector<std::string> split(std::string_view words) {
  std::vector<std::string> result;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find('|'), words.size());
    result.emplace_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return result;
}

void add_rows(const JointRow* rows, std::size_t count, bool face, std::vector<Joint>& joints) {
  const auto add = [&](std::size_t r, bool mirrored) {
    Joint joint;
    const auto side = [&](std::string_view name) { return mirrored ? other_side(name) : std::string(name); };
    joint.name = side(face ? face_names[r] : rows[r].names[0]);
    for (std::size_t c = 0; c < joint.names.size(); ++c) joint.names[c] = side(rows[r].names[c]);
    for (const std::string& word : split(rows[r].words)) joint.words.push_back(side(word));
    joints.push_back(std::move(joint));
  };
  for (std::size_t r = 0; r < count; ++r) {
    add(r, false);
    if (side_of_name(face ? face_names[r] : rows[r].names[0]) == Side::left) add(r, true);
  }
}

const std::vector<Joint>& joints() {
  static const std::vector<Joint> table = [] {
    std::vector<Joint> made;
    add_rows(body_rows, std::size(body_rows), false, made);
    add_rows(face_rows, std::size(face_rows), true, made);
    return made;
  }();
  return table;
}

using NameKey = std::pair<std::string, char>;

/// A joint's name without rig prefixes, the word joint, separators, case and side.
NameKey key_of(std::string_view name) {
  if (const std::size_t space = name.find_last_of(":|"); space != name.npos) name.remove_prefix(space + 1);
  for (const std::string_view prefix : {"DEF-", "ORG-", "MCH-", "mixamorig_", "mixamorig"})
    if (name.starts_with(prefix)) {
      name.remove_prefix(prefix.size());
      break;
    }
  PlainName plain = plain_name(name);
  for (const std::string_view word : {"joint", "jnt", "bone"})
    if (plain.base.size() > word.size() && plain.base.ends_with(word)) {
      plain.base.resize(plain.base.size() - word.size());
      break;
    }
  return {plain.base, plain.side};
}

std::map<NameKey, int> table_of(std::size_t convention) {
  std::map<NameKey, int> table;
  for (std::size_t j = 0; j < joints().size(); ++j)
    if (!joints()[j].names[convention].empty())
      table.emplace(key_of(joints()[j].names[convention]), static_cast<int>(j));
  return table;
}

const std::map<NameKey, int>& usual_words() {
  static const std::map<NameKey, int> table = [] {
    std::map<NameKey, int> words;
    for (std::size_t j = 0; j < joints().size(); ++j) {
      words.emplace(key_of(joints()[j].name), static_cast<int>(j));
      for (const std::string& word : joints()[j].words) words.emplace(key_of(word), static_cast<int>(j));
    }
    for (std::size_t c = 0; c < static_cast<std::size_t>(joint_convention_count); ++c)
      for (const auto& [key, joint] : table_of(c)) words.emplace(key, joint);
    return words;
  }();
  return table;
}

}  // namespace

std::string_view name_of(JointConvention convention) {
  return joint_convention_names[static_cast<std::size_t>(convention)];
}

JointConvention joint_convention_of_name(std::string_view name) {
  std::string known;
  for (std::size_t c = 0; c < joint_convention_names.size(); ++c) {
    if (name == joint_convention_names[c]) return static_cast<JointConvention>(c);
    known += (known.empty() ? "" : ", ") + std::string(joint_convention_names[c]);
  }
  throw invalid_input("joint convention " + std::string(name.substr(0, 40)), "is not known",
                      "one of: " + known);
}

const std::vector<std::string>& joint_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Joint& joint : joints()) all.push_back(joint.name);
    return all;
  }();
  return names;
}

std::vector<std::string> joint_names_in(JointConvention convention) {
  std::vector<std::string> names;
  for (const Joint& joint : joints()) names.push_back(joint.names[static_cast<std::size_t>(convention)]);
  return names;
}

FoundJointConvention find_joint_convention(const std::vector<std::string>& names) {
  FoundJointConvention best;
  for (int c = 0; c < joint_convention_count; ++c) {
    const std::map<NameKey, int> table = table_of(static_cast<std::size_t>(c));
    std::set<int> known;
    for (const std::string& name : names)
      if (const auto found = table.find(key_of(name)); found != table.end()) known.insert(found->second);
    if (static_cast<int>(known.size()) > best.known)
      best = {static_cast<JointConvention>(c), static_cast<int>(known.size())};
  }
  return best;
}

std::vector<int> joints_of(const std::vector<std::string>& names) {
  const std::map<NameKey, int> own =
      table_of(static_cast<std::size_t>(find_joint_convention(names).convention));
  std::vector<int> result(names.size(), -1);
  std::set<int> taken;
  for (const auto* table : {&own, &usual_words()})
    for (std::size_t n = 0; n < names.size(); ++n) {
      if (result[n] >= 0) continue;
      const auto found = table->find(key_of(names[n]));
      if (found != table->end() && taken.insert(found->second).second) result[n] = found->second;
    }
  return result;
}

NamePairs joint_names_for(const Character& character, JointConvention convention) {
  std::vector<std::string> own;
  std::set<int> seen;
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints)
      if (seen.insert(joint).second) own.push_back(character.nodes[static_cast<std::size_t>(joint)].name);
  const std::vector<int> found = joints_of(own);
  const std::vector<std::string> wanted = joint_names_in(convention);
  NamePairs pairs;
  for (std::size_t n = 0; n < own.size(); ++n)
    if (found[n] >= 0 && !wanted[static_cast<std::size_t>(found[n])].empty())
      pairs.emplace_back(own[n], wanted[static_cast<std::size_t>(found[n])]);
  return pairs;
}

}  // namespace mien
