#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_write.h"

namespace mien::detail {

const char* name_of(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::step:
      return "STEP";
    case Interpolation::linear:
      return "LINEAR";
    default:
      return "CUBICSPLINE";
  }
}

namespace {

const char* path_of(Channel::Property property) {
  switch (property) {
    case Channel::Property::translation:
      return "translation";
    case Channel::Property::rotation:
      return "rotation";
    case Channel::Property::scale:
      return "scale";
    default:
      return "weights";
  }
}

/// Value and slope of a one-valued channel at a time.
struct Sample {
  double value, slope;
};

Sample sample_segment(const Channel& channel, std::size_t k, double time) {
  const double start = channel.times[k], length = channel.times[k + 1] - start, u = (time - start) / length;
  if (channel.interpolation == Interpolation::step) return {channel.values[k], 0};
  if (channel.interpolation == Interpolation::linear) {
    const double slope = (channel.values[k + 1] - channel.values[k]) / length;
    return {channel.values[k] + slope * (time - start), slope};
  }
  const double p0 = channel.values[3 * k + 1], m0 = channel.values[3 * k + 2] * length;
  const double p1 = channel.values[3 * k + 4], m1 = channel.values[3 * k + 3] * length;
  const double a = 2 * p0 + m0 - 2 * p1 + m1, b = -3 * p0 - 2 * m0 + 3 * p1 - m1;
  return {((a * u + b) * u + m0) * u + p0, ((3 * a * u + 2 * b) * u + m0) / length};
}

/// The segment that ends at or contains `time` seen from the left, or starts at or contains it seen from the
/// right.
Sample sample_beside(const Channel& channel, double time, bool from_left) {
  const std::size_t stride = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const auto key_value = [&](std::size_t k) {
    return double(channel.values[stride * k + (stride == 3 ? 1 : 0)]);
  };
  const std::vector<float>& times = channel.times;
  if (time < times.front() || (from_left && time == times.front())) return {key_value(0), 0};
  if (time > times.back() || (!from_left && time == times.back())) return {key_value(times.size() - 1), 0};
  const auto after = from_left ? std::lower_bound(times.begin(), times.end(), time)
                               : std::upper_bound(times.begin(), times.end(), time);
  const auto k = static_cast<std::size_t>(after - times.begin()) - 1;
  if (from_left && time == *after && channel.interpolation == Interpolation::step) return {key_value(k), 0};
  return sample_segment(channel, k, time);
}

}  // namespace

double value_at(const Channel& channel, double seconds) {
  return sample_beside(channel, seconds, false).value;
}

namespace {

/// The weights channels of one part, which glTF stores as one sampler.
struct WeightTrack {
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;
  std::vector<float> values;
};

/// A channel a shape, null where the clip leaves the shape at rest.
using TrackSources = std::vector<const Channel*>;

bool share_keys(const TrackSources& sources, const Channel& first) {
  return std::all_of(sources.begin(), sources.end(), [&](const Channel* c) {
    return !c || (c->times == first.times && c->interpolation == first.interpolation);
  });
}

WeightTrack interleaved(const TrackSources& sources, const std::vector<double>& rest, const Channel& first) {
  WeightTrack track{first.interpolation, first.times, {}};
  const std::size_t stride = first.interpolation == Interpolation::cubic_spline ? 3 : 1;
  for (std::size_t row = 0; row < first.times.size() * stride; ++row)
    for (std::size_t s = 0; s < sources.size(); ++s)
      track.values.push_back(sources[s]                    ? sources[s]->values[row]
                             : stride == 3 && row % 3 != 1 ? 0.f
                                                           : static_cast<float>(rest[s]));
  return track;
}

/// Channels with keys at different times, or of different kinds, on the union of their keys. A cubic spline
/// holds linear pieces exactly; a step becomes a jump between two keys that are one float apart.
WeightTrack united(const TrackSources& sources, const std::vector<double>& rest) {
  WeightTrack track;
  bool all_step = true, any_step = false, any_cubic = false;
  for (const Channel* c : sources) {
    if (!c) continue;
    track.times.insert(track.times.end(), c->times.begin(), c->times.end());
    all_step = all_step && c->interpolation == Interpolation::step;
    any_step = any_step || c->interpolation == Interpolation::step;
    any_cubic = any_cubic || c->interpolation == Interpolation::cubic_spline;
  }
  if (any_step && !all_step)
    for (const Channel* c : sources)
      if (c && c->interpolation == Interpolation::step)
        for (std::size_t k = 1; k < c->times.size(); ++k)
          track.times.push_back(std::nextafter(c->times[k], -std::numeric_limits<float>::infinity()));
  std::sort(track.times.begin(), track.times.end());
  track.times.erase(std::unique(track.times.begin(), track.times.end()), track.times.end());
  track.interpolation = all_step    ? Interpolation::step
                        : any_cubic ? Interpolation::cubic_spline
                                    : Interpolation::linear;
  for (const float time : track.times) {
    std::array<std::vector<float>, 3> rows;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const Sample left = sources[s] ? sample_beside(*sources[s], time, true) : Sample{rest[s], 0};
      const Sample right = sources[s] ? sample_beside(*sources[s], time, false) : Sample{rest[s], 0};
      rows[0].push_back(static_cast<float>(left.slope));
      rows[1].push_back(static_cast<float>(right.value));
      rows[2].push_back(static_cast<float>(right.slope));
    }
    const bool cubic = track.interpolation == Interpolation::cubic_spline;
    for (int r = cubic ? 0 : 1; r < (cubic ? 3 : 2); ++r)
      track.values.insert(track.values.end(), rows[r].begin(), rows[r].end());
  }
  return track;
}

