// Entries are floats of 64 bytes: a frame is bound by memory, and the smoothness of a face ends long before their seventh digit.
#include "mien/deform/wires.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "mien/core/error.h"

namespace mien {
namespace {

/// Shares below this are left out: nobody sees what they move, and they are a quarter of all.
constexpr double least_share = 5e-4;

/// The transform that carries a part to model space while the character is bound.
Eigen::Matrix4d bind_matrix(const Character& character, int part) {
  const Part& p = character.parts[part];
  return p.skin >= 0 || p.node < 0 ? Eigen::Matrix4d::Identity() : model_matrices(character)[p.node];
}

void check_binding(const Character& character, const Wire& wire, const WireBinding& binding) {
  const std::string place = "wire " + wire.name;
  if (binding.part < 0 || binding.part >= static_cast<int>(character.parts.size()))
    throw invalid_input(place, "reaches part " + std::to_string(binding.part),
                        "a part from 0 to " + std::to_string(static_cast<int>(character.parts.size()) - 1));
  if (binding.falloff.size() != binding.vertices.size() ||
      binding.parameters.size() != binding.vertices.size())
    throw invalid_input(place, "has a binding whose arrays differ in length",
                        "one falloff and one parameter a vertex");
  const auto count = static_cast<int>(character.parts[binding.part].mesh.vertex_count());
  for (std::size_t i = 0; i < binding.vertices.size(); ++i) {
    if (binding.vertices[i] < 0 || binding.vertices[i] >= count ||
        (i > 0 && binding.vertices[i] <= binding.vertices[i - 1]))
      throw invalid_input(place + ", vertex " + std::to_string(binding.vertices[i]),
                          "is out of range or out of order", "ascending vertices of the part");
    if (!(binding.falloff[i] >= 0 && binding.falloff[i] <= 1) || !std::isfinite(binding.parameters[i]))
      throw invalid_input(place + ", vertex " + std::to_string(binding.vertices[i]),
                          "has a falloff outside of 0 to 1 or a parameter that is not finite");
  }
}

/// x, y, z and a zero, worked on together.
using Lanes = float __attribute__((vector_size(16), may_alias));

const Lanes* lanes(const Eigen::Matrix4Xf& columns, int column) {
  return reinterpret_cast<const Lanes*>(columns.data()) + column;
}

/// y, z, x: a x b = shifted(a shifted(b) - shifted(a) b).
Lanes shifted(const Lanes& v) {
  return __builtin_shufflevector(v, v, 1, 2, 0, 3);
}

/// f^k, without a logarithm for the usual k.
double power(double falloff, double localizing) {
  return localizing == 3 ? falloff * falloff * falloff : std::pow(falloff, localizing);
}

/// Knots of the turns' basis, over [0, 1].
std::vector<double> turn_knots_of(const Wire& wire) {
  return wire.turn_controls > 0 ? clamped_knots(wire.turn_controls) : std::vector<double>{};
}

SplineBasis turn_basis(const Wire& wire, std::span<const double> turn_knots, double parameter) {
  return basis_at(turn_knots, (parameter - wire.curve.low()) / (wire.curve.high() - wire.curve.low()));
}

WireField::Entry entry_of(const Wire& wire, std::span<const double> turn_knots, double parameter,
                          double share, const Eigen::Vector3d& position) {
  WireField::Entry entry{};
  const SplineBasis basis = basis_at(wire.curve.knots, parameter);
  entry.first = static_cast<short>(basis.first);
  for (int a = 0; a < 4; ++a) entry.basis[a] = static_cast<float>(share * basis.values[a]);
  Eigen::Vector3d on_curve = Eigen::Vector3d::Zero();
  for (int a = 0; a < 4; ++a)
    on_curve += basis.values[a] * wire.curve.controls.row(basis.first + a).transpose();
  entry.offset = (share * (position - on_curve)).cast<float>();
  if (wire.turn_controls > 0) {
    const SplineBasis turn = turn_basis(wire, turn_knots, parameter);
    entry.turn_first = static_cast<short>(turn.first);
    for (int a = 0; a < 4; ++a) entry.turn_basis[a] = static_cast<float>(turn.values[a]);
  }
  return entry;
}

void check_move(const std::string& name, const WireMove& move, int controls, int turns) {
  const auto check = [&](const PointsD& rows, int wanted, const char* what) {
    if (rows.rows() != 0 && rows.rows() != wanted)
      throw invalid_input("wire " + name, "is moved by " + std::to_string(rows.rows()) + " " + what,
                          std::to_string(wanted));
    if (!rows.allFinite())
      throw invalid_input("wire " + name, std::string("has ") + what + " that are not finite");
  };
  check(move.controls, controls, "control points");
  check(move.turns, turns, "turns");
  if (!std::isfinite(move.scale)) throw invalid_input("wire " + name, "has a scale that is not finite");
}

}  // namespace

/// One wire's hold on one vertex before the wires share it.
struct WireField::Hold {
  int vertex = 0, wire = 0;
  float falloff = 0, parameter = 0;
};

double falloff_at(const Wire& wire, double x) {
  if (!(x >= 0 && x < 1)) return 0;
  if (wire.falloff.empty()) return (x * x - 1) * (x * x - 1);
  const auto next = std::upper_bound(wire.falloff.begin(), wire.falloff.end(), x,
                                     [](double at, const Eigen::Vector2d& point) { return at < point.x(); });
  if (next == wire.falloff.begin()) return next->y();
  if (next == wire.falloff.end()) return wire.falloff.back().y();
  const Eigen::Vector2d &a = *(next - 1), &b = *next;
  return a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x());
}

