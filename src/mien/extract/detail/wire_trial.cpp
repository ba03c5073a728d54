// A few thousand vertices and the principal shapes tell ranges and places apart as well as the whole face does, and make a try cost
// milliseconds. The shapes are all but a thousandth of the energy: good wires leave a hundredth, and which ones do is in the small shapes.
#include "mien/extract/detail/wire_trial.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mien/core/error.h"
#include "mien/deform/wires.h"
#include "mien/extract/detail/deltas.h"
#include "mien/extract/detail/wire_system.h"

namespace mien::detail {
namespace {

constexpr std::size_t sample_size = 3000;
constexpr double kept_energy = 0.999;
/// Sizes of expressions are taken to this power when they are to count nearly alike: wholly alike, faint shapes would be rebuilt at the
/// expense of all others.
constexpr double size_power = 1.0 / 3;

}  // namespace

double measured_range(const Wire& wire) {
  return 4 * *std::max_element(wire.ranges.begin(), wire.ranges.end());
}

std::string twin_name(const std::string& name) {
  const std::pair<const char*, const char*> words[] = {{"Left", "Right"}, {"left", "right"}};
  for (const auto& [left, right] : words) {
    if (const auto at = name.find(left); at != std::string::npos)
      return std::string(name).replace(at, std::string(left).size(), right);
    if (const auto at = name.find(right); at != std::string::npos)
      return std::string(name).replace(at, std::string(right).size(), left);
  }
  std::string twin = name;
  if (name.size() > 2 && (name[name.size() - 2] == '_' || name[name.size() - 2] == '.')) {
    const char side = name.back();
    const std::string from = "LRlr", to = "RLrl";
    if (const auto at = from.find(side); at != std::string::npos) twin.back() = to[at];
  }
  return twin;
}

std::vector<std::vector<std::size_t>> twin_groups(const std::vector<Wire>& wires) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t w = 0; w < wires.size(); ++w) {
    const std::string twin = twin_name(wires[w].name);
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const std::vector<std::size_t>& known) {
      return wires[known.front()].name == twin;
    });
    if (group == groups.end())
      groups.push_back({w});
    else
      group->push_back(w);
  }
  return groups;
}

WireTrial::WireTrial(const Character& character, std::span<const Wire> wires, const WireSolverOptions& solver,
                     bool alike)
    : character_(character), ridge_(solver.ridge) {
  const WireBinder binder(character);
  for (const Wire& wire : wires) distances_.push_back(binder.measure(wire, measured_range(wire)));
  take_sample(character, solver);
  for (std::vector<WireDistances>& list : distances_) keep_sampled(list);
  take_shapes(alike);
}

void WireTrial::take_sample(const Character& character, const WireSolverOptions& solver) {
  std::size_t reached = 0;
  for (const Part& part : character.parts) row_of_.emplace_back(part.mesh.vertex_count(), -1);
  for (const auto& list : distances_)
    for (const WireDistances& d : list)
      for (const int v : d.vertices) reached += row_of_[d.part][v]++ == -1;
  const std::size_t stride = std::max<std::size_t>(1, reached / sample_size);
  std::size_t seen = 0;
  for (std::size_t p = 0; p < row_of_.size(); ++p)
    for (std::size_t v = 0; v < row_of_[p].size(); ++v) {
      const bool taken = row_of_[p][v] >= 0 && seen++ % stride == 0;
      row_of_[p][v] = taken ? static_cast<int>(weights_.size()) : -1;
      if (!taken) continue;
      const bool given = !solver.vertex_weights.empty() && solver.vertex_weights[p].size() > 0;
      weights_.push_back(given ? solver.vertex_weights[p][static_cast<Eigen::Index>(v)] : 1.f);
    }
}

void WireTrial::keep_sampled(std::vector<WireDistances>& list) const {
  for (WireDistances& d : list) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < d.vertices.size(); ++i) {
      if (row_of_[d.part][d.vertices[i]] < 0) continue;
      d.vertices[kept] = d.vertices[i];
      d.distances[kept] = d.distances[i];
      d.parameters[kept++] = d.parameters[i];
    }
    d.vertices.resize(kept);
    d.distances.resize(kept);
    d.parameters.resize(kept);
  }
}

std::vector<WireDistances> WireTrial::measure(const WireBinder& binder, const Wire& wire) const {
  std::vector<WireDistances> list =
      binder.measure(wire, *std::max_element(wire.ranges.begin(), wire.ranges.end()));
  keep_sampled(list);
  return list;
}

void WireTrial::take_shapes(bool alike) {
  const std::vector<Eigen::Matrix3d> to_model = vectors_to_model(character_);
  const auto rows = static_cast<Eigen::Index>(weights_.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * rows, static_cast<Eigen::Index>(character_.shapes.size()));
  for (std::size_t s = 0; s < character_.shapes.size(); ++s)
    for (const PartDelta& delta : character_.shapes[s].parts)
      for (std::size_t i = 0; i < delta.vertices.size(); ++i)
        if (const int row = row_of_[delta.part][delta.vertices[i]]; row >= 0)
          all.col(static_cast<Eigen::Index>(s)).segment<3>(3 * row) =
              to_model[delta.part] *
              delta.deltas.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
  for (Eigen::Index s = 0; s < all.cols(); ++s)
    if (const double size = all.col(s).norm(); alike && size > 0)
      all.col(s) *= std::pow(size, size_power - 1);
  if (all.isZero(0)) throw invalid_input("shapes", "move nothing that the wires reach", "shapes of the face");
  Eigen::MatrixXd weighted = all;
  for (Eigen::Index row = 0; row < rows; ++row) weighted.middleRows<3>(3 * row) *= weights_[row];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(all.transpose() * weighted);
  total_ = eigen.eigenvalues().cwiseMax(0).sum();
  double held = 0;
  for (Eigen::Index k = eigen.eigenvalues().size() - 1; k >= 0 && held < kept_energy * total_; --k) {
    held += eigen.eigenvalues()[k];
    const Eigen::VectorXd shape = all * eigen.eigenvectors().col(k);
    shapes_.push_back(Eigen::Map<const PointsD>(shape.data(), rows, 3));
  }
}

double WireTrial::left_over(const std::vector<Wire>& wires) const {
  const WireField field(character_, wires);
  std::vector<std::vector<float>> row_weights;
  for (std::size_t p = 0; p < field.parts().size(); ++p) {
    row_weights.emplace_back();
    for (const int v : field.parts()[p].vertices) row_weights.back().push_back(weights_[row_of_[p][v]]);
  }
  const WireSystem system(field, wires, row_weights, ridge_);
  WireVectors right = system.zero(static_cast<Eigen::Index>(shapes_.size()));
  for (std::size_t p = 0; p < field.parts().size(); ++p) {
    const std::vector<int>& vertices = field.parts()[p].vertices;
    std::vector<int> rows(vertices.size());
    std::iota(rows.begin(), rows.end(), 0);
    PointsD wanted(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      for (std::size_t row = 0; row < rows.size(); ++row)
        wanted.row(static_cast<Eigen::Index>(row)) = shapes_[s].row(row_of_[p][vertices[row]]);
      system.add(static_cast<int>(p), rows, wanted, static_cast<Eigen::Index>(s), right);
    }
  }
  const WireVectors found = system.solve(right);
  const double explained =
      found.controls.cwiseProduct(right.controls).sum() + found.coupled.cwiseProduct(right.coupled).sum();
  return std::sqrt(std::max(0.0, 1 - explained / total_));
}

}  // namespace mien::detail
