// Limbs that are not there are leaves: where they are made nothing depends on. Hips and spine have the head below them: they are made with
// identity transforms, so that every local transform and every clip of the old nodes stays true.
#include "mien/naming/plan_vrm.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "mien/character/sliders.h"
#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/naming/action.h"
#include "mien/naming/joint.h"
#include "mien/naming/link_sliders.h"

namespace mien {
namespace {

using Eigen::Vector3d;

/// A required bone of a limb: what it hangs on, and where it is from the head bone, in head heights, on the left (mirrored on the right).
struct Limb {
  std::string_view name, above;
  Vector3d at;
};
const std::array<Limb, 6>& limbs() {
  static const std::array<Limb, 6> table = {
      Limb{"UpperArm", "spine", {0.8, -0.8, 0}},    Limb{"LowerArm", "UpperArm", {2, -0.8, 0}},
      Limb{"Hand", "LowerArm", {3.1, -0.8, 0}},     Limb{"UpperLeg", "hips", {0.4, -3.4, 0}},
      Limb{"LowerLeg", "UpperLeg", {0.4, -5.2, 0}}, Limb{"Foot", "LowerLeg", {0.4, -7, 0}}};
  return table;
}

/// The bone that each of VRM's hangs below, through what is not there.
const std::map<std::string, std::string>& bone_above() {
  static const std::map<std::string, std::string> table = [] {
    std::map<std::string, std::string> above = {
        {"spine", "hips"}, {"chest", "spine"},  {"upperChest", "chest"}, {"neck", "upperChest"},
        {"head", "neck"},  {"leftEye", "head"}, {"rightEye", "head"},    {"jaw", "head"}};
    for (const std::string side : {"left", "right"}) {
      const std::pair<const char*, const char*> pairs[] = {{"LowerLeg", "UpperLeg"}, {"Foot", "LowerLeg"},
                                                           {"Toes", "Foot"},         {"UpperArm", "Shoulder"},
                                                           {"LowerArm", "UpperArm"}, {"Hand", "LowerArm"}};
      for (const auto& [bone, parent] : pairs) above[side + bone] = side + parent;
      above[side + "UpperLeg"] = "hips";
      above[side + "Shoulder"] = "upperChest";
      for (const char* finger : {"Thumb", "Index", "Middle", "Ring", "Little"}) {
        const bool thumb = std::string_view(finger) == "Thumb";
        const std::string first = side + finger + (thumb ? "Metacarpal" : "Proximal"),
                          second = side + finger + (thumb ? "Proximal" : "Intermediate");
        above[first] = side + "Hand";
        above[second] = first;
        above[side + finger + "Distal"] = second;
      }
    }
    return above;
  }();
  return table;
}

class Planner {
 public:
  Planner(const Character& character, const VrmMeta& meta) {
    require_valid(character);
    if (character.parts.empty()) throw invalid_input("character", "has no parts", "one with a surface");
    plan_.character = character;
    plan_.avatar.meta = meta;
  }
  VrmPlan run();

 private:
  void find_bones();
  void make_spine();
  void make_limbs();
  void drop_misplaced();
  void list_bones();
  void add_presets();
  void add_custom();
  void add_look_at();
  void add_preset(const std::string& name);
  bool is_above(int above, int node) const;
  int add_node(const std::string& name, int parent, const Vector3d& at_model);
  double head_height() const;
  Vector3d under_the_head() const;
  std::vector<VrmBind> binds_of(const std::vector<SliderLink>& links) const;
  std::vector<Node>& nodes() { return plan_.character.nodes; }