double range_at(const Wire& wire, double parameter) {
  if (wire.ranges.empty()) return 0;
  const double u = (parameter - wire.curve.low()) / (wire.curve.high() - wire.curve.low());
  const double at = std::clamp(u, 0.0, 1.0) * static_cast<double>(wire.ranges.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(at), wire.ranges.size() - 1),
                    high = std::min(low + 1, wire.ranges.size() - 1);
  return wire.ranges[low] + (wire.ranges[high] - wire.ranges[low]) * (at - static_cast<double>(low));
}

PointsD bind_positions(const Character& character, int part) {
  const Eigen::Matrix4d matrix = bind_matrix(character, part);
  PointsD positions =
      character.parts[part].mesh.positions.cast<double>() * matrix.topLeftCorner<3, 3>().transpose();
  positions.rowwise() += matrix.topRightCorner<3, 1>().transpose();
  return positions;
}

WireField::WireField(const Character& character, std::span<const Wire> wires)
    : parts_(character.parts.size()), to_part_(character.parts.size(), Eigen::Matrix3d::Identity()) {
  if (wires.size() > 32767)
    throw invalid_input("wires", "number " + std::to_string(wires.size()), "at most 32767");
  Size size;
  std::vector<std::vector<Hold>> holds(character.parts.size());
  for (std::size_t w = 0; w < wires.size(); ++w) {
    const Wire& wire = wires[w];
    require_valid(wire.curve);
    if (wire.turn_controls != 0 && wire.turn_controls < 4)
      throw invalid_input("wire " + wire.name, "has " + std::to_string(wire.turn_controls) + " turns",
                          "four or more, or 0");
    size.controls = wire.curve.control_count();
    size.turns = wire.turn_controls;
    sizes_.push_back(size);
    names_.push_back(wire.name);
    size.control_begin += size.controls;
    size.turn_begin += size.turns;
    for (const WireBinding& binding : wire.bindings) {
      check_binding(character, wire, binding);
      for (std::size_t i = 0; i < binding.vertices.size(); ++i)
        if (binding.falloff[i] > 0)
          holds[binding.part].push_back(
              {binding.vertices[i], static_cast<int>(w), binding.falloff[i], binding.parameters[i]});
    }
  }
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (!holds[p].empty()) share_part(character, wires, static_cast<int>(p), holds[p]);
}

void WireField::share_part(const Character& character, std::span<const Wire> wires, int part,
                           const std::vector<Hold>& holds) {
  const PointsD positions = bind_positions(character, part);
  PartRows& rows = parts_[part];
  to_part_[part] = bind_matrix(character, part).topLeftCorner<3, 3>().inverse();
  std::vector<int> begin(static_cast<std::size_t>(positions.rows()) + 1, 0);
  for (const Hold& hold : holds) ++begin[hold.vertex + 1];
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) begin[v + 1] += begin[v];
  std::vector<Hold> sorted(holds.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const Hold& hold : holds) sorted[next[hold.vertex]++] = hold;
  rows.offsets.push_back(0);
  rows.entries.reserve(holds.size());
  std::vector<std::vector<double>> turn_knots;
  for (const Wire& wire : wires) turn_knots.push_back(turn_knots_of(wire));
  std::vector<double> powers;
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const std::span<const Hold> here(sorted.data() + begin[v], sorted.data() + begin[v + 1]);
    powers.clear();
    double sum = 0;
    for (const Hold& hold : here) {
      powers.push_back(power(hold.falloff, wires[hold.wire].localizing));
      sum += powers.back();
    }
    if (!(sum > 0)) continue;
    for (std::size_t i = 0; i < here.size(); ++i) {
      const double share = here[i].falloff * powers[i] / sum;
      if (share < least_share) continue;
      rows.entries.push_back(entry_of(wires[here[i].wire], turn_knots[here[i].wire], here[i].parameter, share,
                                      positions.row(v).transpose()));
      rows.entries.back().wire = static_cast<short>(here[i].wire);
    }
    if (static_cast<int>(rows.entries.size()) == rows.offsets.back()) continue;
    rows.vertices.push_back(static_cast<int>(v));
    rows.offsets.push_back(static_cast<int>(rows.entries.size()));
  }
}

