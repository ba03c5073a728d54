#include "mien/transfer/carry_clips.h"

#include <algorithm>

#include "mien/transfer/carry_wires.h"
#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

using Property = Channel::Property;

/// One key's values of a node's channel from the source's frames into the target's.
class NodeValues {
 public:
  explicit NodeValues(const NodeMotion& motion) : m_(motion) {
    // Without a rotation in between, the turn is what the frames have, not rounding.
    const auto settle = [](Eigen::Quaterniond q) {
      return q.angularDistance(Eigen::Quaterniond::Identity()) < 1e-7 ? Eigen::Quaterniond::Identity() : q;
    };
    parent_turn_ = settle(m_.parent_turn);
    own_turn_ = settle(m_.own_turn);
    rest_turn_ = settle(m_.to.rotation * own_turn_ * m_.from.rotation.inverse());
  }

  void translation(float* value, bool tangent) const {
    Eigen::Map<Eigen::Vector3f> v(value);
    const Eigen::Vector3d offset = tangent ? Eigen::Vector3d::Zero() : m_.from.translation;
    const Eigen::Vector3d moved = m_.growth * (parent_turn_ * (v.cast<double>() - offset));
    v = (tangent ? moved : Eigen::Vector3d(moved + m_.to.translation)).cast<float>();
  }
  void rotation(float* value, bool tangent) const {
    const Eigen::Quaterniond q(value[3], value[0], value[1], value[2]);
    Eigen::Quaterniond r = rest_turn_ * q * own_turn_.inverse();
    if (!tangent) r.normalize();
    value[0] = static_cast<float>(r.x());
    value[1] = static_cast<float>(r.y());
    value[2] = static_cast<float>(r.z());
    value[3] = static_cast<float>(r.w());
  }
  void scale(float* value) const {
    for (int k = 0; k < 3; ++k)
      if (m_.from.scale[k] != 0) value[k] = static_cast<float>(value[k] * m_.to.scale[k] / m_.from.scale[k]);
  }

 private:
  const NodeMotion& m_;
  Eigen::Quaterniond parent_turn_, own_turn_, rest_turn_;
};

/// Whether the row-th group of a channel's values is a tangent.
bool is_tangent(const Channel& channel, std::size_t row) {
  return channel.interpolation == Interpolation::cubic_spline && row % 3 != 1;
}

std::size_t row_count(const Channel& channel) {
  return channel.values.size() / static_cast<std::size_t>(channel.width());
}

void carry_node_values(const NodeMotion& motion, Channel& channel) {
  const NodeValues values(motion);
  const std::size_t width = static_cast<std::size_t>(channel.width());
  for (std::size_t i = 0; i < row_count(channel); ++i) {
    float* value = channel.values.data() + i * width;
    if (channel.property == Property::translation) values.translation(value, is_tangent(channel, i));
    if (channel.property == Property::rotation) values.rotation(value, is_tangent(channel, i));
    if (channel.property == Property::scale) values.scale(value);
  }
}

/// Displacements of one place. A tangent is carried as the rate at which the carried displacement changes at its key: a map
/// that bends space makes more of it here than there.
void carry_moves(const ClipMap& map, const Eigen::Vector3d& place, Channel& channel) {
  constexpr double instant = 1e-3;
  const Eigen::Index count = static_cast<Eigen::Index>(row_count(channel));
  PointsD moves(count, 3), keys = PointsD::Zero(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto value = [&](Eigen::Index row) {
      const float* v = channel.values.data() + 3 * row;
      return Eigen::RowVector3d(v[0], v[1], v[2]);
    };
    moves.row(i) = value(i);
    if (!is_tangent(channel, static_cast<std::size_t>(i))) continue;
    keys.row(i) = value(3 * (i / 3) + 1);
    moves.row(i) = keys.row(i) + instant * value(i);
  }
  const PointsD places = place.transpose().replicate(count, 1);
  const PointsD carried = map.move(places, moves), from = map.move(places, keys);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool tangent = is_tangent(channel, static_cast<std::size_t>(i));
    const Eigen::RowVector3d value =
        tangent ? Eigen::RowVector3d((carried.row(i) - from.row(i)) / instant) : carried.row(i);
    for (int k = 0; k < 3; ++k)
      channel.values[static_cast<std::size_t>(3 * i + k)] = static_cast<float>(value[k]);
  }
}

void carry_turns(const Eigen::Matrix3d& rotation, Channel& channel) {
  for (std::size_t i = 0; i < row_count(channel); ++i) {
    Eigen::Map<Eigen::Vector3f> value(channel.values.data() + 3 * i);
    value = (rotation * value.cast<double>()).cast<float>();
  }
}

/// What a channel animates, for people.
std::string name_of(const Character& source, const Channel& channel) {
  switch (channel.property) {
    case Property::shape_weight:
      return "shape " + source.shapes[at(channel.shape)].name;
    case Property::slider:
      return "slider " + source.sliders[at(channel.slider)].name;
    case Property::object_control:
      return "object " + source.objects[at(channel.object)].name;
    case Property::wire_control:
    case Property::wire_scale:
    case Property::wire_turn:
      return "wire " + source.wires[at(channel.wire)].name;
    default:
      return "node " + source.nodes[at(channel.node)].name;
  }
}

/// Points the channel at what it moves in the target; false where that is left out.
bool rename(const ClipMap& map, Channel& channel) {
  const auto look_up = [](const std::vector<int>& list, int& index) {
    index = index < static_cast<int>(list.size()) ? list[at(index)] : -1;
    return index >= 0;
  };
  if (channel.property == Property::shape_weight) {
    channel.part = -1;
    return look_up(map.shape_of, channel.shape);
  }
  if (channel.property == Property::slider) return look_up(map.slider_of, channel.slider);
  if (channel.property == Property::object_control) return look_up(map.object_of, channel.object);
  if (channel.moves_wire()) return look_up(map.wire_of, channel.wire);
  channel.node = map.nodes[at(channel.node)].node;
  return channel.node >= 0;
}