  VrmPlan plan_;
  std::map<std::string, int> bones_;
};

bool Planner::is_above(int above, int node) const {
  const std::vector<Node>& nodes = plan_.character.nodes;
  for (int n = nodes[static_cast<std::size_t>(node)].parent; n >= 0;
       n = nodes[static_cast<std::size_t>(n)].parent)
    if (n == above) return true;
  return false;
}

/// By the names of joints; without a skin, of all nodes.
void Planner::find_bones() {
  const Character& character = plan_.character;
  std::vector<int> candidates;
  std::set<int> seen;
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints)
      if (seen.insert(joint).second) candidates.push_back(joint);
  for (int n = 0; candidates.empty() && n < static_cast<int>(character.nodes.size()); ++n) seen.insert(n);
  if (candidates.empty()) candidates.assign(seen.begin(), seen.end());
  std::vector<std::string> names;
  for (const int node : candidates) names.push_back(character.nodes[static_cast<std::size_t>(node)].name);
  const std::vector<int> found = joints_of(names);
  const std::vector<std::string> bones = joint_names_in(JointConvention::vrm);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (found[k] < 0 || bones[static_cast<std::size_t>(found[k])].empty()) continue;
    if (character.nodes[static_cast<std::size_t>(candidates[k])].rest.scale.minCoeff() > 0)
      bones_[bones[static_cast<std::size_t>(found[k])]] = candidates[k];
  }
}

/// Bones that do not hang where VRM has them are no bones; the head always is one.
void Planner::drop_misplaced() {
  if (bones_.contains("head"))
    for (const char* bone : {"hips", "spine", "chest", "upperChest", "neck"})
      if (bones_.contains(bone) && !is_above(bones_.at(bone), bones_.at("head"))) bones_.erase(bone);
  for (bool dropped = true; dropped;) {
    dropped = false;
    for (auto bone = bones_.begin(); bone != bones_.end() && !dropped; ++bone) {
      const auto& above = bone_above();
      auto parent = above.find(bone->first);
      const bool needs =
          bone->first == "upperChest" || (bone->first.find("Distal") != std::string::npos ||
                                          bone->first.find("Intermediate") != std::string::npos ||
                                          bone->first.find("ThumbProximal") != std::string::npos);
      if (parent == above.end()) continue;
      bool wrong = needs && !bones_.contains(parent->second);
      while (parent != above.end() && !bones_.contains(parent->second)) parent = above.find(parent->second);
      if (parent != above.end()) wrong = wrong || !is_above(bones_.at(parent->second), bone->second);
      if (!wrong) continue;
      bones_.erase(bone);
      dropped = true;
    }
  }
}

double Planner::head_height() const {
  double height = 0;
  const auto model = model_matrices(plan_.character);
  for (const Part& part : plan_.character.parts) {
    const Box box = bounding_box(part.mesh.positions);
    const double scale = part.skin < 0 && part.node >= 0
                             ? model[static_cast<std::size_t>(part.node)].col(1).head<3>().norm()
                             : 1;
    height = std::max(height, scale * static_cast<double>((box.high - box.low).y()));
  }
  return height > 0 ? height : 1;
}

/// The middle of the lower edge of the largest part, model space.
Vector3d Planner::under_the_head() const {
  Box largest;
  for (const Part& part : plan_.character.parts) {
    const Box box = bounding_box(part.mesh.positions);
    if (box.diagonal() > largest.diagonal()) largest = box;
  }
  return {largest.centre().x(), largest.low.y(), largest.centre().z()};
}

int Planner::add_node(const std::string& name, int parent, const Vector3d& at_model) {
  Node node;
  node.name = name;
  for (int number = 2; find_node(plan_.character, node.name) >= 0; ++number)
    node.name = name + std::to_string(number);
  node.parent = parent;
  Eigen::Vector4d at = at_model.homogeneous();
  if (parent >= 0)
    at = model_matrices(plan_.character)[static_cast<std::size_t>(parent)].fullPivLu().solve(at);
  node.rest.translation = at.head<3>();
  nodes().push_back(std::move(node));
  plan_.made_bones.push_back(name);
  return static_cast<int>(nodes().size()) - 1;
}

