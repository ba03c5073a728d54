// Columns of a turn are e x r. Their products with everything else are sums of c1 c2 r1 r2' over the vertices, so those moments
// are gathered (9 numbers a pair of basis functions) and spread over the unknowns afterwards: a third of the work of
// multiplying columns.
#include "mien/extract/detail/wire_system.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace mien::detail {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// v -> axis x v as a matrix.
Eigen::Matrix3d cross(int axis) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (int column = 0; column < 3; ++column)
    matrix.col(column) = Eigen::Vector3d::Unit(axis).cross(Eigen::Vector3d::Unit(column));
  return matrix;
}

struct Moments {
  Matrix controls;              ///< sum of B B
  std::vector<double> cross;    ///< per (control point, coupled function): sum of B c r, 3 numbers
  std::vector<double> coupled;  ///< per pair of coupled functions: sum of c1 c2 r1 r2', 9 numbers
};

/// One vertex's hold of one wire, unfolded.
struct Terms {
  int control = 0, coupled = 0, turn = 0, turns = 0;
  const WireField::Entry* entry = nullptr;
  double weight = 1;
  Eigen::Vector3d offset;
  /// Value and index of the a-th coupled function: sigma first, then up to four turns.
  double value(int a) const { return a == 0 ? 1.0 : entry->turn_basis[a - 1]; }
  int index(int a) const { return a == 0 ? coupled : coupled + turn + a; }
};

void add_pair(const Terms& first, const Terms& second, const WireColumns& columns, Moments& moments) {
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b)
      moments.controls(first.control + a, second.control + b) +=
          first.weight * first.entry->basis[a] * second.entry->basis[b];
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b <= second.turns; ++b) {
      const double weight = first.weight * first.entry->basis[a] * second.value(b);
      double* sum = &moments.cross[3 * (static_cast<std::size_t>(first.control + a) * columns.coupled_count +
                                        second.index(b))];
      for (int k = 0; k < 3; ++k) sum[k] += weight * second.offset[k];
    }
  if (first.coupled > second.coupled) return;
  double outer[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) outer[3 * i + j] = first.weight * first.offset[i] * second.offset[j];
  for (int a = 0; a <= first.turns; ++a)
    for (int b = 0; b <= second.turns; ++b) {
      const double weight = first.value(a) * second.value(b);
      double* sum = &moments.coupled[9 * (static_cast<std::size_t>(first.index(a)) * columns.coupled_count +
                                          second.index(b))];
      for (int k = 0; k < 9; ++k) sum[k] += weight * outer[k];
    }
}

Moments gather(const WireField& field, const WireColumns& columns, const std::vector<int>& turns,
               const std::vector<std::vector<float>>& weights) {
  Moments moments;
  const auto q = static_cast<std::size_t>(columns.control_count),
             b = static_cast<std::size_t>(columns.coupled_count);
  moments.controls = Matrix::Zero(columns.control_count, columns.control_count);
  moments.cross.assign(3 * q * b, 0);
  moments.coupled.assign(9 * b * b, 0);
  std::vector<Terms> terms;
  for (std::size_t part = 0; part < weights.size(); ++part) {
    const WireField::PartRows& rows = field.parts()[part];
    for (std::size_t row = 0; row < rows.vertices.size(); ++row) {
      terms.clear();
      for (int e = rows.offsets[row]; e < rows.offsets[row + 1]; ++e) {
        const WireField::Entry& entry = rows.entries[e];
        terms.push_back({columns.controls[entry.wire] + entry.first, columns.coupled[entry.wire],
                         entry.turn_first, turns[entry.wire], &entry, weights[part][row],
                         entry.offset.cast<double>()});
      }
      for (const Terms& first : terms)
        for (const Terms& second : terms) add_pair(first, second, columns, moments);
    }
  }
  return moments;
}

/// The columns that a coupled function stands for, as 3 x 3 (turn) or 1 x 3 (sigma) maps of its offset: v' = map r.
struct Maps {
  Maps() {
    for (int axis = 0; axis < 3; ++axis) turn[axis] = cross(axis);
  }
  const Eigen::Matrix3d& of(bool is_turn, int k) const { return is_turn ? turn[k] : identity; }
  Eigen::Matrix3d identity = Eigen::Matrix3d::Identity(), turn[3];
};

}  // namespace

