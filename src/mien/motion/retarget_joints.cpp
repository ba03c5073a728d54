#include "mien/motion/retarget_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "mien/character/pose.h"
#include "mien/core/error.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/evaluate.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

int node_named(const Character& character, const std::string& name, const char* whose) {
  const int node = find_node(character, name);
  if (node < 0)
    throw invalid_input("joint " + name, std::string("does not exist in the ") + whose,
                        "name one of its joints");
  return node;
}

/// Per target node the source node that drives it, -1: none.
std::vector<int> drivers(const Character& source, const Character& target,
                         const std::map<std::string, std::string>& names) {
  std::vector<int> driver(target.nodes.size(), -1);
  for (const auto& [from, to] : names)
    driver[static_cast<std::size_t>(node_named(target, to, "target"))] = node_named(source, from, "source");
  if (!names.empty()) return driver;
  for (std::size_t t = 0; t < target.nodes.size(); ++t)
    for (std::size_t s = 0; s < source.nodes.size() && driver[t] < 0; ++s)
      if (!target.nodes[t].name.empty() && bare_name(source.nodes[s].name) == bare_name(target.nodes[t].name))
        driver[t] = static_cast<int>(s);
  return driver;
}

Eigen::Quaterniond rotation_of(const Eigen::Matrix4d& matrix) {
  Eigen::Matrix3d axes = matrix.topLeftCorner<3, 3>();
  for (int k = 0; k < 3; ++k) axes.col(k).normalize();
  return Eigen::Quaterniond(axes).normalized();
}

/// Parents before children.
std::vector<int> top_down(const Character& character) {
  std::vector<int> order;
  std::vector<char> placed(character.nodes.size(), 0);
  while (order.size() < character.nodes.size())
    for (std::size_t n = 0; n < placed.size(); ++n) {
      const int parent = character.nodes[n].parent;
      if (placed[n] || (parent >= 0 && !placed[static_cast<std::size_t>(parent)])) continue;
      placed[n] = 1;
      order.push_back(static_cast<int>(n));
    }
  return order;
}

std::vector<float> key_times(const Clip& clip) {
  std::vector<float> times;
  for (const Channel& channel : clip.channels)
    times.insert(times.end(), channel.times.begin(), channel.times.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// How large the driven joints lie about, rms from their centre.
double spread(const std::vector<Eigen::Matrix4d>& model, const std::vector<int>& nodes) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const int n : nodes) centre += model[static_cast<std::size_t>(n)].topRightCorner<3, 1>();
  centre /= static_cast<double>(nodes.size());
  double sum = 0;
  for (const int n : nodes)
    sum += (model[static_cast<std::size_t>(n)].topRightCorner<3, 1>() - centre).squaredNorm();
  return std::sqrt(sum / static_cast<double>(nodes.size()));
}

class JointRetargeter {
 public:
  JointRetargeter(const Character& source, const Clip& clip, const Character& target, std::vector<int> driver)
      : source_(source),
        clip_(clip),
        target_(target),
        driver_(std::move(driver)),
        source_rest_(model_matrices(source)),
        target_rest_(model_matrices(target)),
        order_(top_down(target)),
        channels_(target.nodes.size()) {}
  RetargetJointsResult run();

 private:
  void find_root();
  void add_frame(float time);
  double size_ratio() const;

  const Character& source_;
  const Clip& clip_;
  const Character& target_;
  std::vector<int> driver_;
  std::vector<Eigen::Matrix4d> source_rest_, target_rest_;
  std::vector<int> order_;
  std::vector<Channel> channels_;
  int root_ = -1;  ///< the target joint that is moved
  Channel root_moves_;
  double ratio_ = 1;
};

double JointRetargeter::size_ratio() const {
  std::vector<int> from, to;
  for (std::size_t t = 0; t < driver_.size(); ++t)
    if (driver_[t] >= 0) {
      to.push_back(static_cast<int>(t));
      from.push_back(driver_[t]);
    }
  const double source = spread(source_rest_, from);
  return source > 0 ? spread(target_rest_, to) / source : 1;
}