class ClipWriter {
 public:
  ClipWriter(const Character& character, const std::vector<int>& node_of_part, GltfBuilder& builder)
      : character_(character),
        node_of_part_(node_of_part),
        builder_(builder),
        rest_(shape_weights(character, rest_sliders(character))),
        written_parts_(character.parts.size(), false) {}
  Json write(const Clip& clip);

 private:
  bool drives(const Channel& channel, int part) const;
  void write_weights(const Clip& clip, int part);
  /// The sliders' channels and, where glTF's form animates more, the shapes that the clip itself animates; their channels, where glTF's
  /// form gave them other keys.
  Json vendor(const Clip& clip) const;
  void hold_still(const Clip& clip);
  void add(int node, const char* path, const Channel& keys);

  const Character& character_;
  const std::vector<int>& node_of_part_;
  GltfBuilder& builder_;
  ShapeWeights rest_;
  std::vector<bool> written_parts_;
  bool has_other_keys_ = false;  // a shape's weight than its channel in the clip
  Json samplers_ = Json::array(), channels_ = Json::array();
  std::map<std::tuple<int, int, std::string>, std::size_t> sampler_numbers_;
};

void ClipWriter::add(int node, const char* path, const Channel& keys) {
  const int width = keys.property == Channel::Property::shape_weight ? 1 : keys.width();
  const int input = builder_.add_floats(keys.times, 1, true);
  const int output = builder_.add_floats(keys.values, width);
  const std::string interpolation = name_of(keys.interpolation);
  const auto [known, is_new] =
      sampler_numbers_.emplace(std::tuple(input, output, interpolation), samplers_.size());
  if (is_new) samplers_.push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
  channels_.push_back({{"sampler", known->second}, {"target", {{"node", node}, {"path", path}}}});
}

bool ClipWriter::drives(const Channel& channel, int part) const {
  if (channel.property != Channel::Property::shape_weight || (channel.part >= 0 && channel.part != part) ||
      !character_.parts[part].shown)
    return false;
  const std::vector<PartDelta>& parts = character_.shapes[channel.shape].parts;
  return std::any_of(parts.begin(), parts.end(), [&](const PartDelta& delta) { return delta.part == part; });
}

void ClipWriter::write_weights(const Clip& clip, int part) {
  TrackSources sources;
  std::vector<double> rest;
  const Channel* first = nullptr;
  for (std::size_t s = 0; s < character_.shapes.size(); ++s) {
    const std::vector<PartDelta>& parts = character_.shapes[s].parts;
    if (std::none_of(parts.begin(), parts.end(), [&](const PartDelta& delta) { return delta.part == part; }))
      continue;
    const Channel* source = nullptr;
    for (const Channel& channel : clip.channels)
      if (channel.shape == static_cast<int>(s) && drives(channel, part) && !channel.times.empty())
        source = &channel;
    if (source && !first) first = source;
    sources.push_back(source);
    rest.push_back(rest_.values[static_cast<Eigen::Index>(s)]);
  }
  if (!first) return;
  const bool is_exact = share_keys(sources, *first);
  has_other_keys_ = has_other_keys_ || !is_exact;
  WeightTrack track = is_exact ? interleaved(sources, rest, *first) : united(sources, rest);
  Channel keys;
  keys.property = Channel::Property::shape_weight;
  keys.interpolation = track.interpolation;
  keys.times = std::move(track.times);
  keys.values = std::move(track.values);
  add(node_of_part_[part], "weights", keys);
}

