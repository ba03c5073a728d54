#pragma once
/// Wires on parts: neutral + what the wires add.

#include <span>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// The wires of a character, compiled: each vertex with the wires that reach it. A wire alone moves p by
///   f [ sigma r + sum_l B_l(u) q_l + (sum_l C_l(u) omega_l) x r ],   r = p - R(u)
/// with q the control points' displacements, sigma the scale less one, omega the turns, u and f from the binding; several
/// are averaged with the weights f^k / sum f^k. So a vertex gets the share w = f^(k+1) / sum f^k of each bracket.
///   method  Pyun, Shin and Shin 2001, eq. 3 and 8; the turn is the rotation of Singh and Fiume 1998 to first order, which
///           lids and rolling lips need
class WireField {
 public:
  /// One wire at one vertex. `share` is folded into `basis` and `offset`.
  struct Entry {
    float basis[4];          ///< w B_l(u) of the control points `first` ...
    float turn_basis[4];     ///< C_l(u) of the turns `turn_first` ...
    Eigen::Vector3f offset;  ///< w (p - R(u)), model space
    short wire, first, turn_first;
  };
  struct PartRows {
    std::vector<int> vertices;   ///< ascending: those that a wire reaches
    std::vector<int> offsets;    ///< #vertices + 1: entries of row v are [offsets[v], offsets[v + 1])
    std::vector<Entry> entries;  ///< of a row ascending by wire
  };

  ///   throws  invalid_input: a binding that names a part or vertex out of range or whose arrays differ in length, a
  ///           curve that is not valid, more than 32767 wires
  ///   cost    linear in the bindings
  WireField(const Character& character, std::span<const Wire> wires);

  /// Adds what the moves do to `positions` (#V x 3, part space) of one part. Without moves nothing changes, bit for bit.
  ///   throws  invalid_input: a wire out of range, another number of control points or turns than the wire's, numbers that
  ///           are not finite, another number of positions than the part has
  ///   cost    about 3 ns an entry, 0.3 ms for 22 wires on a face of 13,000 vertices in reach
  void add(int part, std::span<const WireMove> moves, PointsD& positions) const;

  ///   throws  as add, for the moves
  void check(std::span<const WireMove> moves) const;

  int wire_count() const { return static_cast<int>(sizes_.size()); }
  const std::vector<PartRows>& parts() const { return parts_; }
  /// Model space vectors to the part's own space.
  const Eigen::Matrix3d& to_part(int part) const { return to_part_[part]; }

 private:
  struct Size {
    int controls = 0, turns = 0, control_begin = 0, turn_begin = 0;
  };
  struct Hold;
  struct Drive;
  Drive drive_of(std::span<const WireMove> moves) const;
  void share_part(const Character& character, std::span<const Wire> wires, int part,
                  const std::vector<Hold>& holds);

  std::vector<Size> sizes_;
  std::vector<std::string> names_;
  std::vector<PartRows> parts_;
  std::vector<Eigen::Matrix3d> to_part_;  ///< per part: model space vectors to its own space
};

/// Vertices of a part where wires find them: model space, neutral, bind pose. #V x 3.
PointsD bind_positions(const Character& character, int part);

/// WX's falloff (x^2 - 1)^2 within the range, 0 beyond, or the wire's drawn one.
double falloff_at(const Wire& wire, double x);

/// The range at a parameter of the wire's curve.
double range_at(const Wire& wire, double parameter);

}  // namespace mien
