#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"
#include "mien/io/detail/point.h"
#include "mien/io/detail/rows_json.h"

// Wires in the MIEN_character extension: curves as JSON numbers, which keep doubles, what is long in accessors. A wire's binding to
// a mesh that another program changed no longer fits; it is left out, and so are moves of such a wire.

namespace mien::detail {
namespace {

constexpr int most_controls = 100000;

Json binding_json(const WireBinding& binding, GltfBuilder& builder) {
  const std::vector<std::uint32_t> vertices(binding.vertices.begin(), binding.vertices.end());
  return {{"mesh", binding.part},
          {"vertices", builder.add_numbers(vertices)},
          {"falloff", builder.add_floats(binding.falloff, 1)},
          {"parameters", builder.add_floats(binding.parameters, 1)}};
}

Json wire_json(const Wire& wire, GltfBuilder& builder) {
  Json json = {{"name", wire.name},
               {"feature", wire.feature},
               {"controls", rows_json(wire.curve.controls)},
               {"knots", wire.curve.knots},
               {"ranges", wire.ranges},
               {"localizing", wire.localizing},
               {"geodesic", wire.geodesic},
               {"turnControls", wire.turn_controls}};
  for (const SurfacePoint& point : wire.points) json["points"].push_back(vendor_point(point));
  for (const Eigen::Vector2d& point : wire.falloff) json["falloff"].push_back({point.x(), point.y()});
  for (const WireBinding& binding : wire.bindings)
    if (!binding.vertices.empty()) json["bindings"].push_back(binding_json(binding, builder));
  return json;
}

/// All moves of one shape as one row of floats: per wire its controls, scale and turns.
Json moves_json(const Character& character, const Shape& shape, GltfBuilder& builder) {
  Json wires = Json::array();
  std::vector<float> values;
  const auto add = [&](const PointsD& rows, int count) {
    for (int r = 0; r < count; ++r)
      for (int k = 0; k < 3; ++k)
        values.push_back(rows.rows() == count ? static_cast<float>(rows(r, k)) : 0.f);
  };
  for (const WireMove& move : shape.wires) {
    const Wire& wire = character.wires[move.wire];
    wires.push_back(wire.name);
    add(move.controls, wire.curve.control_count());
    values.push_back(static_cast<float>(move.scale));
    add(move.turns, wire.turn_controls);
  }
  return {{"shape", shape.name}, {"wires", std::move(wires)}, {"values", builder.add_floats(values, 1)}};
}

WireBinding read_binding(const JsonObject& source, GltfDocument& document, int part) {
  const std::size_t accessors = document.count("accessors");
  WireBinding binding;
  binding.part = part;
  const std::vector<std::uint32_t> vertices = document.integers(source.index("vertices", accessors), 1);
  binding.vertices.assign(vertices.begin(), vertices.end());
  const int rows = static_cast<int>(vertices.size());
  binding.falloff = document.floats(source.index("falloff", accessors), 1, rows).values;
  binding.parameters = document.floats(source.index("parameters", accessors), 1, rows).values;
  return binding;
}

bool fits(const WireBinding& binding, const Character& character) {
  const auto count = static_cast<int>(character.parts[binding.part].mesh.vertex_count());
  for (std::size_t i = 0; i < binding.vertices.size(); ++i)
    if (binding.vertices[i] < 0 || binding.vertices[i] >= count ||
        (i > 0 && binding.vertices[i] <= binding.vertices[i - 1]) ||
        !(binding.falloff[i] >= 0 && binding.falloff[i] <= 1) || !std::isfinite(binding.parameters[i]))
      return false;
  return true;
}

Wire read_wire(const JsonObject& source, GltfDocument& document, const std::vector<PartSource>& sources,
               const Character& character) {
  Wire wire;
  wire.name = source.text("name");
  wire.feature = source.text_or("feature", wire.name);
  wire.curve.controls = rows_of(source.numbers("controls"));
  wire.curve.knots = source.numbers("knots");
  try {
    require_valid(wire.curve);
  } catch (const Error& error) {
    throw io_error(source.place(), error.what());
  }
  wire.ranges = source.numbers("ranges");
  wire.localizing = source.number_or("localizing", wire.localizing);
  wire.geodesic = source.truth_or("geodesic", true);
  wire.turn_controls = static_cast<int>(source.integer_or("turnControls", 0, 0, most_controls));
  if (wire.turn_controls > 0 && wire.turn_controls < 4)
    throw io_error(source.place_of("turnControls"), fmt::format("is {}", wire.turn_controls),
                   "give 0, 4 or more");
  for (const JsonObject& point : source.objects("points"))
    wire.points.push_back(read_vendor_point(point, sources, character));
  if (source.has("falloff"))
    for (const Json& pair : source.json().at("falloff")) {
      if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number())
        throw io_error(source.place_of("falloff"), "holds something else than pairs of numbers",
                       "give [x, f]");
      wire.falloff.emplace_back(pair[0].get<double>(), pair[1].get<double>());
    }
  for (const JsonObject& binding : source.objects("bindings")) {
    const int part = part_of_mesh(binding, sources);
    if (part < 0) continue;
    WireBinding read = read_binding(binding, document, part);
    if (fits(read, character)) wire.bindings.push_back(std::move(read));
  }
  return wire;
}

void read_moves(const JsonObject& source, GltfDocument& document, Character& character) {
  const int shape = find_shape(character, source.text("shape"));
  if (shape < 0) return;  // another program took the shape away
  const std::vector<float> values =
      document.floats(source.index("values", document.count("accessors")), 1).values;
  std::size_t next = 0;
  const auto take = [&](int rows) {
    if (values.size() - next < static_cast<std::size_t>(3 * rows))
      throw io_error(source.place_of("values"), fmt::format("hold {} numbers", values.size()),
                     "give controls, scale and turns of each wire");
    PointsD result(rows, 3);
    for (int r = 0; r < rows; ++r)
      for (int k = 0; k < 3; ++k) result(r, k) = values[next++];
    return result;
  };
  for (const std::string& name : source.texts("wires")) {
    WireMove move;
    move.wire = find_wire(character, name);
    if (move.wire < 0)
      throw io_error(source.place_of("wires"), fmt::format("name {}", name.substr(0, 100)),
                     "name wires of the file");
    const Wire& wire = character.wires[move.wire];
    move.controls = take(wire.curve.control_count());
    if (next >= values.size())
      throw io_error(source.place_of("values"), "end within a wire",
                     "give controls, scale and turns of each wire");
    move.scale = values[next++];
    move.turns = take(wire.turn_controls);
    character.shapes[shape].wires.push_back(std::move(move));
  }
}

constexpr std::array<std::pair<Channel::Property, const char*>, 3> property_names{
    {{Channel::Property::wire_control, "control"},
     {Channel::Property::wire_scale, "scale"},
     {Channel::Property::wire_turn, "turn"}}};

}  // namespace

