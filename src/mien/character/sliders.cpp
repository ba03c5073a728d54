#include "mien/character/sliders.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mien/core/error.h"

namespace mien {
namespace {

void check_shape(const Character& character, int shape, const std::string& place) {
  if (shape < 0 || shape >= static_cast<int>(character.shapes.size()))
    throw invalid_input(place, "names shape " + std::to_string(shape),
                        "there are " + std::to_string(character.shapes.size()));
}

void check_values(const Character& character, const SliderValues& sliders) {
  if (sliders.values.size() != static_cast<Eigen::Index>(character.sliders.size()))
    throw invalid_input("slider values", "are " + std::to_string(sliders.values.size()),
                        "the character has " + std::to_string(character.sliders.size()) + " sliders");
  for (Eigen::Index s = 0; s < sliders.values.size(); ++s)
    if (!std::isfinite(sliders.values[s]))
      throw invalid_input("slider " + character.sliders[static_cast<std::size_t>(s)].name, "is not finite",
                          "give a finite number");
  for (const Slider& slider : character.sliders)
    for (const SliderStop& stop : slider.stops) check_shape(character, stop.shape, "slider " + slider.name);
  for (const Corrective& corrective : character.correctives) {
    check_shape(character, corrective.shape, "corrective");
    for (const CorrectiveInput& input : corrective.inputs)
      if (input.slider < 0 || input.slider >= sliders.values.size())
        throw invalid_input("corrective", "names slider " + std::to_string(input.slider),
                            "there are " + std::to_string(sliders.values.size()));
  }
}

/// The linear piece of a slider that holds a value. Shape -1: the neutral.
struct Piece {
  int low_shape = -1, high_shape = -1;
  double low = 0, high = 1;  ///< the slider values at its ends
};

Piece piece_at(const Slider& slider, double value) {
  std::vector<SliderStop> stops = slider.stops;
  const auto neutral = std::find_if(stops.begin(), stops.end(), [](const SliderStop& s) { return s.at > 0; });
  stops.insert(neutral, SliderStop{0, -1});
  const auto above = std::upper_bound(stops.begin() + 1, stops.end() - 1, value,
                                      [](double v, const SliderStop& stop) { return v < stop.at; });
  const SliderStop& high = *above;
  const SliderStop& low = *(above - 1);
  return {low.shape, high.shape, low.at, high.at};
}

/// A corrective's weight and its derivative by each input.
struct Firing {
  double weight = 0;
  std::vector<double> slopes;
};

Firing product(const std::vector<double>& u) {
  Firing firing{1, std::vector<double>(u.size(), 1.0)};
  for (std::size_t i = 0; i < u.size(); ++i) {
    firing.weight *= u[i];
    for (std::size_t k = 0; k < u.size(); ++k)
      if (k != i) firing.slopes[k] *= u[i];
  }
  return firing;
}

Firing smallest(const std::vector<double>& u) {
  Firing firing{*std::min_element(u.begin(), u.end()), std::vector<double>(u.size(), 0.0)};
  const auto ties = static_cast<double>(std::count(u.begin(), u.end(), firing.weight));
  for (std::size_t i = 0; i < u.size(); ++i)
    if (u[i] == firing.weight) firing.slopes[i] = 1 / ties;
  return firing;
}

/// c(v) = (sum v^-2 - n + 1)^-1/2 is Clayton's copula: it is v_i where the others are 1 and lies between
/// product and minimum. Its derivative is (c / v_i)^3; where one v is 0 that goes to 1.
Firing smooth(const std::vector<double>& u) {
  const std::size_t n = u.size();
  Firing firing{0, std::vector<double>(n, 0.0)};
  if (const auto zeros = std::count(u.begin(), u.end(), 0.0); zeros > 0) {
    if (zeros == 1) firing.slopes[std::find(u.begin(), u.end(), 0.0) - u.begin()] = 1;
    return firing;
  }
  const auto top = static_cast<std::size_t>(std::max_element(u.begin(), u.end()) - u.begin());
  const double m = std::max(1.0, u[top]);
  double sum = 1.0 - static_cast<double>(n);
  for (const double value : u) sum += (m / value) * (m / value);
  firing.weight = m / std::sqrt(sum);
  for (std::size_t i = 0; i < n; ++i) firing.slopes[i] = std::pow(firing.weight / u[i], 3);
  if (u[top] <= 1) return firing;
  // Above 1 the form is homogeneous of degree one: weight = sum of u x slope (Euler).
  double others = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (i != top) others += u[i] * firing.slopes[i];
  firing.slopes[top] = (firing.weight - others) / u[top];
  return firing;
}

Firing fire(const Corrective& corrective, const Eigen::VectorXd& values) {
  std::vector<double> u;
  for (const CorrectiveInput& input : corrective.inputs) u.push_back(values[input.slider] / input.at);
  std::vector<double> clamped(u);
  for (double& value : clamped) value = std::max(value, 0.0);
  Firing firing;
  if (!u.empty())
    firing = corrective.rule == CorrectiveRule::product    ? product(clamped)
             : corrective.rule == CorrectiveRule::smallest ? smallest(clamped)
                                                           : smooth(clamped);
  for (std::size_t i = 0; i < u.size(); ++i)
    firing.slopes[i] = u[i] < 0 ? 0 : firing.slopes[i] / corrective.inputs[i].at;
  return firing;
}

}  // namespace

ShapeWeights shape_weights(const Character& character, const SliderValues& sliders) {
  check_values(character, sliders);
  ShapeWeights weights(character.shapes.size());
  for (std::size_t s = 0; s < character.sliders.size(); ++s) {
    if (character.sliders[s].stops.empty()) continue;
    const double value = sliders.values[static_cast<Eigen::Index>(s)];
    const Piece piece = piece_at(character.sliders[s], value);
    const double share = (value - piece.low) / (piece.high - piece.low);
    if (piece.low_shape >= 0) weights.values[piece.low_shape] += 1 - share;
    if (piece.high_shape >= 0) weights.values[piece.high_shape] += share;
  }
  for (const Corrective& corrective : character.correctives)
    weights.values[corrective.shape] += fire(corrective, sliders.values).weight;
  return weights;
}

Eigen::MatrixXd shape_weight_slopes(const Character& character, const SliderValues& sliders) {
  check_values(character, sliders);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(character.shapes.size()),
                                                 static_cast<Eigen::Index>(character.sliders.size()));
  for (std::size_t s = 0; s < character.sliders.size(); ++s) {
    if (character.sliders[s].stops.empty()) continue;
    const auto column = static_cast<Eigen::Index>(s);
    const Piece piece = piece_at(character.sliders[s], sliders.values[column]);
    const double slope = 1 / (piece.high - piece.low);
    if (piece.low_shape >= 0) slopes(piece.low_shape, column) -= slope;
    if (piece.high_shape >= 0) slopes(piece.high_shape, column) += slope;
  }
  for (const Corrective& corrective : character.correctives) {
    const Firing firing = fire(corrective, sliders.values);
    for (std::size_t i = 0; i < corrective.inputs.size(); ++i)
      slopes(corrective.shape, corrective.inputs[i].slider) += firing.slopes[i];
  }
  return slopes;
}

