#include "mien/transfer/detail/merge_elements.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace mien::detail {
namespace {

template <class Range, class Same>
bool all_alike(const Range& a, const Range& b, const Same& same) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

bool floats_alike(const std::vector<float>& a, const std::vector<float>& b, double tolerance) {
  return all_alike(a, b, [&](float x, float y) { return std::abs(x - y) <= tolerance; });
}

/// A displacement a vertex of one part.
using Moves = std::map<int, Eigen::RowVector3d>;

std::map<int, Moves> moves_of(const Shape& shape) {
  std::map<int, Moves> parts;
  for (const PartDelta& part : shape.parts)
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
      parts[part.part][part.vertices[i]] = part.deltas.row(static_cast<Eigen::Index>(i)).cast<double>();
  return parts;
}

/// The displacements by which b differs from a, where it does.
std::map<int, Moves> change(const Shape& a, const Shape& b, double tolerance) {
  std::map<int, Moves> difference = moves_of(b);
  for (const auto& [part, moves] : moves_of(a))
    for (const auto& [vertex, move] : moves) {
      auto [entry, fresh] = difference[part].try_emplace(vertex, Eigen::RowVector3d::Zero());
      entry->second -= move;
    }
  for (auto& [part, moves] : difference)
    std::erase_if(moves, [&](const auto& entry) { return entry.second.norm() <= tolerance; });
  std::erase_if(difference, [](const auto& part) { return part.second.empty(); });
  return difference;
}

/// What moves do to their elements in one list, absent ones as rest.
template <class Move>
const Move* find_move(const std::vector<Move>& moves, int Move::*index, int wanted) {
  for (const Move& move : moves)
    if (move.*index == wanted) return &move;
  return nullptr;
}

PointsD rows_of(const PointsD* points, Eigen::Index rows) {
  return points && points->rows() == rows ? *points : PointsD(PointsD::Zero(rows, 3));
}

/// after + (edited - before), where any may have no rows; rows that differ in number: `edited`.
PointsD add_change(const PointsD* before, const PointsD* after, const PointsD* edited) {
  Eigen::Index rows = 0;
  for (const PointsD* points : {before, after, edited})
    if (points) rows = std::max(rows, points->rows());
  for (const PointsD* points : {before, after, edited})
    if (points && points->rows() != 0 && points->rows() != rows) return edited ? *edited : PointsD();
  return rows_of(after, rows) + rows_of(edited, rows) - rows_of(before, rows);
}

bool moves_alike(const WireMove* a, const WireMove* b, const Alike& alike) {
  const Eigen::Index rows = std::max(a ? a->controls.rows() : 0, b ? b->controls.rows() : 0),
                     turns = std::max(a ? a->turns.rows() : 0, b ? b->turns.rows() : 0);
  const auto part = [](const WireMove* move, PointsD WireMove::*points) {
    return move ? &(move->*points) : nullptr;
  };
  const Alike angles{alike.number};
  return alike(rows_of(part(a, &WireMove::controls), rows), rows_of(part(b, &WireMove::controls), rows)) &&
         angles(rows_of(part(a, &WireMove::turns), turns), rows_of(part(b, &WireMove::turns), turns)) &&
         alike(a ? a->scale : 0, b ? b->scale : 0);
}

bool moves_alike(const ObjectMove* a, const ObjectMove* b, const Alike& alike) {
  const Eigen::Index rows = std::max(a ? a->controls.rows() : 0, b ? b->controls.rows() : 0);
  return alike(rows_of(a ? &a->controls : nullptr, rows), rows_of(b ? &b->controls : nullptr, rows));
}

template <class Move>
std::vector<int> indices_of(const std::vector<Move>& a, const std::vector<Move>& b,
                            const std::vector<Move>& c, int Move::*index) {
  std::vector<int> indices;
  for (const std::vector<Move>* list : {&a, &b, &c})
    for (const Move& move : *list) indices.push_back(move.*index);
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return indices;
}

template <class Move>
bool lists_alike(const std::vector<Move>& a, const std::vector<Move>& b, int Move::*index,
                 const Alike& alike) {
  for (const int i : indices_of(a, b, {}, index))
    if (!moves_alike(find_move(a, index, i), find_move(b, index, i), alike)) return false;
  return true;
}

const PointsD* controls_of(const ObjectMove* move) {
  return move ? &move->controls : nullptr;
}

std::vector<ObjectMove> combined_moves(const std::vector<ObjectMove>& before,
                                       const std::vector<ObjectMove>& after,
                                       const std::vector<ObjectMove>& edited) {
  std::vector<ObjectMove> moves;
  for (const int i : indices_of(before, after, edited, &ObjectMove::object)) {
    const auto in = [&](const std::vector<ObjectMove>& list) {
      return controls_of(find_move(list, &ObjectMove::object, i));
    };
    moves.push_back({i, add_change(in(before), in(after), in(edited))});
  }
  return moves;
}

std::vector<WireMove> combined_moves(const std::vector<WireMove>& before, const std::vector<WireMove>& after,
                                     const std::vector<WireMove>& edited) {
  std::vector<WireMove> moves;
  for (const int i : indices_of(before, after, edited, &WireMove::wire)) {
    const WireMove *b = find_move(before, &WireMove::wire, i), *a = find_move(after, &WireMove::wire, i),
                   *e = find_move(edited, &WireMove::wire, i);
    const auto sum = [&](PointsD WireMove::*points) {
      return add_change(b ? &(b->*points) : nullptr, a ? &(a->*points) : nullptr,
                        e ? &(e->*points) : nullptr);
    };
    const double scale = (a ? a->scale : 0) + (e ? e->scale : 0) - (b ? b->scale : 0);
    moves.push_back({i, sum(&WireMove::controls), scale, sum(&WireMove::turns)});
  }
  return moves;
}

bool ranges_alike(const std::array<ValueRange, 3>& a, const std::array<ValueRange, 3>& b,
                  const Alike& alike) {
  return all_alike(a, b, [&](const ValueRange& x, const ValueRange& y) {
    return (x.low == y.low || alike(x.low, y.low)) && (x.high == y.high || alike(x.high, y.high));
  });
}

/// What a channel animates, whatever the part: a shape's weight on several parts alike is one animation.
auto target_of(const Channel& channel) {
  return std::tuple(channel.property, channel.node, channel.shape, channel.slider, channel.wire,
                    channel.object, channel.control);
}

/// In an order of their own, each animation once: files list channels by kind, and a shape's weight part by part.
std::vector<const Channel*> ordered_channels(const Clip& clip) {
  std::vector<const Channel*> channels;
  for (const Channel& channel : clip.channels) channels.push_back(&channel);
  std::stable_sort(channels.begin(), channels.end(),
                   [](const Channel* a, const Channel* b) { return target_of(*a) < target_of(*b); });
  const auto same = [](const Channel* a, const Channel* b) {
    return target_of(*a) == target_of(*b) && a->times == b->times && a->values == b->values;
  };
  channels.erase(std::unique(channels.begin(), channels.end(), same), channels.end());
  return channels;
}

bool holds_lengths(const Channel& channel) {
  using Property = Channel::Property;
  return channel.property == Property::translation || channel.property == Property::wire_control ||
         channel.property == Property::object_control;
}

bool channels_alike(const Channel& a, const Channel& b, const Alike& alike) {
  return target_of(a) == target_of(b) && a.interpolation == b.interpolation &&
         floats_alike(a.times, b.times, 1e-6) && all_alike(a.values, b.values, [&](float x, float y) {
           return alike(x, y) || (holds_lengths(a) && std::abs(x - y) <= alike.length);
         });
}

}  // namespace