Json wire_channel_json(const Character& character, const Channel& channel, GltfBuilder& builder) {
  Json json = {{"wire", character.wires[channel.wire].name},
               {"interpolation", name_of(channel.interpolation)},
               {"input", builder.add_floats(channel.times, 1, true)},
               {"output", builder.add_floats(channel.values, channel.width())}};
  for (const auto& [property, name] : property_names)
    if (property == channel.property) json["moves"] = name;
  if (channel.property != Channel::Property::wire_scale) json["index"] = channel.control;
  return json;
}

Channel read_wire_channel(const JsonObject& source, const Character& character) {
  Channel channel;
  channel.wire = find_wire(character, source.text("wire"));
  if (channel.wire < 0)
    throw io_error(source.place_of("wire"), fmt::format("names {}", source.text("wire").substr(0, 100)),
                   "name one of the wires");
  const std::string moves = source.text("moves");
  const auto named = std::find_if(property_names.begin(), property_names.end(),
                                  [&](const auto& entry) { return moves == entry.second; });
  if (named == property_names.end())
    throw io_error(source.place_of("moves"), fmt::format("is \"{}\"", moves.substr(0, 40)),
                   "give control, scale or turn");
  channel.property = named->first;
  const Wire& wire = character.wires[channel.wire];
  if (channel.property == Channel::Property::wire_control)
    channel.control = source.index("index", static_cast<std::size_t>(wire.curve.control_count()));
  else if (channel.property == Channel::Property::wire_turn)
    channel.control = source.index("index", static_cast<std::size_t>(wire.turn_controls));
  return channel;
}

void write_wires(const Character& character, GltfBuilder& builder, Json& vendor) {
  for (const Wire& wire : character.wires) vendor["wires"].push_back(wire_json(wire, builder));
  for (const Shape& shape : character.shapes)
    if (!shape.wires.empty()) vendor["wireMoves"].push_back(moves_json(character, shape, builder));
}

void read_wires(const JsonObject& vendor, GltfDocument& document, const std::vector<PartSource>& sources,
                Character& character) {
  for (const JsonObject& source : vendor.objects("wires"))
    character.wires.push_back(read_wire(source, document, sources, character));
  for (const JsonObject& source : vendor.objects("wireMoves")) read_moves(source, document, character);
}

}  // namespace mien::detail
