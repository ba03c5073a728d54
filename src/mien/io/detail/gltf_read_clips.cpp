#include <fmt/format.h>

#include <algorithm>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"

namespace mien::detail {
namespace {

Interpolation interpolation_of(const JsonObject& sampler) {
  const std::string name = sampler.text_or("interpolation", "LINEAR");
  if (name == "STEP") return Interpolation::step;
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  throw io_error(sampler.place_of("interpolation"), fmt::format("is \"{}\"", name.substr(0, 40)),
                 "give STEP, LINEAR or CUBICSPLINE");
}

class ClipReader {
 public:
  ClipReader(GltfDocument& document, const std::vector<PartSource>& sources, Character& character)
      : document_(document), sources_(sources), character_(character) {}
  Clip read(const JsonObject& animation);

 private:
  void read_channel(const JsonObject& channel, const std::vector<JsonObject>& samplers, Clip& clip);
  void read_transform(Channel channel, const JsonObject& sampler, Clip& clip);
  void read_vendor(const JsonObject& animation, Clip& clip);
  void read_own_weights(const JsonObject& vendor, Clip& clip);
  void read_keys(const JsonObject& source, Channel& channel);
  void read_weights(const Channel& channel, const JsonObject& sampler, Clip& clip);
  std::size_t accessors() const { return document_.count("accessors"); }

