#include "mien/motion/retarget_sliders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/motion/detail/slider_channel.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

Eigen::Index stream_named(const SliderTake& take, const std::string& name) {
  const auto found = std::find(take.names.begin(), take.names.end(), name);
  if (found == take.names.end())
    throw invalid_input("link from " + name, "names no stream",
                        "name one of the take's " + std::to_string(take.names.size()));
  return found - take.names.begin();
}

int slider_named(const Character& character, const std::string& name) {
  const int slider = find_slider(character, name);
  if (slider < 0)
    throw invalid_input(
        "slider " + name, "does not exist",
        "name one of the character's " + std::to_string(character.sliders.size()) + " sliders");
  return slider;
}

std::size_t frame_at(const SliderTake& take, double seconds) {
  if (!std::isfinite(seconds) || seconds < 0 || seconds > take.seconds.back())
    throw invalid_input("neutral time", "is " + std::to_string(seconds),
                        "give seconds from 0 to " + std::to_string(take.seconds.back()));
  const auto after = std::lower_bound(take.seconds.begin(), take.seconds.end(), seconds);
  return static_cast<std::size_t>(after - take.seconds.begin());
}

/// The neutral of a stream becomes 0, what was 1 stays 1.
Eigen::VectorXd calibrated(Eigen::VectorXd values, double neutral) {
  const double room = std::max(1 - neutral, 0.1);
  return (values.array() - neutral) / room;
}

void check(const SliderTake& take, const RetargetOptions& options) {
  const auto frames = static_cast<Eigen::Index>(take.seconds.size());
  if (frames == 0 || take.values.rows() != frames ||
      take.values.cols() != static_cast<Eigen::Index>(take.names.size()))
    throw invalid_input("take", "has no frames or arrays of unequal length", "give one row a frame");
  if (!take.values.allFinite()) throw invalid_input("take", "has values that are not finite");
  if (!std::isfinite(options.smooth) || options.smooth < 0)
    throw invalid_input("smoothing", "is " + std::to_string(options.smooth), "give seconds, 0 or more");
  for (const auto& [slider, gain] : options.gains)
    if (!std::isfinite(gain)) throw invalid_input("gain of " + slider, "is not finite");
}

/// What Live Link calls the three angles of a joint, and what characters call the joint.
struct TurnedJoint {
  std::string_view streams;                ///< "Head": HeadYaw, HeadPitch, HeadRoll
  std::array<std::string_view, 5> joints;  ///< plain lower-case names
  std::string_view slider;                 ///< a slider that does the same, if the character has it
};
constexpr std::array<TurnedJoint, 3> turned_joints{{
    {"Head", {"head", "headjoint", "mixamorighead", "defspine006", "c_head"}, ""},
    {"LeftEye", {"eyel", "eyeleft", "lefteye", "eyeleftjoint", "defeyel"}, "eyeLookUpLeft"},
    {"RightEye", {"eyer", "eyeright", "righteye", "eyerightjoint", "defeyer"}, "eyeLookUpRight"},
}};

int joint_of(const Character& character, const TurnedJoint& turned) {
  for (const std::string_view name : turned.joints)
    for (const Skin& skin : character.skins)
      for (const int joint : skin.joints)
        if (bare_name(character.nodes[static_cast<std::size_t>(joint)].name) == name) return joint;
  return -1;
}

bool has_slider_for(const Character& character, std::string_view action) {
  if (action.empty()) return false;
  const std::vector<ActionShare> wanted = actions_of(action);
  return std::any_of(character.sliders.begin(), character.sliders.end(),
                     [&](const Slider& slider) { return actions_of(slider.name) == wanted; });
}

