// Columns of a turn are e x r. Their products with everything else are sums of c1 c2 r1 r2' over the vertices, so those moments
// are gathered first, for every two wires that share vertices, and spread over the unknowns afterwards: a third of the work of multiplying
// the columns themselves. A few dozen vertices at a time, whose rows stay in the cache: their neighbours are reached by the same wires.
#include "mien/extract/detail/wire_system.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mien/extract/detail/wire_kernels.h"

namespace mien::detail {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t vertices_together = 64;

/// A wire and the first of the four turns that meet at a vertex.
struct Segment {
  int wire = 0, turn_first = 0;
};

/// The first unknown of a segment's coupled functions: sigma, then its four turns.
int unknown_of(const WireColumns& columns, const Segment& segment, int function) {
  const int sigma = columns.coupled[segment.wire];
  return columns.unknowns[function == 0 ? sigma : sigma + segment.turn_first + function];
}

/// Sums of products of two segments' rows, and the pairs of rows that wait to be added.
struct Block {
  Block(const WireColumns& columns, const Segment& a, const Segment& b, bool with_itself)
      : first(a),
        second(b),
        same(with_itself),
        controls_first(columns.control_count_of(a.wire)),
        controls_second(columns.control_count_of(b.wire)),
        sums(static_cast<std::size_t>(256 + 16 * (controls_first + controls_second) +
                                      controls_first * controls_second),
             0) {}

  WireBlock parts() {
    double* const cross = sums.data() + 256;
    return {sums.data(), cross, cross + 16L * controls_first,
            cross + 16L * (controls_first + controls_second), controls_second};
  }

  Segment first, second;
  bool same;  ///< a segment with itself
  int controls_first, controls_second;
  std::vector<double> sums;  ///< as `parts` takes them apart
  std::vector<WirePair> waiting;
};

/// Z'WZ, block by block.
class Moments {
 public:
  Moments(const WireField& field, const WireColumns& columns, const std::vector<std::vector<float>>& weights);
  std::vector<Block>& blocks() { return blocks_; }

 private:
  void add_vertex(const WireField::PartRows& part, std::size_t vertex, float weight);
  void add_waiting();
  Block& block_of(int first, int second);

  const WireColumns& columns_;
  std::vector<Segment> segments_;
  std::vector<int> first_segment_;  ///< per wire
  std::vector<int> block_at_;       ///< per two segments: one of `blocks_`, or -1
  std::vector<Block> blocks_;
  std::vector<int> touched_;  ///< blocks with pairs that wait
  std::vector<WireRow> rows_;
  std::vector<short> firsts_;  ///< per row: first of its four control points
  std::vector<int> row_segments_;
};

Moments::Moments(const WireField& field, const WireColumns& columns,
                 const std::vector<std::vector<float>>& weights)
    : columns_(columns) {
  for (std::size_t w = 0; w < columns.turns.size(); ++w) {
    first_segment_.push_back(static_cast<int>(segments_.size()));
    const int count = std::max(1, columns.turn_count_of(static_cast<int>(w)) - 3);
    for (int t = 0; t < count; ++t) segments_.push_back({static_cast<int>(w), t});
  }
  block_at_.assign(segments_.size() * segments_.size(), -1);
  for (std::size_t part = 0; part < weights.size(); ++part) {
    const std::size_t count = field.parts()[part].vertices.size();
    for (std::size_t v = 0; v < count; ++v) {
      add_vertex(field.parts()[part], v, weights[part][v]);
      if ((v + 1) % vertices_together == 0 || v + 1 == count) add_waiting();
    }
  }
}

Block& Moments::block_of(int first, int second) {
  int& at = block_at_[static_cast<std::size_t>(first) * segments_.size() + second];
  if (at < 0) {
    at = static_cast<int>(blocks_.size());
    blocks_.emplace_back(columns_, segments_[first], segments_[second], first == second);
  }
  if (blocks_[at].waiting.empty()) touched_.push_back(at);
  return blocks_[at];
}

void Moments::add_vertex(const WireField::PartRows& part, std::size_t vertex, float weight) {
  const double root = std::sqrt(static_cast<double>(weight));
  for (int e = part.offsets[vertex]; e < part.offsets[vertex + 1]; ++e) {
    const WireField::Entry& entry = part.entries[e];
    WireRow& row = rows_.emplace_back();
    for (int a = 0; a < 4; ++a) row.basis[a] = root * entry.basis[a];
    for (int k = 0; k < 3; ++k) row.coupled[k] = root * entry.offset[k];
    for (int a = 0; a < 4; ++a)
      for (int k = 0; k < 3; ++k) row.coupled[3 + 3 * a + k] = entry.turn_basis[a] * row.coupled[k];
    row.coupled[15] = 0;
    firsts_.push_back(entry.first);
    row_segments_.push_back(first_segment_[entry.wire] + entry.turn_first);
  }
  const int end = static_cast<int>(rows_.size()),
            begin = end - (part.offsets[vertex + 1] - part.offsets[vertex]);
  for (int i = begin; i < end; ++i)
    for (int j = i; j < end; ++j) block_of(row_segments_[i], row_segments_[j]).waiting.push_back({i, j});
}

void Moments::add_waiting() {
  for (const int at : touched_) {
    Block& block = blocks_[at];
    wire_kernels().add_products(rows_.data(), firsts_.data(), block.waiting, block.parts());
    block.waiting.clear();
  }
  touched_.clear();
  rows_.clear();
  firsts_.clear();
  row_segments_.clear();
}

/// e_k x r for sums of r: 3 x 3, row `axis`, column k.
Eigen::Matrix3d turned(const Eigen::Vector3d& r) {
  Eigen::Matrix3d columns;
  columns << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;
  return columns;
}

/// Control points' products with a segment's coupled functions (`sums`: #count x 16) to E.
void add_cross(const double* sums, int control, int count, const WireColumns& columns, const Segment& segment,
               Eigen::MatrixXd& cross) {
  const Eigen::Index q = columns.control_count;
  for (int f = 0; f <= columns.turns[segment.wire]; ++f) {
    const int to = unknown_of(columns, segment, f);
    for (int l = 0; l < count; ++l) {
      const Eigen::Map<const Eigen::Vector3d> r(sums + 16L * l + 3L * f);
      for (int axis = 0; axis < 3; ++axis) {
        if (f > 0)
          cross.row(axis * q + control + l).segment<3>(to) += turned(r).row(axis);
        else
          cross(axis * q + control + l, to) += r[axis];
      }
    }
  }
}

/// The products of two coupled functions' columns, `m` being the sum of r1 r2'.
void add_coupled(const Eigen::Matrix3d& m, bool first_turns, bool second_turns, Eigen::Index row,
                 Eigen::Index column, Eigen::MatrixXd& coupled) {
  const Eigen::Vector3d across(m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0));  // r1 x r2
  if (first_turns && second_turns)  // (e_j x r1) . (e_k x r2) = r1 . r2 [j = k] - r2_j r1_k
    coupled.block<3, 3>(row, column) += m.trace() * Eigen::Matrix3d::Identity() - m.transpose();
  else if (first_turns)
    coupled.block<3, 1>(row, column) += across;
  else if (second_turns)
    coupled.block<1, 3>(row, column) -= across.transpose();
  else
    coupled(row, column) += m.trace();
}