/// Head, spine and hips, in that order: each new one takes its place right above what it must carry.
void Planner::make_spine() {
  if (!bones_.contains("head"))
    bones_["head"] = add_node("head", bones_.contains("neck") ? bones_["neck"] : -1, under_the_head());
  const auto insert_above = [&](const std::string& bone, int below) {
    const int parent = nodes()[static_cast<std::size_t>(below)].parent;
    Node node;
    node.name = find_node(plan_.character, bone) < 0 ? bone : "vrm_" + bone;
    node.parent = parent;
    nodes().push_back(std::move(node));
    bones_[bone] = static_cast<int>(nodes().size()) - 1;
    nodes()[static_cast<std::size_t>(below)].parent = bones_[bone];
    plan_.made_bones.push_back(bone);
  };
  const auto lowest_bone = [&] {  // what a spine must carry: the first of the chain that is there
    for (const char* bone : {"chest", "upperChest", "neck", "head"})
      if (bones_.contains(bone)) return bones_[bone];
    return bones_["head"];
  };
  if (!bones_.contains("spine")) {
    int below = lowest_bone();
    // Through nodes that are no bones, up to what hangs on the hips.
    while (nodes()[static_cast<std::size_t>(below)].parent >= 0 &&
           !(bones_.contains("hips") && nodes()[static_cast<std::size_t>(below)].parent == bones_["hips"]))
      below = nodes()[static_cast<std::size_t>(below)].parent;
    insert_above("spine", below);
  }
  if (!bones_.contains("hips")) insert_above("hips", bones_["spine"]);
}

void Planner::make_limbs() {
  const double height = head_height();
  const Vector3d head =
      model_matrices(plan_.character)[static_cast<std::size_t>(bones_["head"])].topRightCorner<3, 1>();
  for (const std::string side : {"left", "right"})
    for (const Limb& limb : limbs()) {
      const std::string name = side + std::string(limb.name);
      std::string above(limb.above);
      if (above == "spine")
        for (const std::string& candidate :
             {side + "Shoulder", std::string("upperChest"), std::string("chest"), std::string("spine")})
          if (bones_.contains(candidate)) {
            above = candidate;
            break;
          }
      if (above != "hips" && !bones_.contains(above)) above = side + above;
      const auto there = bones_.find(name);
      if (there != bones_.end() && is_above(bones_.at(above), there->second)) continue;
      Vector3d at = limb.at;
      if (side == "right") at.x() = -at.x();
      bones_[name] = add_node(name, bones_.at(above), head + height * at);
    }
}

void Planner::list_bones() {
  for (const std::string& name : joint_names())
    if (const auto bone = bones_.find(name); bone != bones_.end())
      plan_.avatar.bones.push_back({name, bone->second});
}

/// The shapes that show with these values of sliders.
std::vector<VrmBind> Planner::binds_of(const std::vector<SliderLink>& links) const {
  const Character& character = plan_.character;
  SliderValues values = rest_sliders(character);
  const ShapeWeights before = shape_weights(character, values);
  for (const SliderLink& link : links) {
    const int slider = find_slider(character, link.to);
    const Slider& at = character.sliders[static_cast<std::size_t>(slider)];
    values.values[slider] = std::clamp(values.values[slider] + link.gain, at.minimum, at.maximum);
  }
  const ShapeWeights after = shape_weights(character, values);
  std::vector<VrmBind> binds;
  for (int s = 0; s < static_cast<int>(character.shapes.size()); ++s) {
    const double weight = std::clamp(after.values[s] - before.values[s], 0.0, 1.0);
    if (weight > 1e-6) binds.push_back({s, weight});
  }
  return binds;
}

