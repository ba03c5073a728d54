// Wires act linearly, so an expression is the sum of what each feature's wires do in it, and blending by features is blending those
// sums with a weight of their own: no new evaluator is needed.
#include "mien/extract/blend.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/deform/wires.h"
#include "mien/extract/detail/deltas.h"
#include "mien/extract/detail/feature_shares.h"
#include "mien/extract/edit_wires.h"

namespace mien {
namespace {

std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  const std::string_view separators = "()[];, \t";
  while (!text.empty()) {
    const std::size_t begin = text.find_first_not_of(separators);
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end == text.data() || !std::isfinite(value)) return {};
    numbers.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return numbers;
}

void check(const Character& character, const ShapeWeights& weights) {
  if (character.wires.empty())
    throw invalid_input("wires", "are none", "a character with wires (mien wires)");
  if (weights.values.size() != static_cast<Eigen::Index>(character.shapes.size()))
    throw invalid_input("shape weights", "number " + std::to_string(weights.values.size()),
                        std::to_string(character.shapes.size()) + ", one a shape");
  if (!weights.values.allFinite()) throw invalid_input("shape weights", "are not finite", "finite numbers");
}

/// What the wires of a feature do in the expression.
std::vector<WireMove> feature_moves(const Character& character, const ShapeWeights& weights,
                                    const std::string& feature) {
  std::vector<WireMove> moves;
  for (std::size_t s = 0; s < character.shapes.size(); ++s) {
    const double weight = weights.values[static_cast<Eigen::Index>(s)];
    if (weight == 0) continue;
    for (WireMove move : character.shapes[s].wires) {
      if (character.wires[move.wire].feature != feature) continue;
      move.controls *= weight;
      move.turns *= weight;
      move.scale *= weight;
      moves.push_back(std::move(move));
    }
  }
  return moves;
}

void check_options(const Character& character, const BlendOptions& options) {
  const std::vector<std::string> features = wire_features(character);
  std::set<std::string> named;
  for (const FeatureFunction& function : options.functions) {
    std::string known;
    for (const std::string& feature : features) known += (known.empty() ? "" : ", ") + feature;
    if (std::find(features.begin(), features.end(), function.feature) == features.end())
      throw invalid_input("feature " + function.feature, "has no wire", "there are " + known);
    if (!named.insert(function.feature).second)
      throw invalid_input("feature " + function.feature, "is there twice", "one function a feature");
  }
  if (options.frames < 2 || options.frames > 100000)
    throw invalid_input("frames", "are " + std::to_string(options.frames), "2 to 100000");
  if (!(options.frames_per_second > 0) || !std::isfinite(options.frames_per_second))
    throw invalid_input("frames per second", "are not above 0", "a finite number above 0");
  for (const Clip& clip : character.clips)
    if (clip.name == options.name)
      throw invalid_input("clip " + options.name, "is there already", "another name");
}

/// Adds the two expressions' shapes of one feature and the channels that lead from one to the other.
void add_feature(Character& character, Clip& clip, const BlendFunction& function,
                 const std::vector<float>& times, std::array<Shape, 2> ends) {
  for (std::size_t end = 0; end < 2; ++end) {
    if (ends[end].parts.empty()) continue;
    Channel channel;
    channel.property = Channel::Property::shape_weight;
    channel.shape = static_cast<int>(character.shapes.size());
    channel.times = times;
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
      const double g = function(static_cast<double>(frame) / (static_cast<double>(times.size()) - 1));
      channel.values.push_back(static_cast<float>(end == 0 ? 1 - g : g));
    }
    character.shapes.push_back(std::move(ends[end]));
    clip.channels.push_back(std::move(channel));
  }
}

}  // namespace

double BlendFunction::operator()(double t) const {
  t = std::clamp(t, 0.0, 1.0);
  if (points.empty()) return std::pow(t, power);
  if (t <= points.front().x()) return points.front().y();
  for (std::size_t i = 1; i < points.size(); ++i)
    if (t <= points[i].x()) {
      const double share = (t - points[i - 1].x()) / (points[i].x() - points[i - 1].x());
      return points[i - 1].y() + share * (points[i].y() - points[i - 1].y());
    }
  return points.back().y();
}

