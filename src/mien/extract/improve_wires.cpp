// Of the ways to find ranges, gradients were left aside: a falloff's derivative vanishes where the range ends, so far-off better
// ranges are not seen. Factors of two, then smaller ones, tried wire by wire, find them; the sample and the principal shapes
// make a try cost milliseconds.
#include "mien/extract/improve_wires.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/bind_wires.h"
#include "mien/deform/wires.h"
#include "mien/extract/detail/pieces.h"
#include "mien/extract/detail/wire_system.h"

namespace mien {
namespace {

constexpr std::size_t sample_size = 3000;
constexpr double kept_energy = 0.95;
constexpr double longest_factor = 4;  ///< of a wire's range at the start: as far as distances are measured
constexpr int varying_ranges = 4;

/// `name` with its side exchanged, or itself.
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

/// The sample of vertices on which candidates are tried, and the principal shapes there.
struct Trial {
  Trial(const Character& character, std::span<const Wire> wires, const ImproveOptions& options);
  /// What wires with these bindings leave of the displacements, of 1.
  double left_over(const Character& character, const std::vector<Wire>& wires, double ridge) const;

  std::vector<std::vector<WireDistances>> distances;  ///< per wire, on the sample
  std::vector<std::vector<int>> row_of;  ///< per part and vertex: row of `shapes`, -1: not in the sample
  std::vector<float> weights;            ///< per row
  std::vector<PointsD> shapes;           ///< principal shapes, one row a sampled vertex
  double total = 0;                      ///< weighted sum of squares of all shapes
};

Trial::Trial(const Character& character, std::span<const Wire> wires, const ImproveOptions& options) {
  const WireSolverOptions& solver = options.solver;
  const WireBinder binder(character);
  for (const Wire& wire : wires)
    distances.push_back(
        binder.measure(wire, longest_factor * *std::max_element(wire.ranges.begin(), wire.ranges.end())));
  std::size_t reached = 0;
  for (const Part& part : character.parts) row_of.emplace_back(part.mesh.vertex_count(), -1);
  for (const auto& list : distances)
    for (const WireDistances& d : list)
      for (const int v : d.vertices) reached += row_of[d.part][v]++ == -1;
  const std::size_t stride = std::max<std::size_t>(1, reached / sample_size);
  std::size_t seen = 0;
  for (std::size_t p = 0; p < row_of.size(); ++p)
    for (std::size_t v = 0; v < row_of[p].size(); ++v) {
      const bool taken = row_of[p][v] >= 0 && seen++ % stride == 0;
      row_of[p][v] = taken ? static_cast<int>(weights.size()) : -1;
      if (!taken) continue;
      const bool given = !solver.vertex_weights.empty() && solver.vertex_weights[p].size() > 0;
      weights.push_back(given ? solver.vertex_weights[p][static_cast<Eigen::Index>(v)] : 1.f);
    }
  for (auto& list : distances)
    for (WireDistances& d : list) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < d.vertices.size(); ++i) {
        if (row_of[d.part][d.vertices[i]] < 0) continue;
        d.vertices[kept] = d.vertices[i];
        d.distances[kept] = d.distances[i];
        d.parameters[kept++] = d.parameters[i];
      }
      d.vertices.resize(kept);
      d.distances.resize(kept);
      d.parameters.resize(kept);
    }
  const auto rows = static_cast<Eigen::Index>(weights.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * rows, static_cast<Eigen::Index>(character.shapes.size()));
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    for (const PartDelta& delta : character.shapes[s].parts)
      for (std::size_t i = 0; i < delta.vertices.size(); ++i)
        if (const int row = row_of[delta.part][delta.vertices[i]]; row >= 0)
          all.col(static_cast<Eigen::Index>(s)).segment<3>(3 * row) =
              delta.deltas.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
  // Every expression counts alike, however small: by size lids would get the ranges that suit the jaw.
  for (Eigen::Index s = 0; s < all.cols(); ++s)
    if (const double size = all.col(s).norm(); options.alike && size > 0) all.col(s) /= size;
  Eigen::MatrixXd weighted = all;
  for (Eigen::Index row = 0; row < rows; ++row) weighted.middleRows<3>(3 * row) *= weights[row];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(all.transpose() * weighted);
  total = eigen.eigenvalues().cwiseMax(0).sum();
  if (!(total > 0)) throw invalid_input("shapes", "move nothing that the wires reach", "shapes of the face");
  double held = 0;
  for (Eigen::Index k = eigen.eigenvalues().size() - 1; k >= 0 && held < kept_energy * total; --k) {
    held += eigen.eigenvalues()[k];
    const Eigen::VectorXd shape = all * eigen.eigenvectors().col(k);
    shapes.push_back(Eigen::Map<const PointsD>(shape.data(), rows, 3));
  }
}

double Trial::left_over(const Character& character, const std::vector<Wire>& wires, double ridge) const {
  const WireField field(character, wires);
  std::vector<std::vector<float>> row_weights;
  for (std::size_t p = 0; p < field.parts().size(); ++p) {
    row_weights.emplace_back();
    for (const int v : field.parts()[p].vertices) row_weights.back().push_back(weights[row_of[p][v]]);
  }
  const detail::WireSystem system(field, wires, row_weights, ridge);
  double explained = 0;
  for (const PointsD& shape : shapes) {
    detail::WireVector right = system.zero();
    for (std::size_t p = 0; p < field.parts().size(); ++p) {
      const std::vector<int>& vertices = field.parts()[p].vertices;
      for (std::size_t row = 0; row < vertices.size(); ++row)
        system.add(static_cast<int>(p), static_cast<int>(row),
                   shape.row(row_of[p][vertices[row]]).transpose(), right);
    }
    const detail::WireVector found = system.solve(right);
    explained += found.controls.cwiseProduct(right.controls).sum() + found.coupled.dot(right.coupled);
  }
  return std::sqrt(std::max(0.0, 1 - explained / total));
}