void Planner::add_preset(const std::string& name) {
  static const std::map<std::string, std::string> visemes = {
      {"aa", "viseme_aa"}, {"ih", "viseme_I"}, {"ou", "viseme_U"}, {"ee", "viseme_E"}, {"oh", "viseme_O"}};
  const Character& character = plan_.character;
  VrmExpression expression;
  expression.name = name;
  expression.is_preset = true;
  std::vector<SliderLink> links;
  const auto viseme = visemes.find(name);
  const auto saved = std::find_if(character.expressions.begin(), character.expressions.end(),
                                  [&](const Expression& one) { return one.name == name; });
  if (saved != character.expressions.end()) {
    for (const ExpressionValue& value : saved->values)
      links.push_back({name, character.sliders[static_cast<std::size_t>(value.slider)].name, value.value});
  } else if (find_slider(character, name) < 0 && viseme != visemes.end() &&
             find_slider(character, viseme->second) >= 0) {
    links.push_back({name, viseme->second, 1});
  } else {
    links = link_sliders({name}, character);
  }
  expression.binds = binds_of(links);
  if (expression.binds.empty()) {
    if (name != "neutral") plan_.missing_presets.push_back(name);
    return;
  }
  static const std::set<std::string> emotions = {"happy", "angry", "sad", "relaxed", "surprised"};
  if (emotions.contains(name))
    for (const ActionShare& share : actions_of(name)) {
      const std::string& action = action_names()[static_cast<std::size_t>(share.action)];
      if (action.starts_with("mouth") || action.starts_with("jaw")) expression.mouth = VrmOverride::blend;
      if (action.starts_with("eyeBlink") || action.starts_with("eyeSquint"))
        expression.blink = VrmOverride::blend;
    }
  plan_.avatar.expressions.push_back(std::move(expression));
}

void Planner::add_presets() {
  for (const char* name :
       {"happy", "angry", "sad", "relaxed", "surprised", "aa", "ih", "ou", "ee", "oh", "blink", "blinkLeft",
        "blinkRight", "lookUp", "lookDown", "lookLeft", "lookRight", "neutral"})
    add_preset(name);
}

void Planner::add_custom() {
  std::set<std::string> taken(plan_.missing_presets.begin(), plan_.missing_presets.end());
  taken.insert("neutral");
  for (const VrmExpression& expression : plan_.avatar.expressions) taken.insert(expression.name);
  const auto add = [&](const std::string& name, const std::vector<SliderLink>& links) {
    VrmExpression expression;
    expression.name = name;
    expression.binds = binds_of(links);
    if (!name.empty() && !expression.binds.empty() && taken.insert(name).second)
      plan_.avatar.expressions.push_back(std::move(expression));
  };
  for (const Expression& saved : plan_.character.expressions) {
    std::vector<SliderLink> links;
    for (const ExpressionValue& value : saved.values)
      links.push_back(
          {saved.name, plan_.character.sliders[static_cast<std::size_t>(value.slider)].name, value.value});
    add(saved.name, links);
  }
  for (const Slider& slider : plan_.character.sliders) add(slider.name, {{slider.name, slider.name, 1}});
}

void Planner::add_look_at() {
  const auto has = [&](const char* name) {
    return std::any_of(plan_.avatar.expressions.begin(), plan_.avatar.expressions.end(),
                       [&](const VrmExpression& expression) { return expression.name == name; });
  };
  VrmLookAt look_at;
  look_at.by_bones = bones_.contains("leftEye") && bones_.contains("rightEye");
  const auto model = model_matrices(plan_.character);
  if (look_at.by_bones) {
    const auto origin = [&](const char* bone) -> Eigen::Vector4d {
      return model[static_cast<std::size_t>(bones_.at(bone))].col(3);
    };
    const Eigen::Vector4d middle = 0.5 * (origin("leftEye") + origin("rightEye"));
    look_at.offset_from_head =
        model[static_cast<std::size_t>(bones_.at("head"))].fullPivLu().solve(middle).head<3>();
  } else if (has("lookUp") && has("lookDown") && has("lookLeft") && has("lookRight")) {
    look_at.output_scale = 1;
  } else {
    return;
  }
  plan_.avatar.look_at = look_at;
}

VrmPlan Planner::run() {
  find_bones();
  drop_misplaced();
  make_spine();
  make_limbs();
  drop_misplaced();
  list_bones();
  add_presets();
  add_custom();
  add_look_at();
  return std::move(plan_);
}

}  // namespace

VrmPlan plan_vrm(const Character& character, const VrmMeta& meta) {
  return Planner(character, meta).run();
}

}  // namespace mien