Json ClipWriter::vendor(const Clip& clip) const {
  Json vendor = Json::object();
  for (const Channel& channel : clip.channels)
    if (channel.property == Channel::Property::slider && !channel.times.empty())
      vendor["sliders"].push_back({{"slider", character_.sliders[channel.slider].name},
                                   {"interpolation", name_of(channel.interpolation)},
                                   {"input", builder_.add_floats(channel.times, 1, true)},
                                   {"output", builder_.add_floats(channel.values, 1)}});
  for (const Channel& channel : clip.channels)
    if (channel.moves_wire() && !channel.times.empty())
      vendor["wires"].push_back(wire_channel_json(character_, channel, builder_));
  for (const Channel& channel : clip.channels)
    if (channel.property == Channel::Property::object_control && !channel.times.empty())
      vendor["objects"].push_back(object_channel_json(character_, channel, builder_));
  for (const Channel& channel : clip.channels)
    if (has_other_keys_ && channel.property == Channel::Property::shape_weight && !channel.times.empty()) {
      Json weight = {{"shape", character_.shapes[channel.shape].name},
                     {"interpolation", name_of(channel.interpolation)},
                     {"input", builder_.add_floats(channel.times, 1, true)},
                     {"output", builder_.add_floats(channel.values, 1)}};
      if (channel.part >= 0) weight["mesh"] = channel.part;
      vendor["weights"].push_back(std::move(weight));
    }
  if (vendor.contains("weights")) return vendor;
  std::vector<bool> own(character_.shapes.size(), false);
  for (const Channel& channel : clip.channels)
    if (channel.property == Channel::Property::shape_weight) own[channel.shape] = true;
  bool shows_others = false;
  for (std::size_t s = 0; s < own.size(); ++s)
    for (const PartDelta& delta : character_.shapes[s].parts)
      shows_others = shows_others || (!own[s] && written_parts_[delta.part]);
  if (!shows_others) return vendor;
  vendor["shapes"] = Json::array();
  for (std::size_t s = 0; s < own.size(); ++s)
    if (own[s]) vendor["shapes"].push_back(character_.shapes[s].name);
  return vendor;
}

/// glTF forbids an animation without channels: one that leaves the first part where it is says how long this one lasts.
void ClipWriter::hold_still(const Clip& clip) {
  const Part& part = character_.parts.at(0);
  const Eigen::Vector3d at = part.node >= 0 ? character_.nodes[part.node].rest.translation
                                            : Eigen::Vector3d(Eigen::Vector3d::Zero());
  Channel still;
  for (const Channel& channel : clip.channels)
    if (still.times.empty()) still.times = channel.times;
  for (std::size_t key = 0; key < still.times.size(); ++key)
    for (int k = 0; k < 3; ++k) still.values.push_back(static_cast<float>(at[k]));
  add(node_of_part_.at(0), "translation", still);
}

Json ClipWriter::write(const Clip& whole) {
  const Clip clip = with_shape_channels(character_, whole);
  for (const Channel& channel : clip.channels) {
    if (channel.times.empty()) continue;
    if (channel.property != Channel::Property::shape_weight) {
      add(channel.node, path_of(channel.property), channel);
      continue;
    }
    for (int part = 0; part < static_cast<int>(character_.parts.size()); ++part)
      if (!written_parts_[part] && drives(channel, part)) {
        write_weights(clip, part);
        written_parts_[part] = true;
      }
  }
  Json animation = carried_json(clip.carried, fmt::format("clip {}: carried", clip.name));
  if (!clip.name.empty()) animation["name"] = clip.name;
  animation["samplers"] = std::move(samplers_);
  animation["channels"] = std::move(channels_);
  Json members = vendor(whole);
  const bool moves_alone = members.contains("wires") || members.contains("objects");
  if (animation["channels"].empty() && moves_alone && !character_.parts.empty() &&
      character_.parts[0].shown) {
    hold_still(whole);
    animation["samplers"] = std::move(samplers_);
    animation["channels"] = std::move(channels_);
    members["still"] = true;
  }
  if (!members.empty()) animation["extensions"][vendor_extension] = std::move(members);
  return animation;
}

}  // namespace

Json write_animations(const Character& character, const std::vector<int>& node_of_part,
                      GltfBuilder& builder) {
  Json animations = Json::array();
  for (const Clip& clip : character.clips) {
    Json animation = ClipWriter(character, node_of_part, builder).write(clip);
    if (!animation["channels"].empty())
      animations.push_back(std::move(animation));  // glTF forbids empty ones
  }
  return animations;
}

}  // namespace mien::detail