bool Alike::operator()(double a, double b) const {
  return std::abs(a - b) <= number * std::max({1.0, std::abs(a), std::abs(b)});
}

bool Alike::operator()(const PointsD& a, const PointsD& b) const {
  return a.rows() == b.rows() && (a.rows() == 0 || (a - b).rowwise().norm().maxCoeff() <= length);
}

bool Alike::operator()(const Transform& a, const Transform& b) const {
  return (a.translation - b.translation).norm() <= length &&
         a.rotation.angularDistance(b.rotation) <= 10 * number && (a.scale - b.scale).norm() <= number;
}

bool Alike::operator()(const Node& a, const Node& b) const {
  return a.parent == b.parent && a.has_matrix == b.has_matrix && (*this)(a.rest, b.rest) &&
         (!a.has_matrix || a.matrix.isApprox(b.matrix, number));
}

bool Alike::operator()(const Shape& a, const Shape& b) const {
  return change(a, b, length).empty() && lists_alike(a.wires, b.wires, &WireMove::wire, *this) &&
         lists_alike(a.objects, b.objects, &ObjectMove::object, *this);
}

bool Alike::operator()(const Slider& a, const Slider& b) const {
  const auto same_stop = [&](const SliderStop& x, const SliderStop& y) {
    return x.shape == y.shape && (*this)(x.at, y.at);
  };
  return (*this)(a.minimum, b.minimum) && (*this)(a.maximum, b.maximum) && (*this)(a.rest, b.rest) &&
         all_alike(a.stops, b.stops, same_stop);
}

bool Alike::operator()(const Expression& a, const Expression& b) const {
  return all_alike(a.values, b.values, [&](const ExpressionValue& x, const ExpressionValue& y) {
    return x.slider == y.slider && (*this)(x.value, y.value);
  });
}

bool Alike::operator()(const Clip& a, const Clip& b) const {
  return all_alike(ordered_channels(a), ordered_channels(b),
                   [&](const Channel* x, const Channel* y) { return channels_alike(*x, *y, *this); });
}

bool Alike::operator()(const SkinWeights& a, const SkinWeights& b) const {
  return a.offsets == b.offsets && a.joints == b.joints && floats_alike(a.weights, b.weights, weight);
}

bool Alike::operator()(const std::vector<InfluenceBinding>& a, const std::vector<InfluenceBinding>& b) const {
  return all_alike(a, b, [&](const InfluenceBinding& x, const InfluenceBinding& y) {
    return x.part == y.part && x.vertices == y.vertices && x.offsets == y.offsets &&
           x.controls == y.controls && floats_alike(x.weights, y.weights, weight) &&
           floats_alike(x.coefficients, y.coefficients, weight);
  });
}

