#include "mien/pose/detail/slider_map.h"

#include <algorithm>
#include <cmath>

namespace mien::detail {
namespace {

// The rules of sliders.h: from inputs u >= 0 the corrective's weight, and its slopes by each.
double product(int n, const double* u, double* slopes) {
  double weight = 1;
  for (int i = 0; i < n; ++i) weight *= u[i];
  for (int i = 0; i < n; ++i) {
    slopes[i] = 1;
    for (int k = 0; k < n; ++k)
      if (k != i) slopes[i] *= u[k];
  }
  return weight;
}

double smallest(int n, const double* u, double* slopes) {
  const double least = *std::min_element(u, u + n);
  const auto ties = static_cast<double>(std::count(u, u + n, least));
  for (int i = 0; i < n; ++i) slopes[i] = u[i] == least ? 1 / ties : 0;
  return least;
}

double smooth(int n, const double* u, double* slopes) {
  if (const auto zeros = std::count(u, u + n, 0.0); zeros > 0) {
    for (int i = 0; i < n; ++i) slopes[i] = zeros == 1 && u[i] == 0 ? 1 : 0;
    return 0;
  }
  const auto top = static_cast<int>(std::max_element(u, u + n) - u);
  const double most = std::max(1.0, u[top]);
  double sum = 1.0 - n, others = 0;
  for (int i = 0; i < n; ++i) sum += (most / u[i]) * (most / u[i]);
  const double weight = most / std::sqrt(sum);
  for (int i = 0; i < n; ++i) {
    slopes[i] = std::pow(weight / u[i], 3);
    if (i != top) others += u[i] * slopes[i];
  }
  if (u[top] > 1) slopes[top] = (weight - others) / u[top];
  return weight;
}

}  // namespace

SliderMap::SliderMap(const Character& character) : shapes_(static_cast<int>(character.shapes.size())) {
  first_stop_.push_back(0);
  for (const Slider& slider : character.sliders) {
    bool has_neutral = false;
    for (const SliderStop& stop : slider.stops) {
      if (stop.at > 0 && !has_neutral) stops_.push_back({0, -1});
      has_neutral |= stop.at > 0;
      stops_.push_back({stop.at, stop.shape});
    }
    if (!has_neutral && !slider.stops.empty()) stops_.push_back({0, -1});
    linear_ &= slider.stops.size() <= 1;
    first_stop_.push_back(static_cast<int>(stops_.size()));
  }
  for (const Corrective& corrective : character.correctives) {
    if (corrective.inputs.empty()) continue;
    const int first = static_cast<int>(inputs_.size());
    for (const CorrectiveInput& input : corrective.inputs) inputs_.push_back({input.slider, input.at});
    combinations_.push_back({corrective.shape, first, static_cast<int>(inputs_.size()), corrective.rule});
    linear_ = false;
    u_.resize(std::max(u_.size(), corrective.inputs.size()));
  }
  fired_.resize(u_.size());
  slopes_.reserve(2 * character.sliders.size() + inputs_.size());
}

/// The stop that the piece holding `value` starts at.
int SliderMap::piece_of(int slider, double value) const {
  int piece = first_stop_[slider];
  while (piece + 2 < first_stop_[slider + 1] && value >= stops_[piece + 1].at) ++piece;
  return piece;
}

/// The corrective's weight; its slopes by its inputs are left in `fired_`.
double SliderMap::fire(const Combination& combination, const Eigen::VectorXd& sliders) {
  const int n = combination.last - combination.first;
  const Input* inputs = inputs_.data() + combination.first;
  for (int i = 0; i < n; ++i) u_[i] = std::max(sliders[inputs[i].slider] / inputs[i].at, 0.0);
  const auto rule = combination.rule == CorrectiveRule::product    ? product
                    : combination.rule == CorrectiveRule::smallest ? smallest
                                                                   : smooth;
  const double weight = rule(n, u_.data(), fired_.data());
  for (int i = 0; i < n; ++i)
    fired_[i] = sliders[inputs[i].slider] / inputs[i].at < 0 ? 0 : fired_[i] / inputs[i].at;
  return weight;
}

void SliderMap::weights(const Eigen::VectorXd& sliders, Eigen::VectorXd& weights) {
  weights.setZero();
  for (int s = 0; s < slider_count(); ++s) {
    if (first_stop_[s] == first_stop_[s + 1]) continue;
    const Stop* low = stops_.data() + piece_of(s, sliders[s]);
    const double share = (sliders[s] - low[0].at) / (low[1].at - low[0].at);
    if (low[0].shape >= 0) weights[low[0].shape] += 1 - share;
    if (low[1].shape >= 0) weights[low[1].shape] += share;
  }
  for (const Combination& combination : combinations_)
    weights[combination.shape] += fire(combination, sliders);
}

const std::vector<SliderMap::Slope>& SliderMap::slopes(const Eigen::VectorXd& sliders) {
  slopes_.clear();
  for (int s = 0; s < slider_count(); ++s) {
    if (first_stop_[s] == first_stop_[s + 1]) continue;
    const Stop* low = stops_.data() + piece_of(s, sliders[s]);
    const double slope = 1 / (low[1].at - low[0].at);
    if (low[0].shape >= 0) slopes_.push_back({low[0].shape, s, -slope});
    if (low[1].shape >= 0) slopes_.push_back({low[1].shape, s, slope});
  }
  for (const Combination& combination : combinations_) {
    fire(combination, sliders);
    for (int i = combination.first; i < combination.last; ++i)
      if (const double value = fired_[i - combination.first]; value != 0)
        slopes_.push_back({combination.shape, inputs_[i].slider, value});
  }
  return slopes_;
}

}  // namespace mien::detail
