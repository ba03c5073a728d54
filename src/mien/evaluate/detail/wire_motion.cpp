#include "mien/evaluate/detail/wire_motion.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace mien::detail {
namespace {

/// The wires of a character without what they reach.
std::vector<Wire> bare_wires(const Character& character) {
  std::vector<Wire> wires;
  for (const Wire& wire : character.wires) {
    wires.push_back({});
    wires.back().name = wire.name;
    wires.back().curve = wire.curve;
    wires.back().turn_controls = wire.turn_controls;
  }
  return wires;
}

}  // namespace

WireRows::WireRows(const Character& character) : sizes_({}, bare_wires(character)) {
  for (const Wire& wire : character.wires)
    control_begin_.push_back(control_begin_.back() + wire.curve.control_count());
  turn_begin_.push_back(control_begin_.back());
  for (const Wire& wire : character.wires) turn_begin_.push_back(turn_begin_.back() + wire.turn_controls);
}

WireMotion::WireMotion(const WireRows& layout)
    : is_moving(static_cast<std::size_t>(layout.wire_count()), 0),
      scales(is_moving.size(), 0),
      rows(PointsD::Zero(layout.row_count(), 3)) {}

void WireMotion::set(const WireRows& layout, std::span<const WireMove> moves) {
  layout.check(moves);
  is_still = moves.empty();
  if (is_still) return;
  std::fill(is_moving.begin(), is_moving.end(), 0);
  std::fill(scales.begin(), scales.end(), 0);
  rows.setZero();
  for (const WireMove& move : moves) {
    is_moving[move.wire] = 1;
    scales[move.wire] += move.scale;
    if (move.controls.rows() > 0)
      rows.middleRows(layout.control_begin(move.wire), move.controls.rows()) += move.controls;
    if (move.turns.rows() > 0) rows.middleRows(layout.turn_begin(move.wire), move.turns.rows()) += move.turns;
  }
}

Eigen::Vector3d WireMotion::of(const WireRows& layout, const WireField::Entry& entry) const {
  if (!is_moving[entry.wire]) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d arm = entry.offset.cast<double>();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
  const int control = layout.control_begin(entry.wire) + entry.first;
  const int turn_control = layout.turn_begin(entry.wire) + entry.turn_first;
  for (int a = 0; a < 4; ++a) {
    shift += static_cast<double>(entry.basis[a]) * rows.row(control + a).transpose();
    if (layout.turn_count(entry.wire) > 0)
      turn += static_cast<double>(entry.turn_basis[a]) * rows.row(turn_control + a).transpose();
  }
  return shift + scales[entry.wire] * arm + turn.cross(arm);
}

}  // namespace mien::detail