void JointRetargeter::find_root() {
  std::set<int> moved;
  for (const Channel& channel : clip_.channels)
    if (channel.property == Channel::Property::translation) moved.insert(channel.node);
  for (const int t : order_)
    if (driver_[static_cast<std::size_t>(t)] >= 0 && moved.contains(driver_[static_cast<std::size_t>(t)])) {
      root_ = t;
      return;
    }
}

void JointRetargeter::add_frame(float time) {
  const std::vector<Eigen::Matrix4d> moved = posed_matrices(source_, sample_clip(source_, clip_, time));
  std::vector<Eigen::Quaterniond> model(target_.nodes.size());
  for (const int t : order_) {
    const auto index = static_cast<std::size_t>(t);
    const Node& node = target_.nodes[index];
    const Eigen::Quaterniond parent =
        node.parent >= 0 ? model[static_cast<std::size_t>(node.parent)] : Eigen::Quaterniond::Identity();
    const int s = driver_[index];
    if (s < 0) {
      model[index] = parent * node.rest.rotation;
      continue;
    }
    const Eigen::Quaterniond turn = rotation_of(moved[static_cast<std::size_t>(s)]) *
                                    rotation_of(source_rest_[static_cast<std::size_t>(s)]).inverse();
    model[index] = turn * rotation_of(target_rest_[index]);
    const Eigen::Quaterniond local = (parent.inverse() * model[index]).normalized();
    channels_[index].times.push_back(time);
    for (int k = 0; k < 4; ++k) channels_[index].values.push_back(static_cast<float>(local.coeffs()[k]));
  }
  if (root_ < 0) return;
  const auto root = static_cast<std::size_t>(root_), s = static_cast<std::size_t>(driver_[root]);
  const Eigen::Vector3d step = ratio_ * (moved[s] - source_rest_[s]).topRightCorner<3, 1>();
  Eigen::Vector3d local = step;
  if (const int parent = target_.nodes[root].parent; parent >= 0)
    local = target_rest_[static_cast<std::size_t>(parent)].topLeftCorner<3, 3>().inverse() * step;
  local += target_.nodes[root].rest.translation;
  root_moves_.times.push_back(time);
  for (int k = 0; k < 3; ++k) root_moves_.values.push_back(static_cast<float>(local[k]));
}

RetargetJointsResult JointRetargeter::run() {
  RetargetJointsResult result;
  result.clip.name = clip_.name.empty() ? "capture" : clip_.name;
  if (std::none_of(driver_.begin(), driver_.end(), [](int s) { return s >= 0; }))
    throw invalid_input("clip " + clip_.name, "moves no joint that the character has by name",
                        "give a map of joint names");
  find_root();
  ratio_ = size_ratio();
  for (const float time : key_times(clip_)) add_frame(time);
  std::set<int> driving;
  for (std::size_t t = 0; t < driver_.size(); ++t) {
    if (driver_[t] < 0) continue;
    driving.insert(driver_[t]);
    result.mapped.push_back(source_.nodes[static_cast<std::size_t>(driver_[t])].name + " -> " +
                            target_.nodes[t].name);
    channels_[t].property = Channel::Property::rotation;
    channels_[t].node = static_cast<int>(t);
    result.clip.channels.push_back(std::move(channels_[t]));
  }
  if (root_ >= 0) {
    root_moves_.property = Channel::Property::translation;
    root_moves_.node = root_;
    result.clip.channels.push_back(std::move(root_moves_));
  }
  std::set<int> animated;
  for (const Channel& channel : clip_.channels)
    if (channel.node >= 0) animated.insert(channel.node);
  for (const int n : animated)
    if (!driving.contains(n)) result.unmapped.push_back(source_.nodes[static_cast<std::size_t>(n)].name);
  return result;
}

}  // namespace

RetargetJointsResult retarget_joints(const Character& source, const Clip& clip, const Character& target,
                                     const std::map<std::string, std::string>& names) {
  return JointRetargeter(source, clip, target, drivers(source, target, names)).run();
}

}  // namespace mien
