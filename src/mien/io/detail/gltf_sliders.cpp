#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"

// Sliders in the MIEN_character extension, by names: the numbers of shapes are mien's own, and another program
// may have put them in another order.

namespace mien::detail {
namespace {

constexpr std::array<const char*, 3> rule_names{"product", "smallest",
                                                "smooth"};  // in CorrectiveRule's order

bool are_plain(const Character& character) {
  if (!character.correctives.empty() || !character.expressions.empty()) return false;
  Character plain;
  plain.shapes = character.shapes;
  complete_sliders(plain);
  if (plain.sliders.size() != character.sliders.size()) return false;
  for (std::size_t s = 0; s < plain.sliders.size(); ++s) {
    if (!character.shapes[s].parts.empty())
      plain.sliders[s].rest = character.sliders[s].rest;  // the meshes' weights say it
    if (plain.sliders[s] != character.sliders[s]) return false;
  }
  return true;
}

Json slider_json(const Character& character, const Slider& slider) {
  const Slider usual;
  Json json = {{"name", slider.name}, {"stops", Json::array()}};
  if (slider.minimum != usual.minimum) json["minimum"] = slider.minimum;
  if (slider.maximum != usual.maximum) json["maximum"] = slider.maximum;
  if (slider.rest != usual.rest) json["rest"] = slider.rest;
  for (const SliderStop& stop : slider.stops)
    json["stops"].push_back({{"at", stop.at}, {"shape", character.shapes[stop.shape].name}});
  return json;
}

int shape_of(const JsonObject& source, const Character& character) {
  const int shape = find_shape(character, source.text("shape"));
  if (shape < 0)
    throw io_error(source.place_of("shape"), fmt::format("names {}", source.text("shape").substr(0, 100)),
                   "name a shape of a mesh in use");
  return shape;
}

int slider_of(const std::string& name, const std::string& place, const Character& character) {
  const int slider = find_slider(character, name);
  if (slider < 0)
    throw io_error(place, fmt::format("names {}", name.substr(0, 100)), "name one of the sliders");
  return slider;
}

Slider read_slider(const JsonObject& source, const Character& character) {
  Slider slider;
  slider.name = source.text("name");
  slider.minimum = source.number_or("minimum", slider.minimum);
  slider.maximum = source.number_or("maximum", slider.maximum);
  slider.rest = source.number_or("rest", slider.rest);
  for (const JsonObject& stop : source.objects("stops"))
    slider.stops.push_back({stop.number("at"), shape_of(stop, character)});
  return slider;
}

Corrective read_corrective(const JsonObject& source, const Character& character) {
  Corrective corrective;
  corrective.shape = shape_of(source, character);
  const std::string rule = source.text("rule");
  const auto known = std::find(rule_names.begin(), rule_names.end(), rule);
  if (known == rule_names.end())
    throw io_error(source.place_of("rule"), fmt::format("is \"{}\"", rule.substr(0, 40)),
                   "give product, smallest or smooth");
  corrective.rule = static_cast<CorrectiveRule>(known - rule_names.begin());
  for (const JsonObject& input : source.objects("inputs"))
    corrective.inputs.push_back(
        {slider_of(input.text("slider"), input.place_of("slider"), character), input.number_or("at", 1)});
  return corrective;
}

Expression read_expression(const JsonObject& source, const Character& character) {
  Expression expression;
  expression.name = source.text("name");
  const JsonObject values = source.object("values");
  for (const auto& [name, value] : values.json().items())
    expression.values.push_back(
        {slider_of(name, values.place_of(name), character), values.number(name.c_str())});
  std::sort(expression.values.begin(), expression.values.end(),
            [](const ExpressionValue& a, const ExpressionValue& b) { return a.slider < b.slider; });
  return expression;
}

/// A slider whose value is, up to a factor, the weight of one shape that nothing else drives.
bool drives_one_shape(const Character& character, int slider) {
  const std::vector<SliderStop>& stops = character.sliders[slider].stops;
  if (stops.size() != 1) return false;
  const auto fires = [&](const Corrective& corrective) {
    return corrective.shape == stops[0].shape ||
           std::any_of(corrective.inputs.begin(), corrective.inputs.end(),
                       [&](const CorrectiveInput& input) { return input.slider == slider; });
  };
  const auto shares = [&](const Slider& other) {
    return &other != &character.sliders[slider] &&
           std::any_of(other.stops.begin(), other.stops.end(),
                       [&](const SliderStop& stop) { return stop.shape == stops[0].shape; });
  };
  return std::none_of(character.correctives.begin(), character.correctives.end(), fires) &&
         std::none_of(character.sliders.begin(), character.sliders.end(), shares);
}

Channel shape_channel(int shape) {
  Channel channel;
  channel.property = Channel::Property::shape_weight;
  channel.shape = shape;
  return channel;
}

/// The keys of all channels, and enough between them that a straight line is close to any rule.
std::vector<float> dense_times(const std::vector<const Channel*>& channels) {
  std::vector<float> times;
  for (const Channel* channel : channels)
    times.insert(times.end(), channel->times.begin(), channel->times.end());
  std::sort(times.begin(), times.end());
  const float first = times.front(), last = times.back();
  for (int frame = 1; first + frame / 30.f < last && frame < 1 << 20; ++frame)
    times.push_back(first + frame / 30.f);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// Per shape: whether one of these slider channels moves it, directly or through a corrective.
std::vector<bool> driven_shapes(const Character& character, const std::vector<const Channel*>& channels) {
  std::vector<bool> moves(character.sliders.size(), false), driven(character.shapes.size(), false);
  for (const Channel* channel : channels) {
    moves[channel->slider] = true;
    for (const SliderStop& stop : character.sliders[channel->slider].stops) driven[stop.shape] = true;
  }
  for (const Corrective& corrective : character.correctives)
    for (const CorrectiveInput& input : corrective.inputs)
      if (moves[input.slider]) driven[corrective.shape] = true;
  return driven;
}

/// Channels of every shape that these slider channels move.
std::vector<Channel> sampled_channels(const Character& character,
                                      const std::vector<const Channel*>& channels) {
  std::vector<Channel> result;
  if (channels.empty()) return result;
  const std::vector<float> times = dense_times(channels);
  Eigen::MatrixXd weights(static_cast<Eigen::Index>(character.shapes.size()),
                          static_cast<Eigen::Index>(times.size()));
  SliderValues sliders = rest_sliders(character);
  for (std::size_t t = 0; t < times.size(); ++t) {
    for (const Channel* channel : channels) sliders.values[channel->slider] = value_at(*channel, times[t]);
    weights.col(static_cast<Eigen::Index>(t)) = shape_weights(character, sliders).values;
  }
  const std::vector<bool> driven = driven_shapes(character, channels);
  for (Eigen::Index s = 0; s < weights.rows(); ++s) {
    if (!driven[static_cast<std::size_t>(s)]) continue;
    Channel channel = shape_channel(static_cast<int>(s));
    channel.times = times;
    for (Eigen::Index t = 0; t < weights.cols(); ++t)
      channel.values.push_back(static_cast<float>(weights(s, t)));
    result.push_back(std::move(channel));
  }
  return result;
}

}  // namespace

Clip with_shape_channels(const Character& character, const Clip& clip) {
  Clip plain{clip.name, {}, clip.carried};
  std::vector<const Channel*> others;
  for (const Channel& channel : clip.channels) {
    if (channel.moves_wire() || channel.property == Channel::Property::object_control) continue;
    if (channel.property != Channel::Property::slider) {
      plain.channels.push_back(channel);
    } else if (drives_one_shape(character, channel.slider)) {
      const SliderStop stop = character.sliders[channel.slider].stops[0];
      Channel weight = shape_channel(stop.shape);
      weight.interpolation = channel.interpolation;
      weight.times = channel.times;
      for (const float value : channel.values) weight.values.push_back(static_cast<float>(value / stop.at));
      plain.channels.push_back(std::move(weight));
    } else if (!channel.times.empty()) {
      others.push_back(&channel);
    }
  }
  for (Channel& channel : sampled_channels(character, others)) plain.channels.push_back(std::move(channel));
  return plain;
}

void write_sliders(const Character& character, Json& vendor) {
  if (are_plain(character)) return;
  vendor["sliders"] = Json::array();
  for (const Slider& slider : character.sliders) vendor["sliders"].push_back(slider_json(character, slider));
  for (const Corrective& corrective : character.correctives) {
    Json json = {{"shape", character.shapes[corrective.shape].name},
                 {"rule", rule_names[static_cast<std::size_t>(corrective.rule)]},
                 {"inputs", Json::array()}};
    for (const CorrectiveInput& input : corrective.inputs) {
      Json entry = {{"slider", character.sliders[input.slider].name}};
      if (input.at != 1) entry["at"] = input.at;
      json["inputs"].push_back(std::move(entry));
    }
    vendor["correctives"].push_back(std::move(json));
  }
  for (const Expression& expression : character.expressions) {
    Json json = {{"name", expression.name}, {"values", Json::object()}};
    for (const ExpressionValue& entry : expression.values)
      json["values"][character.sliders[entry.slider].name] = entry.value;
    vendor["expressions"].push_back(std::move(json));
  }
}

void read_sliders(const JsonObject& vendor, Character& character) {
  if (!vendor.has("sliders")) return;
  character.sliders.clear();
  for (const JsonObject& source : vendor.objects("sliders"))
    character.sliders.push_back(read_slider(source, character));
  for (const JsonObject& source : vendor.objects("correctives"))
    character.correctives.push_back(read_corrective(source, character));
  for (const JsonObject& source : vendor.objects("expressions"))
    character.expressions.push_back(read_expression(source, character));
  complete_sliders(character);
}

}  // namespace mien::detail
