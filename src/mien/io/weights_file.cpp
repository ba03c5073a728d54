#include "mien/io/weights_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/json_file.h"
#include "mien/io/file.h"

namespace mien {
namespace {

using detail::Json;
using detail::JsonObject;

/// How many letters to insert, delete or replace to turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

/// The one of `elements` (shapes, sliders) whose name is most like `name`, as an error.
template <typename Elements>
Error no_such(const char* kind, const Elements& elements, std::string_view name) {
  const std::string_view start = name.substr(0, 100);
  const std::string place = fmt::format("{} {}", kind, start);
  if (elements.empty())
    return invalid_input(place, "does not exist", fmt::format("the character has no {}s", kind));
  const auto nearest = std::min_element(elements.begin(), elements.end(), [&](const auto& a, const auto& b) {
    return edit_distance(start, a.name) < edit_distance(start, b.name);
  });
  return invalid_input(
      place, "does not exist",
      fmt::format("name one of the {} {}s, perhaps {}", elements.size(), kind, nearest->name));
}

/// A JSON row [x, y, z] for each row.
Json rows_json(const PointsD& rows) {
  Json json = Json::array();
  for (Eigen::Index r = 0; r < rows.rows(); ++r) json.push_back({rows(r, 0), rows(r, 1), rows(r, 2)});
  return json;
}

/// `wanted` rows of three numbers, or none.
PointsD read_rows(const JsonObject& source, const char* key, int wanted) {
  if (!source.has(key)) return {};
  const Json& json = source.json()[key];
  const Error odd =
      io_error(source.place_of(key), "is no list of points", fmt::format("give {} times [x, y, z]", wanted));
  if (!json.is_array() || json.size() != static_cast<std::size_t>(wanted)) throw odd;
  PointsD rows(wanted, 3);
  for (int r = 0; r < wanted; ++r) {
    const Json& row = json[static_cast<std::size_t>(r)];
    if (!row.is_array() || row.size() != 3) throw odd;
    for (int k = 0; k < 3; ++k) {
      if (!row[static_cast<std::size_t>(k)].is_number()) throw odd;
      rows(r, k) = row[static_cast<std::size_t>(k)].get<double>();
    }
  }
  if (!rows.allFinite()) throw odd;
  return rows;
}

/// The moves added up, one a wire, by wire.
std::map<int, WireMove> moves_by_wire(const Character& character, const std::vector<WireMove>& moves) {
  std::map<int, WireMove> sums;
  for (const WireMove& move : moves) {
    if (move.wire < 0 || move.wire >= static_cast<int>(character.wires.size()))
      throw invalid_input(fmt::format("wire {}", move.wire), "does not exist",
                          fmt::format("the character has {} wires", character.wires.size()));
    const Wire& wire = character.wires[static_cast<std::size_t>(move.wire)];
    WireMove& sum = sums.try_emplace(move.wire, WireMove{move.wire, {}, 0, {}}).first->second;
    const auto add = [&](const PointsD& rows, int wanted, PointsD& total) {
      if (rows.rows() == 0) return;
      if (rows.rows() != wanted || !rows.allFinite())
        throw invalid_input("moves of wire " + wire.name, "do not fit it or are not finite",
                            "one finite row a control point or turn");
      if (total.rows() == 0) total.setZero(wanted, 3);
      total += rows;
    };
    add(move.controls, wire.curve.control_count(), sum.controls);
    add(move.turns, wire.turn_controls, sum.turns);
    sum.scale += move.scale;
    if (!std::isfinite(sum.scale))
      throw invalid_input("scale of wire " + wire.name, "is not finite", "give a finite number");
  }
  return sums;
}

}  // namespace

int shape_index(const Character& character, std::string_view name) {
  const int shape = find_shape(character, name);
  if (shape < 0) throw no_such("shape", character.shapes, name);
  return shape;
}

int slider_index(const Character& character, std::string_view name) {
  const int slider = find_slider(character, name);
  if (slider < 0) throw no_such("slider", character.sliders, name);
  return slider;
}

int wire_index(const Character& character, std::string_view name) {
  const int wire = find_wire(character, name);
  if (wire < 0) throw no_such("wire", character.wires, name);
  return wire;
}

SliderValues read_weights(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
    if (!root.has("weights"))
      throw io_error("file", "has no \"weights\"", R"(give {"weights": {NAME: NUMBER}})");
    const JsonObject named = root.object("weights");
    SliderValues sliders(character.sliders.size());
    for (const auto& [name, value] : named.json().items())
      sliders.values[slider_index(character, name)] = named.number(name.c_str());
    return sliders;
  });
}

std::vector<WireMove> read_wire_moves(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
    std::map<int, WireMove> moves;
    if (!root.has("wires")) return std::vector<WireMove>{};
    const JsonObject named = root.object("wires");
    for (const auto& [name, unused] : named.json().items()) {
      const JsonObject source = named.object(name.c_str());
      source.expect_only({"controls", "scale", "turns"});
      WireMove move;
      move.wire = wire_index(character, name);
      const Wire& wire = character.wires[static_cast<std::size_t>(move.wire)];
      move.controls = read_rows(source, "controls", wire.curve.control_count());
      move.scale = source.number_or("scale", 0);
      move.turns = read_rows(source, "turns", wire.turn_controls);
      moves.emplace(move.wire, std::move(move));
    }
    std::vector<WireMove> list;
    for (auto& [wire, move] : moves) list.push_back(std::move(move));
    return list;
  });
}

void write_weights(const SliderValues& sliders, const Character& character, const std::filesystem::path& path,
                   const std::vector<WireMove>& wires) {
  if (sliders.values.size() != static_cast<Eigen::Index>(character.sliders.size()))
    throw invalid_input("weights", fmt::format("are {}", sliders.values.size()),
                        fmt::format("the character has {} sliders", character.sliders.size()));
  Json named = Json::object();
  for (std::size_t s = 0; s < character.sliders.size(); ++s) {
    const double value = sliders.values[static_cast<Eigen::Index>(s)];
    if (!std::isfinite(value))
      throw invalid_input("weight of " + character.sliders[s].name, "is not finite", "give a finite number");
    if (value != 0) named[character.sliders[s].name] = value;
  }
  Json root = {{"weights", named}};
  for (const auto& [index, move] : moves_by_wire(character, wires)) {
    Json& json = root["wires"][character.wires[static_cast<std::size_t>(index)].name];
    json = {{"scale", move.scale}};
    if (move.controls.rows() > 0) json["controls"] = rows_json(move.controls);
    if (move.turns.rows() > 0) json["turns"] = rows_json(move.turns);
  }
  write_file_atomically(path, detail::json_text(root, 1) + "\n");
}

}  // namespace mien
