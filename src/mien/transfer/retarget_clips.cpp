// No surface is registered here: the two rigs are each other's correspondence already. Where their points are too few or on a line,
// the boxes of the two characters say how sizes compare.
#include "mien/transfer/retarget_clips.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "mien/character/landmark_points.h"
#include "mien/core/error.h"
#include "mien/geometry/moving_similarity.h"
#include "mien/transfer/carry_clips.h"
#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

/// The blur of each point, relative to the points' box.
constexpr double softness = 0.02;

template <class Element>
std::vector<int> by_name(const std::vector<Element>& source, const std::vector<Element>& target,
                         const std::function<bool(const Element&, const Element&)>& fits) {
  std::vector<int> index(source.size(), -1);
  for (std::size_t i = 0; i < source.size(); ++i)
    for (std::size_t j = 0; j < target.size() && index[i] < 0; ++j)
      if (source[i].name == target[j].name && fits(source[i], target[j])) index[i] = static_cast<int>(j);
  return index;
}

template <class Element>
bool always(const Element&, const Element&) {
  return true;
}

/// Joints first: a part's node may bear a joint's name.
std::vector<int> nodes_by_name(const Character& source, const Character& target) {
  std::vector<char> is_joint(target.nodes.size(), 0);
  for (const Skin& skin : target.skins)
    for (const int joint : skin.joints) is_joint[at(joint)] = 1;
  std::vector<int> index(source.nodes.size(), -1);
  for (std::size_t i = 0; i < source.nodes.size(); ++i)
    for (const bool joints : {true, false})
      for (std::size_t j = 0; j < target.nodes.size() && index[i] < 0; ++j)
        if ((is_joint[j] != 0) == joints && source.nodes[i].name == target.nodes[j].name)
          index[i] = static_cast<int>(j);
  return index;
}

/// Points of one and the same place on both characters.
struct PointPairs {
  std::vector<Eigen::RowVector3d> from, to;
  void add(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) {
    from.push_back(a);
    to.push_back(b);
  }
  static PointsD rows(const std::vector<Eigen::RowVector3d>& list) {
    PointsD points(static_cast<Eigen::Index>(list.size()), 3);
    for (std::size_t i = 0; i < list.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = list[i];
    return points;
  }
};

PointPairs shared_points(const Character& source, const Character& target, const ClipMap& map) {
  PointPairs pairs;
  const auto a = model_matrices(source), b = model_matrices(target);
  for (const Skin& skin : source.skins)
    for (const int joint : skin.joints)
      if (const int other = map.nodes[at(joint)].node; other >= 0)
        pairs.add(a[at(joint)].topRightCorner<3, 1>().transpose(),
                  b[at(other)].topRightCorner<3, 1>().transpose());
  const auto add_rows = [&](const PointsD& x, const PointsD& y) {
    for (Eigen::Index i = 0; i < x.rows(); ++i) pairs.add(x.row(i), y.row(i));
  };
  for (std::size_t o = 0; o < source.objects.size(); ++o)
    if (map.object_of[o] >= 0)
      add_rows(source.objects[o].controls, target.objects[at(map.object_of[o])].controls);
  for (std::size_t w = 0; w < source.wires.size(); ++w)
    if (map.wire_of[w] >= 0)
      add_rows(source.wires[w].curve.controls, target.wires[at(map.wire_of[w])].curve.controls);
  const auto marks = landmark_points(source), others = landmark_points(target);
  for (std::size_t i = 0; i < marks.size(); ++i)
    for (std::size_t j = 0; j < others.size(); ++j)
      if (source.landmarks[i].name == target.landmarks[j].name)
        pairs.add(marks[i].position.transpose(), others[j].position.transpose());
  return pairs;
}

/// Whether points span more than a line.
bool spread(const PointsD& points) {
  if (points.rows() < 3) return false;
  const PointsD centred = points.rowwise() - points.colwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred.transpose() * centred);
  return axes.eigenvalues()[1] > 1e-6 * axes.eigenvalues()[2];
}