/// One block to D, on and above its diagonal.
void add_coupled(const Block& block, const double* sums, const WireColumns& columns,
                 Eigen::MatrixXd& coupled) {
  using Rows = Eigen::Matrix<double, 16, 16, Eigen::RowMajor>;
  const Eigen::Map<const Rows> all(sums);
  for (int f = 0; f <= columns.turns[block.first.wire]; ++f)
    for (int g = block.same ? f : 0; g <= columns.turns[block.second.wire]; ++g)
      add_coupled(all.block<3, 3>(3 * f, 3 * g), f > 0, g > 0, unknown_of(columns, block.first, f),
                  unknown_of(columns, block.second, g), coupled);
}

}  // namespace

WireColumns::WireColumns(std::span<const Wire> wires) {
  for (const Wire& wire : wires) {
    controls.push_back(control_count);
    coupled.push_back(coupled_count);
    turns.push_back(std::min(4, wire.turn_controls));
    control_count += wire.curve.control_count();
    unknowns.push_back(unknown_count++);
    for (int t = 0; t < wire.turn_controls; ++t) {
      unknowns.push_back(unknown_count);
      unknown_count += 3;
    }
    coupled_count += 1 + wire.turn_controls;
  }
}

WireSystem::WireSystem(const WireField& field, std::span<const Wire> wires,
                       std::vector<std::vector<float>> weights, double ridge)
    : field_(field), columns_(wires), weights_(std::move(weights)) {
  const int q = columns_.control_count, n = columns_.unknown_count;
  Eigen::MatrixXd controls = Eigen::MatrixXd::Zero(q, q), coupled = Eigen::MatrixXd::Zero(n, n),
                  cross = Eigen::MatrixXd::Zero(3 * q, n);
  Moments moments(field, columns_, weights_);
  for (Block& block : moments.blocks()) {
    const WireBlock sums = block.parts();
    const int at_first = columns_.controls[block.first.wire],
              at_second = columns_.controls[block.second.wire];
    controls.block(at_first, at_second, block.controls_first, block.controls_second) +=
        Eigen::Map<const RowMajor>(sums.controls, block.controls_first, block.controls_second);
    add_cross(sums.controls_first, at_first, block.controls_first, columns_, block.second, cross);
    if (!block.same)
      add_cross(sums.controls_second, at_second, block.controls_second, columns_, block.first, cross);
    add_coupled(block, sums.coupled, columns_, coupled);
  }
  controls = Eigen::MatrixXd(controls.selfadjointView<Eigen::Upper>());
  coupled = Eigen::MatrixXd(coupled.selfadjointView<Eigen::Upper>());
  factor(std::move(controls), std::move(cross), std::move(coupled), ridge);
}