bool Alike::operator()(const Wire& a, const Wire& b) const {
  const auto same_binding = [&](const WireBinding& x, const WireBinding& y) {
    return x.part == y.part && x.vertices == y.vertices && floats_alike(x.falloff, y.falloff, weight) &&
           floats_alike(x.parameters, y.parameters, weight);
  };
  const auto same_range = [&](double x, double y) {
    return std::abs(x - y) <= std::max(length, 1e-6 * std::abs(x));
  };
  return a.feature == b.feature && a.turn_controls == b.turn_controls && a.geodesic == b.geodesic &&
         (*this)(a.localizing, b.localizing) && a.curve.knots == b.curve.knots &&
         (*this)(a.curve.controls, b.curve.controls) && all_alike(a.ranges, b.ranges, same_range) &&
         a.falloff == b.falloff && all_alike(a.bindings, b.bindings, same_binding);
}

bool Alike::operator()(const InfluenceObject& a, const InfluenceObject& b) const {
  return a.form == b.form && a.carrier == b.carrier && a.node == b.node && (*this)(a.controls, b.controls) &&
         (a.skin < 0) == (b.skin < 0) && (*this)(a.skin_weights, b.skin_weights) &&
         (*this)(a.bindings, b.bindings);
}

bool Alike::operator()(const Constraint& a, const Constraint& b) const {
  return a.kind == b.kind && a.node == b.node && a.sources == b.sources && a.relative == b.relative &&
         a.axes == b.axes && (*this)(a.influence, b.influence) &&
         ranges_alike(a.translation, b.translation, *this) && ranges_alike(a.rotation, b.rotation, *this) &&
         ranges_alike(a.scale, b.scale, *this) && a.aim_axis.isApprox(b.aim_axis, number) &&
         a.up_axis.isApprox(b.up_axis, number) && a.up.isApprox(b.up, number) && a.up_node == b.up_node;
}

Transform combined(const Transform& before, const Transform& after, const Transform& edited) {
  Transform result;
  result.translation = after.translation + edited.translation - before.translation;
  result.rotation = (after.rotation * before.rotation.inverse() * edited.rotation).normalized();
  result.scale = after.scale.array() * edited.scale.array() /
                 (before.scale.array() == 0).select(1.0, before.scale.array());
  return result;
}

Shape combined(const Shape& before, const Shape& after, const Shape& edited, const Alike& alike) {
  std::map<int, Moves> sum = moves_of(after);
  for (const auto& [part, moves] : change(before, edited, alike.length))
    for (const auto& [vertex, move] : moves)
      sum[part].try_emplace(vertex, Eigen::RowVector3d::Zero()).first->second += move;
  Shape result{after.name,
               {},
               combined_moves(before.wires, after.wires, edited.wires),
               combined_moves(before.objects, after.objects, edited.objects)};
  for (const auto& [part, moves] : sum) {
    PartDelta delta;
    delta.part = part;
    delta.deltas.resize(static_cast<Eigen::Index>(moves.size()), 3);
    for (const auto& [vertex, move] : moves) {
      delta.deltas.row(static_cast<Eigen::Index>(delta.vertices.size())) = move.cast<float>();
      delta.vertices.push_back(vertex);
    }
    result.parts.push_back(std::move(delta));
  }
  if (result.parts.empty()) result.parts = after.parts;
  return result;
}

Slider combined(const Slider& before, const Slider& after, const Slider& edited, const Alike& alike) {
  Slider result = edited;
  const auto settle = [&](double Slider::*value) {
    if (alike(before.*value, edited.*value)) result.*value = after.*value;
  };
  settle(&Slider::minimum);
  settle(&Slider::maximum);
  settle(&Slider::rest);
  Slider stops_only = before;
  stops_only.stops = edited.stops;
  if (alike(before, stops_only)) result.stops = after.stops;
  return result;
}

InfluenceObject combined(const InfluenceObject& before, const InfluenceObject& after,
                         const InfluenceObject& edited, const Alike& alike) {
  InfluenceObject result = edited;
  if (before.form != after.form || after.form != edited.form) return result;
  result.controls = add_change(&before.controls, &after.controls, &edited.controls);
  if (alike(before.bindings, edited.bindings)) result.bindings = after.bindings;
  if (alike(before.skin_weights, edited.skin_weights)) {
    result.skin = after.skin;
    result.skin_weights = after.skin_weights;
  }
  return result;
}

Wire combined(const Wire& before, const Wire& after, const Wire& edited, const Alike& alike) {
  Wire result = edited;
  if (before.curve.knots != after.curve.knots || after.curve.knots != edited.curve.knots) return result;
  result.curve.controls = add_change(&before.curve.controls, &after.curve.controls, &edited.curve.controls);
  Wire bindings_only = before;
  bindings_only.bindings = edited.bindings;
  if (alike(before, bindings_only)) result.bindings = after.bindings;
  return result;
}

}  // namespace mien::detail
