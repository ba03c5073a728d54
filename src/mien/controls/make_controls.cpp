// A name is looked up as itself, then as the production's rules call it, then as the ARKit shape that it does: a configuration
// written for one convention serves the others.
#include "mien/controls/make_controls.h"

#include <algorithm>
#include <map>
#include <set>

#include "mien/controls/detail/check_config.h"
#include "mien/controls/detail/lay_out.h"
#include "mien/naming/action.h"
#include "mien/naming/wildcard.h"

namespace mien {
namespace {

/// What a slider or a joint answers to.
struct Names {
  std::vector<std::string> own;  ///< its name, then what the production's rules call it
  std::string action;            ///< what it does for the most part; "": not known
  bool is_one_action = false;    ///< and nothing besides
  Side side = Side::none;
};

bool is_direction(const std::string& action) {
  return action == "jawLeft" || action == "jawRight" || action == "mouthLeft" || action == "mouthRight";
}

Names names_of(const std::string& own, bool is_slider, const ControlConfig& config,
               std::vector<char>& used_rules) {
  Names names{{own}, {}, false, side_of_name(own)};
  for (std::size_t r = 0; r < config.names.size() && names.own.size() == 1; ++r)
    if (const auto fillings = match_wildcards(config.names[r].match, own)) {
      names.own.push_back(fill_wildcards(config.names[r].is, *fillings));
      used_rules[r] = 1;
    }
  if (names.side == Side::none) names.side = side_of_name(names.own.back());
  const std::vector<ActionShare> shares =
      is_slider ? actions_of(names.own.back()) : std::vector<ActionShare>();
  if (shares.empty()) return names;
  const auto most =
      std::max_element(shares.begin(), shares.end(),
                       [](const ActionShare& a, const ActionShare& b) { return a.share < b.share; });
  names.action = action_names()[static_cast<std::size_t>(most->action)];
  names.is_one_action = shares.size() == 1 && most->share == 1;
  if (names.is_one_action) names.side = side_of_name(names.action);
  if (is_direction(names.action)) names.side = Side::none;
  return names;
}

/// Whether one of its names fits. `exactly`: what it does counts only when that is all that it does.
bool fits(const std::string& pattern, const Names& names, bool exactly) {
  if (pattern.empty()) return false;
  const auto holds = [&](const std::string& name) { return fits_wildcards(pattern, name); };
  return std::any_of(names.own.begin(), names.own.end(), holds) ||
         (!names.action.empty() && (names.is_one_action || !exactly) && holds(names.action));
}

class Maker {
 public:
  Maker(const Character& character, const ControlConfig& config);
  MadeControls run();

 private:
  int region_of(const Names& names) const;
  void add_pads();
  void add_sliders();
  void add_joints();
  void apply_limits();
  void limit_joint(int node, const ControlLimits& limits);
  void find_mirrors();
  std::string mirror_of(const std::string& name) const;
  void report_unused();
  void add(Control control, const std::string& wanted_name);

  const ControlConfig& config_;
  MadeControls made_;
  std::vector<int> joints_;
  std::vector<Names> slider_names_, joint_names_;
  std::vector<char> slider_done_, used_names_, used_limits_;
  std::set<std::string> taken_;
  std::map<std::string, int> control_of_slider_, control_of_pad_, control_of_joint_;
};

Maker::Maker(const Character& character, const ControlConfig& config)
    : config_(config),
      slider_done_(character.sliders.size(), 0),
      used_names_(config.names.size(), 0),
      used_limits_(config.limits.size(), 0) {
  detail::check_config(config);
  made_.character = character;
  made_.character.controls.clear();
  std::set<int> seen;
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints)
      if (seen.insert(joint).second) joints_.push_back(joint);
  for (const Constraint& constraint : character.constraints)  // what others follow is taken hold of too
    for (const ConstraintSource& source : constraint.sources)
      if (seen.insert(source.node).second) joints_.push_back(source.node);
  for (const Slider& slider : character.sliders)
    slider_names_.push_back(names_of(slider.name, true, config, used_names_));
  for (const int joint : joints_)
    joint_names_.push_back(
        names_of(character.nodes[static_cast<std::size_t>(joint)].name, false, config, used_names_));
}

/// The first region that a name fits, names in their order; -1: none.
int Maker::region_of(const Names& names) const {
  using RegionSide = ControlRegion::Side;
  std::vector<std::string> all = names.own;
  if (!names.action.empty()) all.push_back(names.action);
  for (const std::string& name : all)
    for (std::size_t r = 0; r < config_.regions.size(); ++r) {
      const ControlRegion& region = config_.regions[r];
      if ((region.side == RegionSide::left && names.side != Side::left) ||
          (region.side == RegionSide::right && names.side != Side::right))
        continue;
      if (std::any_of(region.match.begin(), region.match.end(),
                      [&](const std::string& pattern) { return fits_wildcards(pattern, name); }))
        return static_cast<int>(r);
    }
  return -1;
}

void Maker::add(Control control, const std::string& wanted_name) {
  control.name = wanted_name;
  for (int number = 2; !taken_.insert(control.name).second; ++number)
    control.name = wanted_name + " " + std::to_string(number);
  if (control.name != wanted_name && control.label.empty()) control.label = wanted_name;
  made_.character.controls.push_back(std::move(control));
}

void Maker::add_pads() {
  for (const ControlPad& pad : config_.pads) {
    std::vector<int> sliders(4, -1);
    for (std::size_t d = 0; d < 4; ++d)
      for (std::size_t s = 0; s < slider_names_.size() && sliders[d] < 0; ++s)
        if (!slider_done_[s] && fits(pad.match[d], slider_names_[s], true) &&
            std::find(sliders.begin(), sliders.end(), static_cast<int>(s)) == sliders.end())
          sliders[d] = static_cast<int>(s);
    if (std::count(sliders.begin(), sliders.end(), -1) > 2) continue;
    for (const int slider : sliders)
      if (slider >= 0) slider_done_[static_cast<std::size_t>(slider)] = 1;
    Control control;
    control.label = pad.label;
    control.region = pad.region;
    control.kind = Control::Kind::pad;
    control.sliders = sliders;
    control_of_pad_[pad.name] = static_cast<int>(made_.character.controls.size());
    add(std::move(control), pad.name);
  }
}

void Maker::add_sliders() {
  const std::vector<Slider>& sliders = made_.character.sliders;
  for (std::size_t s = 0; s < sliders.size(); ++s) {
    if (slider_done_[s]) continue;
    const int region = region_of(slider_names_[s]);
    if (region < 0) made_.other_sliders.push_back(sliders[s].name);
    Control control;
    control.region = region < 0 ? config_.other : config_.regions[static_cast<std::size_t>(region)].name;
    control.sliders = {static_cast<int>(s)};
    control_of_slider_[sliders[s].name] = static_cast<int>(made_.character.controls.size());
    add(std::move(control), sliders[s].name);
  }
}

void Maker::add_joints() {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const std::string& name = made_.character.nodes[static_cast<std::size_t>(joints_[j])].name;
    const int region = region_of(joint_names_[j]);
    if (region < 0) made_.other_joints.push_back(name);
    Control control;
    control.region = region < 0 ? config_.other : config_.regions[static_cast<std::size_t>(region)].name;
    control.kind = Control::Kind::joint;
    control.node = joints_[j];
    control.moves = std::any_of(config_.moves.begin(), config_.moves.end(), [&](const std::string& pattern) {
      return fits(pattern, joint_names_[j], false);
    });
    control_of_joint_[name] = static_cast<int>(made_.character.controls.size());
    add(std::move(control), name.empty() ? "joint" : name);
  }
}