SliderValues rest_sliders(const Character& character) {
  SliderValues sliders(character.sliders.size());
  for (std::size_t s = 0; s < character.sliders.size(); ++s)
    sliders.values[static_cast<Eigen::Index>(s)] = character.sliders[s].rest;
  return sliders;
}

SliderValues apply_expression(const Character& character, const Expression& expression,
                              const SliderValues& start, double amount) {
  check_values(character, start);
  SliderValues result = start;
  for (const ExpressionValue& entry : expression.values) {
    if (entry.slider < 0 || entry.slider >= result.values.size())
      throw invalid_input("expression " + expression.name, "names slider " + std::to_string(entry.slider),
                          "there are " + std::to_string(character.sliders.size()));
    double& value = result.values[entry.slider];
    value += amount * (entry.value - value);
  }
  return result;
}

Pose pose_of(const Character& character, const RigPose& rig) {
  return {shape_weights(character, rig.sliders), rig.locals, {}, rig.wires, rig.objects};
}

RigPose rest_rig_pose(const Character& character) {
  RigPose rig{rest_sliders(character), {}};
  rig.locals.reserve(character.nodes.size());
  for (const Node& node : character.nodes) rig.locals.push_back(node.rest);
  return rig;
}

int find_slider(const Character& character, std::string_view name) {
  const auto found = std::find_if(character.sliders.begin(), character.sliders.end(),
                                  [&](const Slider& slider) { return slider.name == name; });
  return found == character.sliders.end() ? -1 : static_cast<int>(found - character.sliders.begin());
}

void complete_sliders(Character& character) {
  std::vector<bool> driven(character.shapes.size(), false);
  const auto drive = [&](int shape) {
    if (shape >= 0 && shape < static_cast<int>(driven.size())) driven[static_cast<std::size_t>(shape)] = true;
  };
  for (const Slider& slider : character.sliders)
    for (const SliderStop& stop : slider.stops) drive(stop.shape);
  for (const Corrective& corrective : character.correctives) drive(corrective.shape);
  for (std::size_t s = 0; s < character.shapes.size(); ++s) {
    if (driven[s]) continue;
    Slider slider;
    slider.name = character.shapes[s].name;
    while (find_slider(character, slider.name) >= 0) slider.name += "_shape";
    slider.stops = {{1, static_cast<int>(s)}};
    character.sliders.push_back(std::move(slider));
  }
}

}  // namespace mien
