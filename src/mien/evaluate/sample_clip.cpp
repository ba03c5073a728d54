// glTF 2.0, section 3.11 and appendix C: how a channel is read between its keys.
#include <algorithm>
#include <cmath>
#include <string>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

using Value = Eigen::Vector4d;  // the first `width` entries are used

std::string place_of(const Clip& clip, std::size_t channel) {
  return "clip " + clip.name + ", channel " + std::to_string(channel);
}

struct Target {
  const char* kind;
  int index;
  std::size_t count;
};

Target target_of(const Character& character, const Channel& channel) {
  switch (channel.property) {
    case Channel::Property::shape_weight:
      return {"shape ", channel.shape, character.shapes.size()};
    case Channel::Property::slider:
      return {"slider ", channel.slider, character.sliders.size()};
    case Channel::Property::wire_control:
    case Channel::Property::wire_scale:
    case Channel::Property::wire_turn:
      return {"wire ", channel.wire, character.wires.size()};
    case Channel::Property::object_control:
      return {"object ", channel.object, character.objects.size()};
    default:
      return {"node ", channel.node, character.nodes.size()};
  }
}

void check_control(const Channel& channel, const std::string& owner, Eigen::Index rows,
                   const std::string& place) {
  if (channel.control < 0 || channel.control >= rows)
    throw invalid_input(place, "animates control point " + std::to_string(channel.control) + " of " + owner,
                        "one from 0 to " + std::to_string(rows - 1));
}

void check_channel(const Character& character, const Clip& clip, std::size_t index) {
  const Channel& channel = clip.channels[index];
  const std::size_t stride = channel.width() * (channel.interpolation == Interpolation::cubic_spline ? 3 : 1);
  if (channel.times.empty()) throw invalid_input(place_of(clip, index), "has no keys", "at least one");
  if (channel.values.size() != channel.times.size() * stride)
    throw invalid_input(
        place_of(clip, index), "has " + std::to_string(channel.values.size()) + " values",
        std::to_string(channel.times.size() * stride) + ", " + std::to_string(stride) + " a key");
  const auto [kind, target, count] = target_of(character, channel);
  if (target < 0 || static_cast<std::size_t>(target) >= count)
    throw invalid_input(place_of(clip, index), std::string("animates ") + kind + std::to_string(target),
                        "one from 0 to " + std::to_string(static_cast<int>(count) - 1));
  if (channel.property == Channel::Property::object_control) {
    const InfluenceObject& object = character.objects[channel.object];
    check_control(channel, "object " + object.name, object.controls.rows(), place_of(clip, index));
  }
  if (channel.property != Channel::Property::wire_control && channel.property != Channel::Property::wire_turn)
    return;
  const Wire& wire = character.wires[channel.wire];
  check_control(
      channel, "wire " + wire.name,
      channel.property == Channel::Property::wire_control ? wire.curve.control_count() : wire.turn_controls,
      place_of(clip, index));
}

/// Adds what a channel does to an object to the pose.
void move_object(const Character& character, const Channel& channel, const Value& value, RigPose& pose) {
  auto move = std::find_if(pose.objects.begin(), pose.objects.end(),
                           [&](const ObjectMove& m) { return m.object == channel.object; });
  if (move == pose.objects.end())
    move = pose.objects.insert(
        move, {channel.object, PointsD::Zero(character.objects[channel.object].controls.rows(), 3)});
  move->controls.row(channel.control) = value.head<3>().transpose();
}

/// Adds what a channel does to a wire to the pose.
void move_wire(const Character& character, const Channel& channel, const Value& value, RigPose& pose) {
  const Wire& wire = character.wires[channel.wire];
  auto move = std::find_if(pose.wires.begin(), pose.wires.end(),
                           [&](const WireMove& m) { return m.wire == channel.wire; });
  if (move == pose.wires.end())
    move = pose.wires.insert(move, {channel.wire, PointsD::Zero(wire.curve.control_count(), 3), 0,
                                    PointsD::Zero(wire.turn_controls, 3)});
  if (channel.property == Channel::Property::wire_scale)
    move->scale = value[0];
  else if (channel.property == Channel::Property::wire_control)
    move->controls.row(channel.control) = value.head<3>().transpose();
  else
    move->turns.row(channel.control) = value.head<3>().transpose();
}

/// The row-th group of `width` values: a key's value, or its tangents for a cubic spline.
Value value_at(const Channel& channel, std::size_t row) {
  Value value = Value::Zero();
  for (int k = 0; k < channel.width(); ++k) value[k] = channel.values[row * channel.width() + k];
  return value;
}