void carry_values(const Character& source, const Channel& original, const ClipMap& map, Channel& channel) {
  switch (channel.property) {
    case Property::translation:
    case Property::rotation:
    case Property::scale:
      return carry_node_values(map.nodes[at(original.node)], channel);
    case Property::wire_control:
      return carry_moves(
          map, source.wires[at(original.wire)].curve.controls.row(original.control).transpose(), channel);
    case Property::object_control:
      return carry_moves(map, source.objects[at(original.object)].controls.row(original.control).transpose(),
                         channel);
    case Property::wire_turn:
      return carry_turns(map.rotation(turn_place(source.wires[at(original.wire)], original.control)),
                         channel);
    case Property::shape_weight:
    case Property::slider:
    case Property::wire_scale:
      return;
  }
}

}  // namespace

std::vector<NodeMotion> node_motions(const Character& source, const CarriedSkeleton& skeleton) {
  std::vector<NodeMotion> motions(source.nodes.size());
  int first_node = -1;
  for (std::size_t n = 0; n < motions.size(); ++n) {
    NodeMotion& motion = motions[n];
    motion.node = skeleton.node_of[n];
    if (motion.node < 0) continue;
    if (first_node < 0) first_node = motion.node;
    motion.from = source.nodes[n].rest;
    motion.to = skeleton.nodes[at(motion.node - first_node)].rest;
    motion.growth = skeleton.growth[n];
    motion.parent_turn = motion.to.rotation * motion.from.rotation.inverse();
  }
  return motions;
}

Clip carry_clip(const Character& source, const Clip& clip, const ClipMap& map,
                std::vector<std::string>& dropped) {
  Clip result{clip.name, {}, clip.carried};
  for (const Channel& channel : clip.channels) {
    Channel carried = channel;
    if (!rename(map, carried)) {
      dropped.push_back("clip " + clip.name + ": " + name_of(source, channel));
      continue;
    }
    carry_values(source, channel, map, carried);
    result.channels.push_back(std::move(carried));
  }
  return result;
}

namespace {

std::vector<int> joints_of(const Character& character) {
  std::vector<int> list;
  for (const Skin& skin : character.skins) list.insert(list.end(), skin.joints.begin(), skin.joints.end());
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

std::string parent_name(const Character& character, const Node& node) {
  return node.parent < 0 ? std::string("nothing") : character.nodes[at(node.parent)].name;
}

/// Lines for what `a` has and `b` has not, and, `both`, for what both have and is not alike. `like` says how two of a name
/// differ, empty where they do not.
template <class Element, class Like>
void compare(const std::vector<Element>& a, const std::vector<Element>& b, const char* kind, bool both,
             const Like& like, std::vector<std::string>& lines) {
  for (const Element& element : a) {
    const auto other =
        std::find_if(b.begin(), b.end(), [&](const Element& e) { return e.name == element.name; });
    const std::string place = std::string(kind) + " " + element.name;
    if (other == b.end())
      lines.push_back(place + (both ? " is missing in the second" : " is missing in the first"));
    else if (const std::string how = both ? like(element, *other) : ""; !how.empty())
      lines.push_back(place + " " + how);
  }
}

std::string counts(const char* what, Eigen::Index a, Eigen::Index b) {
  return a == b ? "" : "has " + std::to_string(a) + " and " + std::to_string(b) + " " + what;
}

void compare_joints(const Character& a, const Character& b, bool both, std::vector<std::string>& lines) {
  for (const int j : joints_of(a)) {
    const Node& node = a.nodes[at(j)];
    const int other = find_node(b, node.name);
    if (other < 0)
      lines.push_back("joint " + node.name +
                      (both ? " is missing in the second" : " is missing in the first"));
    else if (both && parent_name(a, node) != parent_name(b, b.nodes[at(other)]))
      lines.push_back("joint " + node.name + " hangs below " + parent_name(a, node) + " and below " +
                      parent_name(b, b.nodes[at(other)]));
  }
}

std::string how_objects_differ(const InfluenceObject& a, const InfluenceObject& b) {
  if (a.form.index() != b.form.index()) return "is not of the same kind";
  return counts("control points", a.controls.rows(), b.controls.rows());
}

std::string how_wires_differ(const Wire& a, const Wire& b) {
  const std::string controls = counts("control points", a.curve.control_count(), b.curve.control_count());
  return controls.empty() ? counts("turns", a.turn_controls, b.turn_controls) : controls;
}

}  // namespace

std::vector<std::string> rig_differences(const Character& a, const Character& b) {
  std::vector<std::string> lines;
  const auto alike = [](const auto&, const auto&) { return std::string(); };
  for (const bool both : {true, false}) {
    const Character &x = both ? a : b, &y = both ? b : a;
    compare_joints(x, y, both, lines);
    compare(x.shapes, y.shapes, "shape", both, alike, lines);
    compare(x.sliders, y.sliders, "slider", both, alike, lines);
    compare(x.wires, y.wires, "wire", both, how_wires_differ, lines);
    compare(x.objects, y.objects, "object", both, how_objects_differ, lines);
    compare(
        x.controls, y.controls, "control", both,
        [](const Control& c, const Control& d) {
          return std::string(c.kind == d.kind ? "" : "is not of the same kind");
        },
        lines);
  }
  return lines;
}

}  // namespace mien
