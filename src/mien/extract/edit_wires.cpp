#include "mien/extract/edit_wires.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mien/core/error.h"
#include "mien/deform/wires.h"
#include "mien/extract/detail/deltas.h"

namespace mien {
namespace {

void check_shape(const Character& character, int shape) {
  if (shape < 0 || shape >= static_cast<int>(character.shapes.size()))
    throw invalid_input("shape " + std::to_string(shape), "does not exist",
                        "one from 0 to " + std::to_string(static_cast<int>(character.shapes.size()) - 1));
}

/// Rows that are absent count as zero.
PointsD sum(const PointsD& a, const PointsD& b) {
  if (a.rows() == 0) return b;
  return b.rows() == 0 ? a : PointsD(a + b);
}

void add_move(std::vector<WireMove>& moves, const WireMove& move) {
  auto at = std::lower_bound(moves.begin(), moves.end(), move.wire,
                             [](const WireMove& m, int wire) { return m.wire < wire; });
  if (at == moves.end() || at->wire != move.wire) {
    moves.insert(at, move);
    return;
  }
  at->controls = sum(at->controls, move.controls);
  at->turns = sum(at->turns, move.turns);
  at->scale += move.scale;
}

}  // namespace

Character edit_wires(const Character& character, int shape, std::span<const WireMove> moves) {
  check_shape(character, shape);
  const WireField field(character, character.wires);
  Character edited = character;
  Shape& changed = edited.shapes[shape];
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    PointsD added = PointsD::Zero(character.parts[p].mesh.positions.rows(), 3);
    field.add(part, moves, added);
    if (added.isZero(0)) continue;
    const Points dense = detail::dense_delta(character, character.shapes[shape], part) + added.cast<float>();
    detail::replace_delta(changed, detail::sparse_delta(part, dense));
  }
  for (const WireMove& move : moves) add_move(changed.wires, move);
  return edited;
}

std::vector<WireMove> exaggerate_wires(const Character& character, int shape, double factor,
                                       std::string_view feature) {
  check_shape(character, shape);
  const Shape& source = character.shapes[shape];
  if (source.wires.empty())
    throw invalid_input("shape " + source.name, "has no wires", "one whose wires were extracted");
  if (!std::isfinite(factor)) throw invalid_input("factor", "is not finite", "a finite number");
  const std::vector<std::string> features = wire_features(character);
  if (!feature.empty() && std::find(features.begin(), features.end(), feature) == features.end())
    throw invalid_input("feature " + std::string(feature), "has no wire", "a feature of the wires");
  std::vector<WireMove> moves;
  for (WireMove move : source.wires) {
    if (!feature.empty() && character.wires[move.wire].feature != feature) continue;
    move.controls *= factor - 1;
    move.turns *= factor - 1;
    move.scale *= factor - 1;
    moves.push_back(std::move(move));
  }
  return moves;
}

std::vector<std::string> wire_features(const Character& character) {
  std::vector<std::string> features;
  for (const Wire& wire : character.wires)
    if (std::find(features.begin(), features.end(), wire.feature) == features.end())
      features.push_back(wire.feature);
  return features;
}

}  // namespace mien
