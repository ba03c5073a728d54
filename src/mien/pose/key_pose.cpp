#include "mien/pose/key_pose.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

constexpr double changed_by = 1e-6;

/// The channel that animates a slider: its own, or that of the one shape it shows at 1.
Channel* channel_of(const Character& character, Clip& clip, int slider) {
  for (Channel& channel : clip.channels)
    if (channel.property == Channel::Property::slider && channel.slider == slider) return &channel;
  const std::vector<SliderStop>& stops = character.sliders[slider].stops;
  if (stops.size() != 1 || stops[0].at != 1) return nullptr;
  for (Channel& channel : clip.channels)
    if (channel.property == Channel::Property::shape_weight && channel.part < 0 &&
        channel.shape == stops[0].shape)
      return &channel;
  return nullptr;
}

Channel& channel_for(const Character& character, Clip& clip, int slider) {
  if (Channel* channel = channel_of(character, clip, slider)) return *channel;
  Channel channel;
  channel.property = Channel::Property::slider;
  channel.slider = slider;
  return clip.channels.emplace_back(channel);
}

void set_key(Channel& channel, double seconds, double value) {
  const int width = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const auto time = static_cast<float>(seconds);
  const auto at = std::lower_bound(channel.times.begin(), channel.times.end(), time);
  const auto key = at - channel.times.begin();
  if (at == channel.times.end() || *at != time) {
    channel.times.insert(at, time);
    channel.values.insert(channel.values.begin() + key * width, static_cast<std::size_t>(width), 0.f);
  }
  channel.values[static_cast<std::size_t>(key * width + width / 2)] = static_cast<float>(value);
}

void check_size(const Character& character, const SliderValues& sliders) {
  if (sliders.values.size() != static_cast<Eigen::Index>(character.sliders.size()))
    throw invalid_input("slider values", "are " + std::to_string(sliders.values.size()),
                        "the character has " + std::to_string(character.sliders.size()) + " sliders");
}

/// A linear channel that says what the old one says: its own keys, or samples where it is no linear one.
Channel as_linear(const Character& character, const Clip& clip, const Channel& old, int slider, double fps) {
  if (old.interpolation == Interpolation::linear && !old.times.empty()) return old;
  Channel linear = old;
  linear.interpolation = Interpolation::linear;
  linear.times.clear();
  linear.values.clear();
  const int frames = static_cast<int>(std::ceil(clip.duration() * fps));
  for (int f = 0; f <= frames; ++f)
    set_key(linear, f / fps, sample_rig(character, clip, f / fps).sliders.values[slider]);
  return linear;
}

void drop_keys(Channel& channel, double begin, double end) {
  for (std::size_t k = channel.times.size(); k-- > 0;)
    if (channel.times[k] >= begin - 1e-6 && channel.times[k] <= end + 1e-6) {
      channel.times.erase(channel.times.begin() + static_cast<std::ptrdiff_t>(k));
      channel.values.erase(channel.values.begin() + static_cast<std::ptrdiff_t>(k));
    }
}

}  // namespace

Clip key_changes(const Character& character, const Clip& clip, const SliderValues& before,
                 const SliderValues& after, double seconds) {
  check_size(character, before);
  check_size(character, after);
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw invalid_input("time", "is negative or not finite", "seconds, 0 or more");
  Clip keyed = clip;
  for (int s = 0; s < static_cast<int>(character.sliders.size()); ++s)
    if (std::abs(after.values[s] - before.values[s]) > changed_by)
      set_key(channel_for(character, keyed, s), seconds, after.values[s]);
  return keyed;
}

Clip hold_pins(const Character& character, const Clip& clip, const std::vector<Pin>& pins,
               const HoldOptions& options) {
  if (!(options.fps > 0) || !std::isfinite(options.fps))
    throw invalid_input("frames a second", "are not above 0", "30, say");
  if (!(options.begin >= 0 && options.begin <= options.end) || !std::isfinite(options.end))
    throw invalid_input("range", "is out of order", "0 <= begin <= end, in seconds");
  const int frames = static_cast<int>(std::floor((options.end - options.begin) * options.fps + 1e-6)) + 1;
  std::vector<double> times;
  std::vector<Eigen::VectorXd> solved;
  std::vector<bool> changes(character.sliders.size(), false);
  for (int f = 0; f < frames; ++f) {
    times.push_back(options.begin + f / options.fps);
    const RigPose start = sample_rig(character, clip, times.back());
    const SolvePinsResult result = solve_pins(character, pins, start, options.solve);
    for (const int s : result.moved) changes[static_cast<std::size_t>(s)] = true;
    solved.push_back(result.pose.sliders.values);
  }
  Clip held = clip;
  for (int s = 0; s < static_cast<int>(changes.size()); ++s) {
    if (!changes[static_cast<std::size_t>(s)]) continue;
    Channel& channel = channel_for(character, held, s);
    channel = as_linear(character, clip, channel, s, options.fps);
    const double before = times.front() - 1 / options.fps, after = times.back() + 1 / options.fps;
    const double before_value = before >= 0 ? sample_rig(character, clip, before).sliders.values[s] : 0;
    const double after_value = sample_rig(character, clip, after).sliders.values[s];
    drop_keys(channel, std::max(before, 0.0), after);
    if (before >= 0) set_key(channel, before, before_value);
    for (std::size_t f = 0; f < times.size(); ++f) set_key(channel, times[f], solved[f][s]);
    set_key(channel, after, after_value);
  }
  return held;
}

}  // namespace mien