double box_diagonal(const Character& character) {
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const auto model = model_matrices(character);
  for (const Part& part : character.parts) {
    const Eigen::Matrix4d matrix =
        part.skin < 0 && part.node >= 0 ? model[at(part.node)] : Eigen::Matrix4d::Identity();
    for (Eigen::Index v = 0; v < part.mesh.positions.rows(); ++v) {
      const Eigen::Vector3d local = part.mesh.positions.row(v).transpose().cast<double>();
      const Eigen::RowVector3d x = (matrix * local.homogeneous()).head<3>().transpose();
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  return (high - low).allFinite() ? (high - low).norm() : 0;
}

Eigen::Matrix3d rotation_of(const std::vector<Eigen::Matrix4d>& model, int node) {
  return node < 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                  : closest_rotation(model[at(node)].topLeftCorner<3, 3>());
}

/// The rotation that turns every joint's frame on the source into its frame on the target, where there is one: a transferred rig has
/// it, and to know it to the digit keeps its clips to the digit.
std::optional<Eigen::Matrix3d> common_turn(const Character& source, const Character& target,
                                           const ClipMap& map) {
  constexpr double widest = 0.01;
  const auto a = model_matrices(source), b = model_matrices(target);
  std::vector<Eigen::Matrix3d> turns;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Skin& skin : source.skins)
    for (const int joint : skin.joints)
      if (const int other = map.nodes[at(joint)].node; other >= 0) {
        turns.push_back(rotation_of(b, other) * rotation_of(a, joint).transpose());
        sum += turns.back();
      }
  if (turns.empty()) return std::nullopt;
  const Eigen::Matrix3d mean = closest_rotation(sum);
  for (const Eigen::Matrix3d& turn : turns)
    if ((turn - mean).norm() > widest) return std::nullopt;
  return mean;
}

/// How lengths and directions of the source's space become the target's.
struct Growth {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  std::function<double(const Eigen::Vector3d&)> scale;
};

Growth growth_of(const Character& source, const Character& target, const ClipMap& map) {
  const PointPairs pairs = shared_points(source, target, map);
  const PointsD from = PointPairs::rows(pairs.from), to = PointPairs::rows(pairs.to);
  Growth growth;
  if (!spread(from) || !spread(to)) {
    const double a = box_diagonal(source), b = box_diagonal(target);
    growth.scale = [ratio = a > 0 && b > 0 ? b / a : 1.0](const Eigen::Vector3d&) { return ratio; };
    return growth;
  }
  const Similarity whole = fit_similarity(from, to);
  growth.rotation = common_turn(source, target, map).value_or(whole.rotation);
  const double size = bounding_box(from).diagonal();
  const auto local = std::make_shared<MovingSimilarity>(from, to, softness * size);
  growth.scale = [local](const Eigen::Vector3d& x) { return local->at(x).scale; };
  return growth;
}

void place_nodes(const Character& source, const Character& target, const Growth& growth, ClipMap& map) {
  const auto a = model_matrices(source), b = model_matrices(target);
  for (std::size_t n = 0; n < map.nodes.size(); ++n) {
    NodeMotion& motion = map.nodes[n];
    if (motion.node < 0) continue;
    const Node &from = source.nodes[n], &to = target.nodes[at(motion.node)];
    motion.from = from.rest;
    motion.to = to.rest;
    motion.growth = growth.scale(a[n].topRightCorner<3, 1>());
    motion.parent_turn = Eigen::Quaterniond(Eigen::Matrix3d(rotation_of(b, to.parent).transpose() *
                                                            growth.rotation * rotation_of(a, from.parent)));
    motion.own_turn = Eigen::Quaterniond(Eigen::Matrix3d(
        rotation_of(b, motion.node).transpose() * growth.rotation * rotation_of(a, static_cast<int>(n))));
  }
}

}  // namespace

RetargetedClips retarget_clips(const Character& source, const Character& target) {
  if (source.clips.empty())
    throw invalid_input("source", "has no clips", "a character with animation (`mien inspect` lists it)");
  ClipMap map;
  for (const int node : nodes_by_name(source, target)) {
    map.nodes.emplace_back();
    map.nodes.back().node = node;
  }
  map.shape_of = by_name<Shape>(source.shapes, target.shapes, always<Shape>);
  map.slider_of = by_name<Slider>(source.sliders, target.sliders, always<Slider>);
  map.wire_of = by_name<Wire>(source.wires, target.wires, [](const Wire& a, const Wire& b) {
    return a.curve.control_count() == b.curve.control_count() && a.turn_controls == b.turn_controls;
  });
  map.object_of = by_name<InfluenceObject>(
      source.objects, target.objects, [](const InfluenceObject& a, const InfluenceObject& b) {
        return a.form.index() == b.form.index() && a.controls.rows() == b.controls.rows();
      });
  const Growth growth = growth_of(source, target, map);
  place_nodes(source, target, growth, map);
  map.rotation = [&](const Eigen::Vector3d&) { return growth.rotation; };
  map.move = [&](const PointsD& places, const PointsD& moves) {
    PointsD carried = moves * growth.rotation.transpose();
    for (Eigen::Index i = 0; i < carried.rows(); ++i)
      carried.row(i) *= growth.scale(places.row(i).transpose());
    return carried;
  };
  RetargetedClips result;
  result.differences = rig_differences(source, target);
  for (const Clip& clip : source.clips) result.clips.push_back(carry_clip(source, clip, map, result.dropped));
  return result;
}

}  // namespace mien