/// A joint turned about the model's axes: the rotation in model space, carried into the parent's space.
Channel turned_channel(const Character& character, int joint, const SliderTake& take,
                       const Eigen::MatrixX3d& angles) {
  const Node& node = character.nodes[static_cast<std::size_t>(joint)];
  Eigen::Quaterniond parent = Eigen::Quaterniond::Identity();
  if (node.parent >= 0) {
    const Eigen::Matrix3d model =
        model_matrices(character)[static_cast<std::size_t>(node.parent)].topLeftCorner<3, 3>();
    Eigen::Matrix3d axes = model;
    for (int k = 0; k < 3; ++k) axes.col(k).normalize();
    parent = Eigen::Quaterniond(axes).normalized();
  }
  Channel channel;
  channel.property = Channel::Property::rotation;
  channel.node = joint;
  for (std::size_t f = 0; f < take.seconds.size(); ++f) {
    const Eigen::RowVector3d a = angles.row(static_cast<Eigen::Index>(f));
    const Eigen::Quaterniond turn = Eigen::AngleAxisd(a[0], Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(a[1], Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(a[2], Eigen::Vector3d::UnitZ());
    const Eigen::Quaterniond local = parent.inverse() * turn * parent * node.rest.rotation;
    channel.times.push_back(static_cast<float>(take.seconds[f]));
    for (int k = 0; k < 4; ++k) channel.values.push_back(static_cast<float>(local.normalized().coeffs()[k]));
  }
  return channel;
}

class Retargeter {
 public:
  Retargeter(const SliderTake& take, const Character& character, const RetargetOptions& options)
      : take_(take), character_(character), options_(options) {}
  RetargetResult run();

 private:
  Eigen::VectorXd stream(Eigen::Index column, bool calibrate) const;
  void drive_sliders();
  void turn_joints();
  void list_rest();

  const SliderTake& take_;
  const Character& character_;
  const RetargetOptions& options_;
  RetargetResult result_;
  std::set<std::string> used_;
};

Eigen::VectorXd Retargeter::stream(Eigen::Index column, bool calibrate) const {
  Eigen::VectorXd values = take_.values.col(column);
  if (options_.neutral_at) {
    const double neutral = values[static_cast<Eigen::Index>(frame_at(take_, *options_.neutral_at))];
    values = calibrate ? calibrated(values, neutral) : Eigen::VectorXd(values.array() - neutral);
  }
  return smooth_stream(values, take_.seconds, options_.smooth, detail::quick_change);
}

void Retargeter::drive_sliders() {
  for (int s = 0; s < static_cast<int>(character_.sliders.size()); ++s) {
    const Slider& slider = character_.sliders[static_cast<std::size_t>(s)];
    Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(take_.seconds.size()));
    bool driven = false;
    for (const SliderLink& link : result_.links) {
      if (link.to != slider.name) continue;
      values += link.gain * stream(stream_named(take_, link.from), true);
      used_.insert(link.from);
      driven = true;
    }
    if (!driven) {
      result_.still.push_back(slider.name);
      continue;
    }
    if (const auto gain = options_.gains.find(slider.name); gain != options_.gains.end())
      values *= gain->second;
    if (!options_.overdrive) values = values.cwiseMax(slider.minimum).cwiseMin(slider.maximum);
    result_.clip.channels.push_back(detail::slider_channel(s, take_.seconds, values));
  }
}

void Retargeter::turn_joints() {
  for (const TurnedJoint& turned : turned_joints) {
    const int joint = joint_of(character_, turned);
    if (joint < 0 || has_slider_for(character_, turned.slider)) continue;
    Eigen::MatrixX3d angles = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(take_.seconds.size()), 3);
    bool any = false;
    constexpr std::array<std::string_view, 3> axes{"Yaw", "Pitch", "Roll"};
    for (int k = 0; k < 3; ++k) {
      const std::string name = std::string(turned.streams) + std::string(axes[static_cast<std::size_t>(k)]);
      const auto found = std::find(take_.names.begin(), take_.names.end(), name);
      if (found == take_.names.end()) continue;
      angles.col(k) = stream(found - take_.names.begin(), false);
      used_.insert(name);
      any = true;
    }
    if (any) result_.clip.channels.push_back(turned_channel(character_, joint, take_, angles));
  }
}

void Retargeter::list_rest() {
  for (const std::string& name : take_.names)
    if (!used_.contains(name)) result_.unmapped.push_back(name);
}

RetargetResult Retargeter::run() {
  check(take_, options_);
  result_.links = options_.links.empty() ? link_sliders(take_.names, character_) : options_.links;
  for (const SliderLink& link : result_.links) {
    stream_named(take_, link.from);
    slider_named(character_, link.to);
  }
  for (const auto& [slider, gain] : options_.gains) slider_named(character_, slider);
  result_.clip.name = "capture";
  drive_sliders();
  if (options_.joints) turn_joints();
  if (result_.clip.channels.empty())
    throw invalid_input("take", "has no stream that drives a slider of the character",
                        "give links from its streams, such as " + take_.names.front());
  list_rest();
  return std::move(result_);
}

}  // namespace

RetargetResult retarget(const SliderTake& take, const Character& character, const RetargetOptions& options) {
  return Retargeter(take, character, options).run();
}

}  // namespace mien