Value slerp(const Value& from, const Value& to, double u) {
  const Eigen::Quaterniond a(from[3], from[0], from[1], from[2]), b(to[3], to[0], to[1], to[2]);
  return a.normalized().slerp(u, b.normalized()).coeffs();
}

Value hermite(const Channel& channel, std::size_t key, double u, double seconds) {
  const Value v0 = value_at(channel, 3 * key + 1), out0 = value_at(channel, 3 * key + 2);
  const Value in1 = value_at(channel, 3 * key + 3), v1 = value_at(channel, 3 * key + 4);
  const double u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * v0 + (u3 - 2 * u2 + u) * seconds * out0 + (-2 * u3 + 3 * u2) * v1 +
         (u3 - u2) * seconds * in1;
}

Value sample_channel(const Channel& channel, double seconds) {
  const auto& times = channel.times;
  const bool cubic = channel.interpolation == Interpolation::cubic_spline;
  const auto key_value = [&](std::size_t key) { return value_at(channel, cubic ? 3 * key + 1 : key); };
  if (!(seconds > times.front())) return key_value(0);
  if (seconds >= times.back()) return key_value(times.size() - 1);
  const auto next = std::upper_bound(times.begin(), times.end(), seconds,
                                     [](double t, float key) { return t < static_cast<double>(key); });
  const auto key = static_cast<std::size_t>(next - times.begin()) - 1;
  if (channel.interpolation == Interpolation::step) return key_value(key);
  const double span = static_cast<double>(times[key + 1]) - times[key];
  const double u = (seconds - times[key]) / span;
  if (cubic) return hermite(channel, key, u, span);
  const Value from = key_value(key), to = key_value(key + 1);
  if (channel.property == Channel::Property::rotation) return slerp(from, to, u);
  return from + u * (to - from);
}

void apply(const Channel& channel, const Value& value, std::vector<Transform>& locals) {
  if (channel.property == Channel::Property::translation)
    locals[channel.node].translation = value.head<3>();
  else if (channel.property == Channel::Property::rotation)
    locals[channel.node].rotation = Eigen::Quaterniond(value[3], value[0], value[1], value[2]).normalized();
  else if (channel.property == Channel::Property::scale)
    locals[channel.node].scale = value.head<3>();
}

/// Every channel's value at `seconds`, in order, checked.
std::vector<Value> sample_channels(const Character& character, const Clip& clip, double seconds) {
  if (!std::isfinite(seconds))
    throw invalid_input("clip " + clip.name, "is asked at a time that is not finite");
  std::vector<Value> values;
  for (std::size_t c = 0; c < clip.channels.size(); ++c) {
    check_channel(character, clip, c);
    values.push_back(sample_channel(clip.channels[c], seconds));
  }
  return values;
}

/// Sliders, nodes, wires and objects; shape weights aside.
RigPose rig_of(const Character& character, const Clip& clip, const std::vector<Value>& values) {
  RigPose rig = rest_rig_pose(character);
  for (std::size_t c = 0; c < values.size(); ++c) {
    const Channel& channel = clip.channels[c];
    if (channel.property == Channel::Property::slider)
      rig.sliders.values[channel.slider] = values[c][0];
    else if (channel.property == Channel::Property::object_control)
      move_object(character, channel, values[c], rig);
    else if (channel.moves_wire())
      move_wire(character, channel, values[c], rig);
    else
      apply(channel, values[c], rig.locals);
  }
  return rig;
}

}  // namespace

Pose sample_clip(const Character& character, const Clip& clip, double seconds) {
  const std::vector<Value> values = sample_channels(character, clip, seconds);
  Pose pose = pose_of(character, rig_of(character, clip, values));
  for (std::size_t c = 0; c < values.size(); ++c) {
    const Channel& channel = clip.channels[c];
    if (channel.property != Channel::Property::shape_weight) continue;
    if (channel.part < 0)
      pose.shape_weights.values[channel.shape] = values[c][0];
    else
      pose.part_shape_weights.push_back({channel.part, channel.shape, values[c][0]});
  }
  return pose;
}

RigPose sample_rig(const Character& character, const Clip& clip, double seconds) {
  const std::vector<Value> values = sample_channels(character, clip, seconds);
  RigPose rig = rig_of(character, clip, values);
  for (std::size_t c = 0; c < values.size(); ++c) {
    const Channel& channel = clip.channels[c];
    if (channel.property != Channel::Property::shape_weight || channel.part >= 0) continue;
    for (std::size_t s = 0; s < character.sliders.size(); ++s)
      if (const auto& stops = character.sliders[s].stops;
          stops.size() == 1 && stops[0].shape == channel.shape)
        rig.sliders.values[static_cast<Eigen::Index>(s)] = values[c][0] * stops[0].at;
  }
  return rig;
}

}  // namespace mien
