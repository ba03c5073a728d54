// Columns of a turn are e x r. Their products with everything else are sums of c1 c2 r1 r2' over the vertices, so those moments
// are gathered first, wire by wire and for all that share vertices with it, and spread over the unknowns afterwards: a third of the
// work of multiplying the columns themselves.
#include "mien/extract/detail/wire_system.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mien/extract/detail/wire_kernels.h"

namespace mien::detail {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Where a coupled function's three columns of Z begin.
Eigen::Index moment_column(const WireColumns& columns, int coupled) {
  return columns.control_count + 3 * static_cast<Eigen::Index>(coupled);
}

/// The field's entries as rows, and the segment of each: a wire and the first of the four turns that meet there.
struct Rows {
  Rows(const WireField& field, const WireColumns& columns, const std::vector<std::vector<float>>& weights);
  std::vector<WireRow> rows;
  std::vector<short> firsts;       ///< per row: first of its four control points
  std::vector<int> segments, end;  ///< per row: its segment; where the entries of its vertex end
  struct Segment {
    int wire = 0, turn_first = 0;
    std::vector<int> rows;
  };
  std::vector<Segment> all;
};

Rows::Rows(const WireField& field, const WireColumns& columns,
           const std::vector<std::vector<float>>& weights) {
  std::vector<int> first_segment;
  for (std::size_t w = 0; w < columns.turns.size(); ++w) {
    first_segment.push_back(static_cast<int>(all.size()));
    const int count = std::max(1, columns.turn_count_of(static_cast<int>(w)) - 3);
    for (int t = 0; t < count; ++t) all.push_back({static_cast<int>(w), t, {}});
  }
  std::size_t count = 0;
  for (const WireField::PartRows& part : field.parts()) count += part.entries.size();
  rows.reserve(count);
  for (std::size_t part = 0; part < weights.size(); ++part) {
    const WireField::PartRows& source = field.parts()[part];
    for (std::size_t v = 0; v < source.vertices.size(); ++v) {
      const double root = std::sqrt(static_cast<double>(weights[part][v]));
      const int count = source.offsets[v + 1] - source.offsets[v];
      const int last = static_cast<int>(rows.size()) + count;
      for (int e = source.offsets[v]; e < source.offsets[v + 1]; ++e) {
        const WireField::Entry& entry = source.entries[e];
        WireRow& row = rows.emplace_back();
        for (int a = 0; a < 4; ++a) row.basis[a] = root * entry.basis[a];
        for (int k = 0; k < 3; ++k) row.coupled[k] = root * entry.offset[k];
        for (int a = 0; a < 4; ++a)
          for (int k = 0; k < 3; ++k) row.coupled[3 + 3 * a + k] = entry.turn_basis[a] * row.coupled[k];
        row.coupled[15] = 0;
        firsts.push_back(entry.first);
        segments.push_back(first_segment[entry.wire] + entry.turn_first);
        all[segments.back()].rows.push_back(static_cast<int>(rows.size()) - 1);
        end.push_back(last);
      }
    }
  }
}

/// Adds one pair of segments to Z'WZ, on and above the diagonal of each of its blocks.
void add_block(const Rows& rows, int first, int second, const WireColumns& columns,
               std::span<const WirePair> pairs, Matrix& moments) {
  const Rows::Segment &a = rows.all[first], &b = rows.all[second];
  const int controls_a = columns.control_count_of(a.wire), controls_b = columns.control_count_of(b.wire);
  Matrix coupled = Matrix::Zero(16, 16), first_coupled = Matrix::Zero(controls_a, 16),
         second_coupled = Matrix::Zero(controls_b, 16), controls = Matrix::Zero(controls_a, controls_b);
  wire_kernels().add_products(
      rows.rows.data(), rows.firsts.data(), pairs,
      {coupled.data(), first_coupled.data(), second_coupled.data(), controls.data(), controls.cols()});
  const Eigen::Index at_a = columns.controls[a.wire], at_b = columns.controls[b.wire];
  moments.block(at_a, at_b, controls_a, controls_b) += controls;
  const auto column_of = [&](const Rows::Segment& segment, int function) {
    const int sigma = columns.coupled[segment.wire];
    return moment_column(columns, function == 0 ? sigma : sigma + segment.turn_first + function);
  };
  const int functions_a = columns.turns[a.wire] + 1, functions_b = columns.turns[b.wire] + 1;
  for (int f = 0; f < functions_b; ++f)
    moments.block(at_a, column_of(b, f), controls_a, 3) += first_coupled.middleCols(3 * f, 3);
  if (first != second)
    for (int f = 0; f < functions_a; ++f)
      moments.block(at_b, column_of(a, f), controls_b, 3) += second_coupled.middleCols(3 * f, 3);
  for (int f = 0; f < functions_a; ++f)
    for (int g = 0; g < functions_b; ++g) {
      const Eigen::Index row = column_of(a, f), column = column_of(b, g);
      if (row <= column) moments.block<3, 3>(row, column) += coupled.block<3, 3>(3 * f, 3 * g);
    }
}

/// Z'WZ, on and above the diagonal.
Matrix moments_of(const WireField& field, const WireColumns& columns,
                  const std::vector<std::vector<float>>& weights) {
  const Eigen::Index size = moment_column(columns, columns.coupled_count);
  Matrix moments = Matrix::Zero(size, size);
  const Rows rows(field, columns, weights);
  std::vector<std::vector<WirePair>> pairs(rows.all.size());
  for (std::size_t segment = 0; segment < rows.all.size(); ++segment) {
    for (const int row : rows.all[segment].rows)
      for (int other = row; other < rows.end[row]; ++other)
        pairs[rows.segments[other]].push_back({row, other});
    for (std::size_t other = segment; other < pairs.size(); ++other) {
      if (pairs[other].empty()) continue;
      add_block(rows, static_cast<int>(segment), static_cast<int>(other), columns, pairs[other], moments);
      pairs[other].clear();
    }
  }
  return moments;
}

/// e_k x r for sums of r: #3 x 3, row `axis`, column k.
Eigen::Matrix3d turned(const Eigen::Vector3d& r) {
  Eigen::Matrix3d columns;
  columns << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;
  return columns;
}

/// What the products of two coupled functions' columns are, m being the sum of r1 r2'.
void set_coupled(const Eigen::Matrix3d& m, bool first_turns, bool second_turns, Eigen::Index row,
                 Eigen::Index column, Eigen::MatrixXd& coupled) {
  const Eigen::Vector3d across(m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0));  // r1 x r2
  if (first_turns && second_turns)  // (e_j x r1) . (e_k x r2) = r1 . r2 [j = k] - r2_j r1_k
    coupled.block<3, 3>(row, column) = m.trace() * Eigen::Matrix3d::Identity() - m.transpose();
  else if (first_turns)
    coupled.block<3, 1>(row, column) = across;
  else if (second_turns)
    coupled.block<1, 3>(row, column) = -across.transpose();
  else
    coupled(row, column) = m.trace();
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
  const Matrix moments = moments_of(field, columns_, weights_);
  const int q = columns_.control_count, n = columns_.unknown_count, b = columns_.coupled_count;
  std::vector<char> turns(b, 1);
  for (const int sigma : columns_.coupled) turns[sigma] = 0;
  Eigen::MatrixXd controls = moments.topLeftCorner(q, q), coupled = Eigen::MatrixXd::Zero(n, n),
                  cross = Eigen::MatrixXd::Zero(3 * q, n);
  controls.triangularView<Eigen::StrictlyLower>() = controls.transpose();
  for (int second = 0; second < b; ++second) {
    const Eigen::Index from = moment_column(columns_, second), to = columns_.unknowns[second];
    for (int l = 0; l < q; ++l) {
      const Eigen::Vector3d r = moments.row(l).segment<3>(from).transpose();
      for (int axis = 0; axis < 3; ++axis) {
        if (turns[second])
          cross.row(axis * q + l).segment<3>(to) = turned(r).row(axis);
        else
          cross(axis * q + l, to) = r[axis];
      }
    }
    for (int first = 0; first <= second; ++first)
      set_coupled(moments.block<3, 3>(moment_column(columns_, first), from), turns[first], turns[second],
                  columns_.unknowns[first], to, coupled);
  }
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
  const int q = columns_.control_count, b = columns_.coupled_count;
  std::vector<WireSlots> slots;
  for (std::size_t w = 0; w < columns_.controls.size(); ++w)
    slots.push_back({columns_.controls[w], q + columns_.coupled[w], columns_.turns[w] > 0});
  std::vector<double> sums(4 * static_cast<std::size_t>(q + b),
                           0);  // four a control point or coupled function
  const WireField::PartRows& field_rows = field_.parts()[part];
  const auto entries = field_rows.entries.begin();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d displacement = static_cast<double>(weights_[part][rows[i]]) *
                                         displacements.row(static_cast<Eigen::Index>(i)).transpose();
    wire_kernels().add_right(
        {entries + field_rows.offsets[rows[i]], entries + field_rows.offsets[rows[i] + 1]}, slots.data(),
        displacement.data(), sums.data());
  }
  for (int l = 0; l < q; ++l)
    for (int k = 0; k < 3; ++k) right.controls(l, 3 * expression + k) += sums[4 * l + k];
  for (int f = 0; f < b; ++f) {
    const int unknown = columns_.unknowns[f],
              next = f + 1 < b ? columns_.unknowns[f + 1] : columns_.unknown_count;
    for (int k = 0; unknown + k < next; ++k) right.coupled(unknown + k, expression) += sums[4 * (q + f) + k];
  }
}

WireVectors WireSystem::solve(const WireVectors& right) const {
  const Eigen::Index q = columns_.control_count, count = right.coupled.cols();
  WireVectors result = right;
  controls_.matrixL().solveInPlace(result.controls);
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