void WireField::check(std::span<const WireMove> moves) const {
  for (const WireMove& move : moves) {
    if (move.wire < 0 || move.wire >= wire_count())
      throw invalid_input("wire " + std::to_string(move.wire), "does not exist",
                          "a wire from 0 to " + std::to_string(wire_count() - 1));
    check_move(names_[move.wire], move, sizes_[move.wire].controls, sizes_[move.wire].turns);
  }
}

/// The sums of moves: a column a control point and a turn, and what each wire does.
struct WireField::Drive {
  Eigen::Matrix4Xf controls, turns;
  std::vector<float> scales;
  std::vector<char> active;
};

WireField::Drive WireField::drive_of(std::span<const WireMove> moves) const {
  const Size& last = sizes_.back();
  Drive drive{Eigen::Matrix4Xf::Zero(4, last.control_begin + last.controls),
              Eigen::Matrix4Xf::Zero(4, last.turn_begin + last.turns + 4),
              std::vector<float>(sizes_.size(), 0), std::vector<char>(sizes_.size(), 0)};
  for (const WireMove& move : moves) {
    const Size& size = sizes_[move.wire];
    drive.active[move.wire] = 1;
    drive.scales[move.wire] += static_cast<float>(move.scale);
    if (move.controls.rows() > 0)
      drive.controls.block(0, size.control_begin, 3, size.controls) +=
          move.controls.transpose().cast<float>();
    if (move.turns.rows() > 0)
      drive.turns.block(0, size.turn_begin, 3, size.turns) += move.turns.transpose().cast<float>();
  }
  return drive;
}

void WireField::add(int part, std::span<const WireMove> moves, PointsD& positions) const {
  check(moves);
  if (part < 0 || part >= static_cast<int>(parts_.size()))
    throw invalid_input("part " + std::to_string(part), "does not exist",
                        "a part from 0 to " + std::to_string(static_cast<int>(parts_.size()) - 1));
  const PartRows& rows = parts_[part];
  if (!rows.vertices.empty() && rows.vertices.back() >= positions.rows())
    throw invalid_input("part " + std::to_string(part),
                        "has " + std::to_string(positions.rows()) + " positions", "one a vertex");
  if (moves.empty() || sizes_.empty()) return;
  const Drive drive = drive_of(moves);
  const bool same_space = to_part_[part] == Eigen::Matrix3d::Identity();
  for (std::size_t row = 0; row < rows.vertices.size(); ++row) {
    Lanes sum{}, crossed{};
    bool moved = false;
    for (int e = rows.offsets[row]; e < rows.offsets[row + 1]; ++e) {
      const Entry& entry = rows.entries[e];
      if (!drive.active[entry.wire]) continue;
      moved = true;
      const Size& size = sizes_[entry.wire];
      const Lanes* const q = lanes(drive.controls, size.control_begin + entry.first);
      const Lanes* const omega = lanes(drive.turns, size.turn_begin + entry.turn_first);
      Lanes turn{};
      for (int a = 0; a < 4; ++a) {
        sum += entry.basis[a] * q[a];
        turn += entry.turn_basis[a] * omega[a];
      }
      const Lanes r{entry.offset[0], entry.offset[1], entry.offset[2], 0};
      sum += drive.scales[entry.wire] * r;
      crossed += turn * shifted(r) - shifted(turn) * r;
    }
    if (!moved) continue;
    sum += shifted(crossed);
    const Eigen::Vector3d add(sum[0], sum[1], sum[2]);
    positions.row(rows.vertices[row]) += (same_space ? add : to_part_[part] * add).transpose();
  }
}

}  // namespace mien