WireColumns::WireColumns(std::span<const Wire> wires) {
  for (const Wire& wire : wires) {
    controls.push_back(control_count);
    coupled.push_back(coupled_count);
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
  for (const Wire& wire : wires) turns_.push_back(std::min(4, wire.turn_controls));
  const Moments moments = gather(field, columns_, turns_, weights_);
  const int q = columns_.control_count, n = columns_.unknown_count, b = columns_.coupled_count;
  const Maps maps;
  std::vector<char> is_turn(b, 1);
  for (const int sigma : columns_.coupled) is_turn[sigma] = 0;
  Eigen::MatrixXd controls = moments.controls, coupled = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(3 * q, n);
  for (int second = 0; second < b; ++second)
    for (int k = 0; k < (is_turn[second] ? 3 : 1); ++k) {
      const Eigen::Matrix3d& map = maps.of(is_turn[second], k);
      const int column = columns_.unknowns[second] + k;
      for (int l = 0; l < q; ++l) {
        const Eigen::Map<const Eigen::Vector3d> moment(
            &moments.cross[3 * (static_cast<std::size_t>(l) * b + second)]);
        const Eigen::Vector3d value = map * moment;
        for (int axis = 0; axis < 3; ++axis) cross(axis * q + l, column) = value[axis];
      }
      for (int first = 0; first < b; ++first) {
        const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> moment(
            &moments.coupled[9 * (static_cast<std::size_t>(first) * b + second)]);
        for (int j = 0; j < (is_turn[first] ? 3 : 1); ++j)  // (map1 r1) . (map2 r2) = map1 : (map2 (r1 r2')')
          coupled(columns_.unknowns[first] + j, column) =
              maps.of(is_turn[first], j).cwiseProduct(map * moment.transpose()).sum();
      }
    }
  coupled = coupled.selfadjointView<Eigen::Upper>();
  factor(std::move(controls), cross, std::move(coupled), ridge);
}

void WireSystem::factor(Eigen::MatrixXd controls, const Eigen::MatrixXd& cross, Eigen::MatrixXd coupled,
                        double ridge) {
  const Eigen::Index q = controls.rows();
  const auto add_ridge = [&](auto diagonal) {
    const double mean = diagonal.size() > 0 ? diagonal.mean() : 0;
    diagonal.array() += mean > 0 ? ridge * mean : 1;
  };
  add_ridge(controls.diagonal());
  add_ridge(coupled.diagonal());
  controls_.compute(controls);
  eliminated_.resize(cross.rows(), cross.cols());
  for (int axis = 0; axis < 3; ++axis)
    eliminated_.middleRows(axis * q, q) = controls_.solve(cross.middleRows(axis * q, q));
  schur_.compute(coupled - cross.transpose() * eliminated_);
}

WireVector WireSystem::zero() const {
  return {PointsD::Zero(columns_.control_count, 3), Eigen::VectorXd::Zero(columns_.unknown_count)};
}

void WireSystem::add(int part, int row, const Eigen::Vector3d& wanted, WireVector& right) const {
  const Eigen::Vector3d displacement = static_cast<double>(weights_[part][row]) * wanted;
  const WireField::PartRows& rows = field_.parts()[part];
  for (int e = rows.offsets[row]; e < rows.offsets[row + 1]; ++e) {
    const WireField::Entry& entry = rows.entries[e];
    const int control = columns_.controls[entry.wire] + entry.first, sigma = columns_.coupled[entry.wire];
    for (int a = 0; a < 4; ++a) right.controls.row(control + a) += entry.basis[a] * displacement.transpose();
    const Eigen::Vector3d offset = entry.offset.cast<double>(), moment = offset.cross(displacement);
    right.coupled[columns_.unknowns[sigma]] += offset.dot(displacement);
    for (int a = 0; a < turns_[entry.wire]; ++a)
      right.coupled.segment<3>(columns_.unknowns[sigma + 1 + entry.turn_first + a]) +=
          entry.turn_basis[a] * moment;
  }
}

WireVector WireSystem::solve(const WireVector& right) const {
  WireVector result = zero();
  const Eigen::MatrixXd g = right.controls;  // column major: axes one after the other
  const Eigen::Map<const Eigen::VectorXd> stacked(g.data(), g.size());
  result.coupled = schur_.solve(right.coupled - eliminated_.transpose() * stacked);
  const Eigen::VectorXd taken = eliminated_ * result.coupled;
  result.controls = controls_.solve(g) - Eigen::Map<const Eigen::MatrixXd>(taken.data(), g.rows(), 3);
  return result;
}

}  // namespace mien::detail
