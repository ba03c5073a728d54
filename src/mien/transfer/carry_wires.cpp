// Bindings are carried rather than made anew: what a hand corrected stays corrected, a mouth that is closed on the target binds as
// the source's open one does, and a rig on its own face comes back as it was. Falloff f and parameter u travel as the columns f, f u
// and f u u, whose mixes give the mean parameter and its spread.
#include "mien/transfer/carry_wires.h"

#include <algorithm>
#include <cmath>

#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

constexpr double least_falloff = 1e-5;
/// Parameters that spread wider than this share of the curve are not averaged.
constexpr double widest_spread = 0.1;

WeightMatrix matrix_of(const Character& source) {
  const std::vector<int> first = first_rows(source);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t w = 0; w < source.wires.size(); ++w)
    for (const WireBinding& binding : source.wires[w].bindings)
      for (std::size_t i = 0; i < binding.vertices.size(); ++i) {
        const int row = first[at(binding.part)] + binding.vertices[i], column = 3 * static_cast<int>(w);
        const double f = binding.falloff[i], u = binding.parameters[i] - source.wires[w].curve.low();
        entries.emplace_back(row, column, f);
        entries.emplace_back(row, column + 1, f * u);
        entries.emplace_back(row, column + 2, f * u * u);
      }
  WeightMatrix matrix(first.back(), 3 * static_cast<Eigen::Index>(source.wires.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The parameter that a row's sums say, or the closest one of the curve where they say two things at once.
double parameter_of(const Eigen::Vector3d& sums, const Wire& wire, const CurveQuery& query,
                    const Eigen::Vector3d& position) {
  const double low = wire.curve.low(), span = wire.curve.high() - low;
  const double mean = sums[1] / sums[0], spread = sums[2] / sums[0] - mean * mean;
  if (spread > widest_spread * widest_spread * span * span) return query.closest(position).parameter;
  return low + std::clamp(mean, 0.0, span);
}

std::vector<WireBinding> bindings_of(const Wire& wire, int column, const WeightMatrix& rows,
                                     const Character& target, const std::vector<Eigen::Matrix4d>& to_model) {
  const std::vector<int> first = first_rows(target);
  const CurveQuery query(wire.curve);
  std::vector<WireBinding> bindings;
  for (std::size_t p = 0; p < target.parts.size(); ++p) {
    WireBinding binding;
    binding.part = static_cast<int>(p);
    for (int row = first[p]; row < first[p + 1]; ++row) {
      Eigen::Vector3d sums = Eigen::Vector3d::Zero();
      for (WeightMatrix::InnerIterator entry(rows, row); entry; ++entry)
        if (entry.col() >= column && entry.col() < column + 3) sums[entry.col() - column] = entry.value();
      if (!(sums[0] > least_falloff)) continue;
      const Eigen::Vector3d local =
          target.parts[p].mesh.positions.row(row - first[p]).transpose().cast<double>();
      const Eigen::Vector3d position = (to_model[p] * local.homogeneous()).head<3>();
      binding.vertices.push_back(row - first[p]);
      binding.falloff.push_back(static_cast<float>(std::min(sums[0], 1.0)));
      binding.parameters.push_back(static_cast<float>(parameter_of(sums, wire, query, position)));
    }
    if (!binding.vertices.empty()) bindings.push_back(std::move(binding));
  }
  return bindings;
}

/// Each range grows as lengths do at its parameter; a single one as they do at the curve on average.
void scale_ranges(const Wire& source, const RigMap& map, std::vector<double>& ranges) {
  constexpr int samples = 9;
  const auto growth = [&](double share) {
    const double u = source.curve.low() + share * (source.curve.high() - source.curve.low());
    return map.space.scale(point_at(source.curve, u));
  };
  if (ranges.size() == 1) {
    double sum = 0;
    for (int k = 0; k < samples; ++k) sum += growth(k / (samples - 1.0));
    ranges[0] *= sum / samples;
    return;
  }
  for (std::size_t k = 0; k < ranges.size(); ++k)
    ranges[k] *= growth(static_cast<double>(k) / static_cast<double>(ranges.size() - 1));
}

void carry_points(const RigMap& map, Wire& wire) {
  std::vector<SurfacePoint> points;
  for (const SurfacePoint& point : wire.points)
    if (const auto carried = map.surface_point(point)) points.push_back(*carried);
  if (points.size() != wire.points.size()) points.clear();
  wire.points = std::move(points);
}

/// Per part its own space to model space, as skinned parts lie in it already.
std::vector<Eigen::Matrix4d> part_matrices(const Character& character) {
  const auto model = model_matrices(character);
  std::vector<Eigen::Matrix4d> matrices;
  for (const Part& part : character.parts)
    matrices.push_back(part.skin < 0 && part.node >= 0 ? model[at(part.node)] : Eigen::Matrix4d::Identity());
  return matrices;
}

}  // namespace

std::vector<Wire> carry_wires(const Character& source, const Character& target, const RigMap& map) {
  std::vector<Wire> wires = source.wires;
  if (wires.empty()) return wires;
  const WeightMatrix rows = map.rows(matrix_of(source));
  const std::vector<Eigen::Matrix4d> to_model = part_matrices(target);
  for (std::size_t w = 0; w < wires.size(); ++w) {
    const Wire& from = source.wires[w];
    Wire& wire = wires[w];
    for (Eigen::Index c = 0; c < from.curve.controls.rows(); ++c)
      wire.curve.controls.row(c) = map.space.position(from.curve.controls.row(c).transpose()).transpose();
    scale_ranges(from, map, wire.ranges);
    carry_points(map, wire);
    wire.bindings = bindings_of(wire, 3 * static_cast<int>(w), rows, target, to_model);
  }
  return wires;
}

std::vector<WireMove> carry_wire_moves(const Character& source, const std::vector<WireMove>& moves,
                                       const RigMap& map, double factor) {
  std::vector<WireMove> carried = moves;
  for (WireMove& move : carried) {
    const Wire& wire = source.wires[at(move.wire)];
    if (move.controls.rows() > 0) move.controls = factor * map.move(wire.curve.controls, move.controls);
    move.scale *= factor;
    for (Eigen::Index t = 0; t < move.turns.rows(); ++t)
      move.turns.row(t) =
          factor * (map.space.rotation(turn_place(wire, static_cast<int>(t))) * move.turns.row(t).transpose())
                       .transpose();
  }
  return carried;
}

Eigen::Vector3d turn_place(const Wire& wire, int turn) {
  const double share = (turn + 0.5) / std::max(1, wire.turn_controls);
  return point_at(wire.curve, wire.curve.low() + share * (wire.curve.high() - wire.curve.low()));
}

}  // namespace mien
