// Wires are linear, so a drag needs their effect on its few points alone. A field of wires whose bindings are cut down to those points gives it at
// the price of a few entries an unknown, instead of a pass over the face.
#include "mien/pose/detail/wire_unknowns.h"

#include <algorithm>

#include "mien/deform/wires.h"

namespace mien::detail {
namespace {

/// Per part: the vertices that a point depends on, ascending.
std::vector<std::vector<int>> vertices_of(const Character& character,
                                          const std::vector<SurfacePoint>& points) {
  std::vector<std::vector<int>> vertices(character.parts.size());
  for (const SurfacePoint& point : points) {
    std::vector<int>& list = vertices[static_cast<std::size_t>(point.part)];
    if (point.face < 0)
      list.push_back(point.vertex);
    else
      for (const int v : character.parts[point.part].mesh.faces[point.face]) list.push_back(v);
  }
  for (std::vector<int>& list : vertices) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return vertices;
}

/// The wires, reaching these vertices alone.
std::vector<Wire> cut_down(const std::vector<Wire>& wires, const std::vector<std::vector<int>>& vertices) {
  std::vector<Wire> cut = wires;
  for (Wire& wire : cut)
    for (WireBinding& binding : wire.bindings) {
      const std::vector<int>& kept = vertices[static_cast<std::size_t>(binding.part)];
      WireBinding small;
      small.part = binding.part;
      for (const int v : kept) {
        const auto at = std::lower_bound(binding.vertices.begin(), binding.vertices.end(), v);
        if (at == binding.vertices.end() || *at != v) continue;
        const auto i = static_cast<std::size_t>(at - binding.vertices.begin());
        small.vertices.push_back(v);
        small.falloff.push_back(binding.falloff[i]);
        small.parameters.push_back(binding.parameters[i]);
      }
      binding = std::move(small);
    }
  return cut;
}

/// Where `zero` (per part #V x 3) is moved by `moves`, as a shape.
Shape shape_of(const WireField& field, std::span<const WireMove> moves,
               const std::vector<std::vector<int>>& vertices, std::vector<PointsD>& zero) {
  Shape shape;
  for (std::size_t p = 0; p < vertices.size(); ++p) {
    if (vertices[p].empty()) continue;
    field.add(static_cast<int>(p), moves, zero[p]);
    PartDelta delta;
    delta.part = static_cast<int>(p);
    delta.vertices = vertices[p];
    delta.deltas.resize(static_cast<Eigen::Index>(vertices[p].size()), 3);
    for (std::size_t i = 0; i < vertices[p].size(); ++i) {
      delta.deltas.row(static_cast<Eigen::Index>(i)) = zero[p].row(vertices[p][i]).cast<float>();
      zero[p].row(vertices[p][i]).setZero();
    }
    shape.parts.push_back(std::move(delta));
  }
  return shape;
}

}  // namespace

WireUnknowns::WireUnknowns(const Character& character, std::span<const int> wires,
                           std::vector<WireMove> start)
    : start_(std::move(start)) {
  for (const int w : wires) {
    const Wire& wire = character.wires[static_cast<std::size_t>(w)];
    Dragged dragged{w, count(), wire.curve.control_count(), wire.turn_controls};
    const double range = *std::max_element(wire.ranges.begin(), wire.ranges.end());
    units_.insert(units_.end(), 3 * static_cast<std::size_t>(dragged.controls), range);
    units_.insert(units_.end(), 1 + 3 * static_cast<std::size_t>(dragged.turns), 1.0);
    wires_.push_back(dragged);
  }
}

WireMove WireUnknowns::change(std::size_t wire, const Eigen::Ref<const Eigen::VectorXd>& x) const {
  const Dragged& dragged = wires_[wire];
  int at = dragged.first;
  const auto next = [&] {
    const double value = units_[static_cast<std::size_t>(at)] * x[at];
    ++at;
    return value;
  };
  WireMove move;
  move.wire = dragged.wire;
  move.controls.resize(dragged.controls, 3);
  for (int l = 0; l < dragged.controls; ++l)
    for (int k = 0; k < 3; ++k) move.controls(l, k) = next();
  move.scale = next();
  move.turns.resize(dragged.turns, 3);
  for (int t = 0; t < dragged.turns; ++t)
    for (int k = 0; k < 3; ++k) move.turns(t, k) = next();
  return move;
}

void WireUnknowns::add_shapes(const std::vector<SurfacePoint>& points, Character& character) const {
  const std::vector<std::vector<int>> vertices = vertices_of(character, points);
  const WireField field(character, cut_down(character.wires, vertices));
  std::vector<PointsD> zero;
  for (const Part& part : character.parts) zero.push_back(PointsD::Zero(part.mesh.positions.rows(), 3));
  character.shapes.push_back(shape_of(field, start_, vertices, zero));
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(count());
  for (std::size_t w = 0; w < wires_.size(); ++w) {
    const int end = w + 1 < wires_.size() ? wires_[w + 1].first : count();
    for (int at = wires_[w].first; at < end; ++at) {
      unit[at] = 1;
      const WireMove move = change(w, unit);
      unit[at] = 0;
      character.shapes.push_back(shape_of(field, {&move, 1}, vertices, zero));
    }
  }
}

std::vector<WireMove> WireUnknowns::moves(const Eigen::Ref<const Eigen::VectorXd>& x) const {
  std::vector<WireMove> moves = start_;
  for (std::size_t w = 0; w < wires_.size(); ++w) {
    const int end = w + 1 < wires_.size() ? wires_[w + 1].first : count();
    if (x.segment(wires_[w].first, end - wires_[w].first).isZero(0)) continue;
    moves.push_back(change(w, x));
  }
  return moves;
}

}  // namespace mien::detail
