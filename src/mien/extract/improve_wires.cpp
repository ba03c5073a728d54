// Of the ways to find ranges, gradients were left aside: a falloff's derivative vanishes where the range ends, so far-off better
// ranges are not seen. Factors of two, then smaller ones, tried wire by wire, find them; the sample and the principal shapes
// make a try cost milliseconds.
#include "mien/extract/improve_wires.h"

#include <algorithm>
#include <cmath>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/bind_wires.h"
#include "mien/extract/detail/wire_trial.h"

namespace mien {
namespace {

constexpr int varying_ranges = 4;
/// What suits a wire depends on its neighbours, so a sweep goes round again as long as a round takes this part of the error away.
constexpr double least_gain = 0.002;
constexpr int most_rounds = 8;

/// Wires whose ranges are tried; twins share one.
class RangeSearch {
 public:
  RangeSearch(const Character& character, std::span<const Wire> wires, const ImproveOptions& options)
      : options_(options),
        trial_(character, wires, options.solver, options.alike),
        wires_(wires.begin(), wires.end()),
        groups_(detail::twin_groups(wires_)) {
    for (const std::vector<std::size_t>& group : groups_)
      for (const std::size_t w : group)
        if (!is_fixed(wires_[w].name)) wires_[w].ranges = wires_[group.front()].ranges;
    for (std::size_t w = 0; w < wires_.size(); ++w) {
      longest_.push_back(detail::measured_range(wires[w]));
      bind(wires_, w);
    }
    best_ = trial_.left_over(wires_);
  }

  double best() const { return best_; }
  std::size_t groups() const { return groups_.size(); }
  std::vector<Wire> take() { return std::move(wires_); }

  /// Tries the factors on one group's ranges, or on the `value`-th of them.
  void try_factors(std::size_t group, int value, std::span<const double> factors) {
    for (const std::size_t w : groups_[group])
      if (is_fixed(wires_[w].name)) return;
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
        left[f] = trial_.left_over(candidates[f]);
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
  bool is_fixed(const std::string& name) const {
    return std::find(options_.fixed.begin(), options_.fixed.end(), name) != options_.fixed.end();
  }
  void bind(std::vector<Wire>& wires, std::size_t w) const {
    wires[w].bindings = bindings_of(wires[w], trial_.distances(w));
  }
  const ImproveOptions& options_;
  detail::WireTrial trial_;
  std::vector<Wire> wires_;
  std::vector<std::vector<std::size_t>> groups_;
  std::vector<double> longest_;
  double best_ = 0;
};

template <typename Round>
void while_it_gains(const RangeSearch& search, const Round& round) {
  for (int rounds = 0; rounds < most_rounds; ++rounds) {
    const double before = search.best();
    round();
    if (search.best() > (1 - least_gain) * before) return;
  }
}

}  // namespace

ImproveResult improve_wires(const Character& character, std::span<const Wire> wires,
                            const ImproveOptions& options) {
  if (wires.empty()) throw invalid_input("wires", "are none", "one or more");
  RangeSearch search(character, wires, options);
  ImproveResult result;
  result.before = search.best();
  const int steps = std::max(1, options.sweeps + (options.varying ? 2 : 0));
  for (int sweep = 0; sweep < options.sweeps; ++sweep)
    while_it_gains(search, [&] {
      for (std::size_t group = 0; group < search.groups(); ++group) {
        report_progress(options.progress, "ranges",
                        (sweep + static_cast<double>(group) / search.groups()) / steps);
        const double step = std::pow(2, std::pow(0.5, sweep));  // 2, 1.41, 1.19, ...
        const double factors[] = {1 / step, 1 / std::sqrt(step), std::sqrt(step), step};
        search.try_factors(group, -1, factors);
      }
    });
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