void WireSystem::factor(Eigen::MatrixXd controls, Eigen::MatrixXd cross, Eigen::MatrixXd coupled,
                        double ridge) {
  const Eigen::Index q = controls.rows();
  const auto add_ridge = [&](auto diagonal) {
    const double mean = diagonal.size() > 0 ? diagonal.mean() : 0;
    diagonal.array() += mean > 0 ? ridge * mean : 1;
  };
  add_ridge(controls.diagonal());
  add_ridge(coupled.diagonal());
  controls_.compute(controls);
  eliminated_ = std::move(cross);
  for (int axis = 0; axis < 3; ++axis) {
    auto block = eliminated_.middleRows(axis * q, q);
    controls_.matrixL().solveInPlace(block);
  }
  coupled.selfadjointView<Eigen::Lower>().rankUpdate(eliminated_.transpose(), -1);
  schur_.compute(coupled.selfadjointView<Eigen::Lower>());
}

WireVectors WireSystem::zero(Eigen::Index expressions) const {
  return {Eigen::MatrixXd::Zero(columns_.control_count, 3 * expressions),
          Eigen::MatrixXd::Zero(columns_.unknown_count, expressions)};
}

void WireSystem::add(int part, std::span<const int> rows, const PointsD& displacements,
                     Eigen::Index expression, WireVectors& right) const {
  std::vector<WireSlots> slots;
  int spans = 0;
  for (std::size_t w = 0; w < columns_.controls.size(); ++w) {
    WireSlots& slot = slots.emplace_back();
    slot.controls = spans;
    spans += columns_.control_count_of(static_cast<int>(w)) - 3;
    if (columns_.turns[w] == 0) continue;
    slot.turns = spans;
    spans += columns_.turn_count_of(static_cast<int>(w)) - 3;
  }
  std::vector<WireSpan> sums(static_cast<std::size_t>(spans));
  std::vector<double> sigmas(slots.size(), 0);
  const WireField::PartRows& field_rows = field_.parts()[part];
  const auto entries = field_rows.entries.begin();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d displacement = static_cast<double>(weights_[part][rows[i]]) *
                                         displacements.row(static_cast<Eigen::Index>(i)).transpose();
    wire_kernels().add_right(
        {entries + field_rows.offsets[rows[i]], entries + field_rows.offsets[rows[i] + 1]}, slots.data(),
        displacement.data(), {sums.data(), sigmas.data()});
  }
  for (std::size_t w = 0; w < slots.size(); ++w) {
    const int wire = static_cast<int>(w), sigma = columns_.unknowns[columns_.coupled[w]];
    right.coupled(sigma, expression) += sigmas[w];
    for (int span = 0; span + 3 < columns_.control_count_of(wire); ++span)
      right.controls.block<4, 3>(columns_.controls[w] + span, 3 * expression) +=
          Eigen::Map<const Eigen::Matrix<double, 4, 3>>(sums[slots[w].controls + span].x);
    for (int span = 0; span + 3 < columns_.turn_count_of(wire); ++span)
      right.coupled.col(expression).segment<12>(sigma + 1 + 3 * span) +=
          Eigen::Map<const Eigen::Matrix<double, 4, 3>>(sums[slots[w].turns + span].x).transpose().reshaped();
  }
}

WireVectors WireSystem::solve(const WireVectors& right) const {
  const Eigen::Index q = columns_.control_count, count = right.coupled.cols();
  WireVectors result = right;
  controls_.matrixL().solveInPlace(result.controls);
  if (count ==
      1) {  // products with a vector read the factors where they are; those with a matrix copy them first
    for (int axis = 0; axis < 3; ++axis)
      result.coupled.col(0).noalias() -=
          eliminated_.middleRows(axis * q, q).transpose() * result.controls.col(axis);
    schur_.solveInPlace(result.coupled);
    for (int axis = 0; axis < 3; ++axis)
      result.controls.col(axis).noalias() -= eliminated_.middleRows(axis * q, q) * result.coupled.col(0);
    controls_.matrixU().solveInPlace(result.controls);
    return result;
  }
  // Axis by axis: x of all expressions are columns 0, 3, 6 ...
  const auto axis_of = [&](Eigen::MatrixXd& controls, int axis) {
    return Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(controls.data() + axis * q, q, count,
                                                                Eigen::OuterStride<>(3 * q));
  };
  for (int axis = 0; axis < 3; ++axis)
    result.coupled.noalias() -=
        eliminated_.middleRows(axis * q, q).transpose() * axis_of(result.controls, axis);
  schur_.solveInPlace(result.coupled);
  for (int axis = 0; axis < 3; ++axis)
    axis_of(result.controls, axis).noalias() -= eliminated_.middleRows(axis * q, q) * result.coupled;
  controls_.matrixU().solveInPlace(result.controls);
  return result;
}

}  // namespace mien::detail
