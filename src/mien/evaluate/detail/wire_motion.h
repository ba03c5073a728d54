#pragma once
/// What a pose's wires do, added up: a row of three numbers for each control point and each turn.

#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/deform/wires.h"

namespace mien::detail {

/// Where each wire's rows are: the control points of all wires, then their turns.
class WireRows {
 public:
  explicit WireRows(const Character& character);
  int wire_count() const { return static_cast<int>(control_begin_.size()) - 1; }
  int control_begin(int wire) const { return control_begin_[wire]; }
  int control_count(int wire) const { return control_begin_[wire + 1] - control_begin_[wire]; }
  int turn_begin(int wire) const { return turn_begin_[wire]; }
  int turn_count(int wire) const { return turn_begin_[wire + 1] - turn_begin_[wire]; }
  int row_count() const { return turn_begin_.back(); }
  ///   throws  invalid_input: as WireField::add
  void check(std::span<const WireMove> moves) const { sizes_.check(moves); }

 private:
  std::vector<int> control_begin_{0}, turn_begin_;  // wires + 1
  WireField sizes_;                                 // of the wires without what they reach
};

struct WireMotion {
  explicit WireMotion(const WireRows& rows);
  bool is_still = true;         ///< no wire moves; the rest is not kept then
  std::vector<char> is_moving;  ///< by wire
  std::vector<double> scales;   ///< by wire: s - 1
  PointsD rows;

  ///   throws  invalid_input: as WireField::add
  void set(const WireRows& layout, std::span<const WireMove> moves);

  /// What one entry adds to its vertex, model space.
  Eigen::Vector3d of(const WireRows& layout, const WireField::Entry& entry) const;
};

}  // namespace mien::detail