/// The one limit that a panel made before is replaced.
void Maker::limit_joint(int node, const ControlLimits& limits) {
  std::vector<Constraint>& constraints = made_.character.constraints;
  Constraint limit;
  limit.name = made_.character.nodes[static_cast<std::size_t>(node)].name + " limits";
  limit.node = node;
  limit.rotation = limits.rotation;
  limit.translation = limits.translation;
  const auto before = std::find_if(constraints.begin(), constraints.end(),
                                   [&](const Constraint& other) { return other.name == limit.name; });
  if (before == constraints.end())
    constraints.push_back(std::move(limit));
  else
    *before = std::move(limit);
}

void Maker::apply_limits() {
  for (std::size_t s = 0; s < slider_names_.size(); ++s)
    for (std::size_t l = 0; l < config_.limits.size(); ++l) {
      const ControlLimits& limits = config_.limits[l];
      if (!limits.slider || !fits(limits.match, slider_names_[s], true)) continue;
      made_.character.sliders[s].minimum = limits.slider->low;
      made_.character.sliders[s].maximum = limits.slider->high;
      used_limits_[l] = 1;
      break;
    }
  for (std::size_t j = 0; j < joints_.size(); ++j)
    for (std::size_t l = 0; l < config_.limits.size(); ++l) {
      const ControlLimits& limits = config_.limits[l];
      const std::array<ValueRange, 3> none;
      if ((limits.rotation == none && limits.translation == none) ||
          !fits(limits.match, joint_names_[j], true))
        continue;
      limit_joint(joints_[j], limits);
      used_limits_[l] = 1;
      break;
    }
}

std::string Maker::mirror_of(const std::string& name) const {
  for (const auto& [first, second] : config_.mirrors) {
    if (const auto fillings = match_wildcards(first, name)) return fill_wildcards(second, *fillings);
    if (const auto fillings = match_wildcards(second, name)) return fill_wildcards(first, *fillings);
  }
  return mirrored_name(name);
}

void Maker::find_mirrors() {
  for (const auto* table : {&control_of_slider_, &control_of_pad_, &control_of_joint_})
    for (const auto& [name, index] : *table) {
      const auto other = table->find(mirror_of(name));
      if (other == table->end() || other->second == index) continue;
      Control &a = made_.character.controls[static_cast<std::size_t>(index)],
              &b = made_.character.controls[static_cast<std::size_t>(other->second)];
      if (a.mirror >= 0 || b.mirror >= 0) continue;
      a.mirror = other->second;
      b.mirror = index;
    }
}

void Maker::report_unused() {
  for (std::size_t r = 0; r < used_names_.size(); ++r)
    if (!used_names_[r]) made_.unused.push_back("names " + config_.names[r].match);
  for (std::size_t l = 0; l < used_limits_.size(); ++l)
    if (!used_limits_[l]) made_.unused.push_back("limits " + config_.limits[l].match);
}

MadeControls Maker::run() {
  add_pads();
  add_sliders();
  add_joints();
  apply_limits();
  find_mirrors();
  report_unused();
  detail::lay_out(config_, made_.character.controls);
  return std::move(made_);
}

}  // namespace

MadeControls make_controls(const Character& character, const ControlConfig& config) {
  return Maker(character, config).run();
}

}  // namespace mien