  GltfDocument& document_;
  const std::vector<PartSource>& sources_;
  Character& character_;
};

Clip ClipReader::read(const JsonObject& animation) {
  Clip clip;
  clip.name = animation.text_or("name", "");
  const std::vector<JsonObject> samplers = animation.objects("samplers");
  for (const JsonObject& channel : animation.objects("channels")) read_channel(channel, samplers, clip);
  read_vendor(animation, clip);
  clip.carried = others_but_vendor(animation, {"name", "samplers", "channels"});
  return clip;
}

void ClipReader::read_keys(const JsonObject& source, Channel& channel) {
  channel.interpolation = interpolation_of(source);
  channel.times = document_.floats(source.index("input", accessors()), 1).values;
  channel.values = document_.floats(source.index("output", accessors()), channel.width()).values;
}

/// The clip's own channels of shapes, in place of those on the keys of all of a mesh's shapes.
void ClipReader::read_own_weights(const JsonObject& vendor, Clip& clip) {
  std::erase_if(clip.channels,
                [](const Channel& channel) { return channel.property == Channel::Property::shape_weight; });
  for (const JsonObject& source : vendor.objects("weights")) {
    Channel channel;
    channel.property = Channel::Property::shape_weight;
    channel.shape = find_shape(character_, source.text("shape"));
    if (channel.shape < 0)
      throw io_error(source.place_of("shape"), fmt::format("names {}", source.text("shape").substr(0, 100)),
                     "name one of the shapes");
    if (source.has("mesh")) channel.part = used_part_of_mesh(source, sources_);
    read_keys(source, channel);
    clip.channels.push_back(std::move(channel));
  }
}

/// The channels of shapes that the clip does not animate itself are there for other programs.
void ClipReader::read_vendor(const JsonObject& animation, Clip& clip) {
  if (!animation.has("extensions") || !animation.object("extensions").has(vendor_extension)) return;
  const JsonObject vendor = animation.object("extensions").object(vendor_extension);
  if (vendor.has("shapes")) {
    const std::vector<std::string> own = vendor.texts("shapes");
    std::erase_if(clip.channels, [&](const Channel& channel) {
      return channel.property == Channel::Property::shape_weight &&
             std::find(own.begin(), own.end(), character_.shapes[channel.shape].name) == own.end();
    });
  }
  if (vendor.has("weights")) read_own_weights(vendor, clip);
  if (vendor.truth_or("still", false)) clip.channels.clear();  // there for glTF's sake alone
  for (const JsonObject& source : vendor.objects("wires")) {
    Channel channel = read_wire_channel(source, character_);
    read_keys(source, channel);
    clip.channels.push_back(std::move(channel));
  }
  for (const JsonObject& source : vendor.objects("objects")) {
    Channel channel = read_object_channel(source, character_);
    read_keys(source, channel);
    clip.channels.push_back(std::move(channel));
  }
  for (const JsonObject& source : vendor.objects("sliders")) {
    Channel channel;
    channel.property = Channel::Property::slider;
    channel.slider = find_slider(character_, source.text("slider"));
    if (channel.slider < 0)
      throw io_error(source.place_of("slider"), fmt::format("names {}", source.text("slider").substr(0, 100)),
                     "name one of the sliders");
    read_keys(source, channel);
    clip.channels.push_back(std::move(channel));
  }
}

void ClipReader::read_channel(const JsonObject& source, const std::vector<JsonObject>& samplers, Clip& clip) {
  const JsonObject& sampler = samplers[source.index("sampler", samplers.size())];
  const JsonObject target = source.object("target");
  Channel channel;
  channel.node = target.index_or_none("node", character_.nodes.size());
  if (channel.node < 0) return;  // aims at an extension's property
  channel.interpolation = interpolation_of(sampler);
  channel.times = document_.floats(sampler.index("input", accessors()), 1).values;
  const std::string path = target.text("path");
  if (path == "weights") return read_weights(channel, sampler, clip);
  if (path == "translation")
    channel.property = Channel::Property::translation;
  else if (path == "rotation")
    channel.property = Channel::Property::rotation;
  else if (path == "scale")
    channel.property = Channel::Property::scale;
  else
    throw io_error(target.place_of("path"), fmt::format("is \"{}\"", path.substr(0, 40)),
                   "give translation, rotation, scale or weights");
  read_transform(std::move(channel), sampler, clip);
}

void ClipReader::read_transform(Channel channel, const JsonObject& sampler, Clip& clip) {
  const std::size_t values_a_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  channel.values = document_
                       .floats(sampler.index("output", accessors()), channel.width(),
                               static_cast<int>(channel.times.size() * values_a_key))
                       .values;
  clip.channels.push_back(std::move(channel));
}

/// How many parts that a clip can animate have the shape.
std::size_t shown_parts(const Character& character, int shape) {
  const std::vector<PartDelta>& parts = character.shapes[shape].parts;
  return static_cast<std::size_t>(std::count_if(
      parts.begin(), parts.end(), [&](const PartDelta& delta) { return character.parts[delta.part].shown; }));
}

/// One channel a shape. A shape that this part alone has gets a channel for all parts.
void ClipReader::read_weights(const Channel& common, const JsonObject& sampler, Clip& clip) {
  const auto part = std::find_if(character_.parts.begin(), character_.parts.end(),
                                 [&](const Part& p) { return p.node == common.node; });
  if (part == character_.parts.end()) return;
  const int part_index = static_cast<int>(part - character_.parts.begin());
  const std::vector<int>& shapes = sources_[part_index].shapes;
  if (shapes.empty())
    throw io_error(sampler.place(), "animates shape weights of a mesh without shapes", "remove the channel");
  const std::size_t keys = common.times.size();
  const std::size_t values_a_key = common.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const Table table = document_.floats(sampler.index("output", accessors()), 1);
  if (table.values.size() != keys * values_a_key * shapes.size())
    throw io_error(sampler.place_of("output"), fmt::format("has {} values", table.values.size()),
                   fmt::format("{} keys of {} shapes are needed", keys, shapes.size()));
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    Channel channel = common;
    channel.property = Channel::Property::shape_weight;
    channel.node = -1;
    channel.shape = shapes[s];
    channel.part = shown_parts(character_, shapes[s]) == 1 ? -1 : part_index;
    for (std::size_t row = 0; row < keys * values_a_key; ++row)
      channel.values.push_back(table.values[row * shapes.size() + s]);
    clip.channels.push_back(std::move(channel));
  }
}

/// Channels of one shape that are the same on every part that has it become one channel for all parts.
void merge_equal_parts(const Character& character, Clip& clip) {
  std::vector<std::vector<std::size_t>> by_shape(character.shapes.size());
  for (std::size_t c = 0; c < clip.channels.size(); ++c)
    if (clip.channels[c].shape >= 0 && clip.channels[c].part >= 0)
      by_shape[clip.channels[c].shape].push_back(c);
  std::vector<bool> drop(clip.channels.size(), false);
  for (std::size_t s = 0; s < by_shape.size(); ++s) {
    const std::vector<std::size_t>& same = by_shape[s];
    if (same.empty() || same.size() != shown_parts(character, static_cast<int>(s))) continue;
    Channel& first = clip.channels[same[0]];
    const bool equal = std::all_of(same.begin(), same.end(), [&](std::size_t c) {
      const Channel& other = clip.channels[c];
      return other.interpolation == first.interpolation && other.times == first.times &&
             other.values == first.values;
    });
    if (!equal) continue;
    first.part = -1;
    for (std::size_t k = 1; k < same.size(); ++k) drop[same[k]] = true;
  }
  std::size_t kept = 0;
  for (std::size_t c = 0; c < clip.channels.size(); ++c)
    if (!drop[c]) {
      if (kept != c) clip.channels[kept] = std::move(clip.channels[c]);
      ++kept;
    }
  clip.channels.resize(kept);
}

}  // namespace

void read_clips(GltfDocument& document, const std::vector<PartSource>& sources, Character& character) {
  ClipReader reader(document, sources, character);
  for (std::size_t a = 0; a < document.count("animations"); ++a) {
    Clip clip = reader.read(document.element("animations", static_cast<int>(a)));
    merge_equal_parts(character, clip);
    character.clips.push_back(std::move(clip));
  }
}

}  // namespace mien::detail