/// Wires whose ranges are tried; twins share one.
class RangeSearch {
 public:
  RangeSearch(const Character& character, std::span<const Wire> wires, const ImproveOptions& options)
      : character_(character),
        options_(options),
        trial_(character, wires, options),
        wires_(wires.begin(), wires.end()) {
    for (std::size_t w = 0; w < wires_.size(); ++w) {
      longest_.push_back(longest_factor *
                         *std::max_element(wires_[w].ranges.begin(), wires_[w].ranges.end()));
      const std::string twin = twin_name(wires_[w].name);
      const auto first = std::find_if(wires_.begin(), wires_.begin() + static_cast<std::ptrdiff_t>(w),
                                      [&](const Wire& wire) { return wire.name == twin; });
      const auto leader = static_cast<std::size_t>(first - wires_.begin());
      if (leader < w) {
        if (std::find(options_.fixed.begin(), options_.fixed.end(), wires_[w].name) == options_.fixed.end())
          wires_[w].ranges = wires_[leader].ranges;
        groups_[group_of_[leader]].push_back(w);
      } else
        groups_.push_back({w});
      bind(wires_, w);
      group_of_.push_back(leader < w ? group_of_[leader] : groups_.size() - 1);
    }
    best_ = trial_.left_over(character_, wires_, options_.solver.ridge);
  }

  double best() const { return best_; }
  std::size_t groups() const { return groups_.size(); }
  std::vector<Wire> take() { return std::move(wires_); }

  /// Tries the factors on one group's ranges, or on the `value`-th of them.
  void try_factors(std::size_t group, int value, std::span<const double> factors) {
    for (const std::size_t w : groups_[group])
      if (std::find(options_.fixed.begin(), options_.fixed.end(), wires_[w].name) != options_.fixed.end())
        return;
    std::vector<double> left(factors.size());
    std::vector<std::vector<Wire>> candidates(factors.size(), wires_);
    parallel_for(factors.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        for (const std::size_t w : groups_[group]) {
          std::vector<double>& ranges = candidates[f][w].ranges;
          for (std::size_t k = 0; k < ranges.size(); ++k)
            if (value < 0 || value == static_cast<int>(k))
              ranges[k] = std::min(ranges[k] * factors[f], longest_[w]);
          bind(candidates[f], w);
        }
        left[f] = trial_.left_over(character_, candidates[f], options_.solver.ridge);
      }
    });
    const auto least = std::min_element(left.begin(), left.end());
    if (!(*least < best_ * (1 - 1e-4))) return;
    best_ = *least;
    wires_ = std::move(candidates[static_cast<std::size_t>(least - left.begin())]);
  }

  void let_ranges_vary() {
    for (Wire& wire : wires_)
      if (wire.ranges.size() == 1) wire.ranges.assign(varying_ranges, wire.ranges[0]);
  }
  std::size_t values(std::size_t group) const { return wires_[groups_[group][0]].ranges.size(); }

 private:
  void bind(std::vector<Wire>& wires, std::size_t w) const {
    wires[w].bindings = bindings_of(wires[w], trial_.distances[w]);
  }
  const Character& character_;
  const ImproveOptions& options_;
  Trial trial_;
  std::vector<Wire> wires_;
  std::vector<double> longest_;
  std::vector<std::vector<std::size_t>> groups_;
  std::vector<std::size_t> group_of_;
  double best_ = 0;
};

}  // namespace

ImproveResult improve_wires(const Character& character, std::span<const Wire> wires,
                            const ImproveOptions& options) {
  if (wires.empty()) throw invalid_input("wires", "are none", "one or more");
  RangeSearch search(character, wires, options);
  ImproveResult result;
  result.before = search.best();
  const int steps = std::max(1, options.sweeps + (options.varying ? 2 : 0));
  for (int sweep = 0; sweep < options.sweeps; ++sweep)
    for (std::size_t group = 0; group < search.groups(); ++group) {
      report_progress(options.progress, "ranges",
                      (sweep + static_cast<double>(group) / search.groups()) / steps);
      const double step = std::pow(2, std::pow(0.5, sweep));  // 2, 1.41, 1.19, ...
      const double factors[] = {1 / step, 1 / std::sqrt(step), std::sqrt(step), step};
      search.try_factors(group, -1, factors);
    }
  if (options.varying) {
    search.let_ranges_vary();
    for (std::size_t group = 0; group < search.groups(); ++group)
      for (std::size_t value = 0; value < search.values(group); ++value) {
        report_progress(options.progress, "ranges along the wires",
                        (options.sweeps + 2.0 * static_cast<double>(group) / search.groups()) / steps);
        const double factors[] = {0.7, 1.4};
        search.try_factors(group, static_cast<int>(value), factors);
      }
  }
  result.after = search.best();
  result.wires = bind_wires(character, search.take());
  return result;
}

}  // namespace mien