BlendFunction blend_function(std::string_view text) {
  BlendFunction function;
  if (text == "linear") return function;
  if (text == "sqrt" || text == "cube") {
    function.power = text == "sqrt" ? 0.5 : 3;
    return function;
  }
  const std::vector<double> numbers = numbers_of(text);
  const auto fail = [&](const std::string& problem) {
    return invalid_input("function " + std::string(text), problem,
                         "linear, sqrt, cube, or points (t,g) by ascending t, as 0,0;0.3,0.9;1,1");
  };
  if (numbers.size() < 4 || numbers.size() % 2 != 0) throw fail("is not one");
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    function.points.emplace_back(numbers[i], numbers[i + 1]);
    if (i > 0 && numbers[i] <= numbers[i - 2]) throw fail("has points out of order");
  }
  return function;
}

std::vector<Shape> feature_shapes(const Character& character, const ShapeWeights& weights,
                                  const std::string& name) {
  check(character, weights);
  const std::vector<std::string> features = wire_features(character);
  const WireField field(character, character.wires);
  const detail::FeatureShares shares(character, features);
  std::vector<Shape> shapes(features.size() + 1);
  for (std::size_t f = 0; f < features.size(); ++f) shapes[f].name = name + "." + features[f];
  shapes.back().name = name + ".rest";
  std::vector<std::vector<WireMove>> moves;
  for (const std::string& feature : features) moves.push_back(feature_moves(character, weights, feature));
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    Points left = Points::Zero(character.parts[p].mesh.positions.rows(), 3);
    for (std::size_t s = 0; s < character.shapes.size(); ++s)
      if (const double weight = weights.values[static_cast<Eigen::Index>(s)]; weight != 0)
        left += static_cast<float>(weight) * detail::dense_delta(character, character.shapes[s], part);
    std::vector<Points> by_feature;
    for (const auto& feature : moves) {
      PointsD moved = PointsD::Zero(left.rows(), 3);
      field.add(part, feature, moved);
      by_feature.push_back(moved.cast<float>());
    }
    for (const Points& moved : by_feature) left -= moved;
    for (std::size_t f = 0; f < shapes.size(); ++f) {
      const Eigen::VectorXf& share = shares.of(part, static_cast<int>(f));
      Points dense = share.asDiagonal() * left;
      if (f < by_feature.size()) dense += by_feature[f];
      PartDelta delta = detail::sparse_delta(part, dense);
      if (!delta.vertices.empty()) shapes[f].parts.push_back(std::move(delta));
    }
  }
  return shapes;
}

Character blend(const Character& character, const ShapeWeights& from, const ShapeWeights& to,
                const BlendOptions& options) {
  check(character, from);
  check(character, to);
  check_options(character, options);
  const std::vector<std::string> features = wire_features(character);
  std::vector<Shape> first = feature_shapes(character, from, options.name + ".from"),
                     second = feature_shapes(character, to, options.name + ".to");
  Character result = character;
  Clip clip;
  clip.name = options.name;
  std::vector<float> times;
  for (int frame = 0; frame < options.frames; ++frame)
    times.push_back(static_cast<float>(frame / options.frames_per_second));
  for (std::size_t f = 0; f < first.size(); ++f) {
    BlendFunction function = options.uniform;
    for (const FeatureFunction& given : options.functions)
      if (f < features.size() && given.feature == features[f]) function = given.function;
    add_feature(result, clip, function, times, {std::move(first[f]), std::move(second[f])});
  }
  if (clip.channels.empty())
    throw invalid_input("expressions", "move nothing", "weights of shapes that move the face");
  result.clips.push_back(std::move(clip));
  complete_sliders(result);
  return result;
}

}  // namespace mien
