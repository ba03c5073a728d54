// All weight maps travel as one sparse matrix: a column a control point that holds weight x coefficient. A row's sum is then the
// weight and the row over its sum the coefficients, before and after, and mixing rows mixes both as it should: a vertex between
// one that an object holds and one that it does not is held by half.
#include "mien/transfer/carry_objects.h"

#include <algorithm>
#include <cmath>

#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

/// What rounding and the harmonic filling leave of nothing.
constexpr double least_weight = 1e-5, least_share = 1e-6;

/// Columns that an object takes in the matrix: one a control point, or one for a frame without control points.
int column_count(const InfluenceObject& object) {
  return std::max(1, static_cast<int>(object.controls.rows()));
}

WeightMatrix matrix_of(const Character& source) {
  const std::vector<int> first = first_rows(source);
  std::vector<Eigen::Triplet<double>> entries;
  int column = 0;
  for (const InfluenceObject& object : source.objects) {
    for (const InfluenceBinding& binding : object.bindings)
      for (std::size_t i = 0; i < binding.vertices.size(); ++i) {
        const int row = first[at(binding.part)] + binding.vertices[i];
        if (binding.offsets.empty()) {
          entries.emplace_back(row, column, binding.weights[i]);
          continue;
        }
        for (int e = binding.offsets[i]; e < binding.offsets[i + 1]; ++e)
          entries.emplace_back(row, column + binding.controls[at(e)],
                               static_cast<double>(binding.weights[i]) * binding.coefficients[at(e)]);
      }
    column += column_count(object);
  }
  WeightMatrix matrix(first.back(), column);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Appends one vertex, held by the entries of its row in [column, column + count).
void append(const WeightMatrix& rows, int row, int column, int count, int vertex, bool framed,
            InfluenceBinding& binding) {
  std::vector<std::pair<int, double>> held;
  double weight = 0;
  for (WeightMatrix::InnerIterator entry(rows, row); entry; ++entry) {
    const int control = static_cast<int>(entry.col()) - column;
    if (control < 0 || control >= count) continue;
    weight += entry.value();
    held.emplace_back(control, entry.value());
  }
  if (!(weight > least_weight)) return;
  binding.vertices.push_back(vertex);
  binding.weights.push_back(static_cast<float>(std::min(weight, 1.0)));
  if (framed) return;
  double kept = 0;
  std::erase_if(held, [&](const auto& share) { return !(std::abs(share.second) > least_share * weight); });
  for (const auto& [control, share] : held) kept += share;
  for (const auto& [control, share] : held) {
    binding.controls.push_back(control);
    binding.coefficients.push_back(static_cast<float>(share / kept));
  }
  binding.offsets.push_back(static_cast<int>(binding.controls.size()));
}

std::vector<InfluenceBinding> bindings_of(const WeightMatrix& rows, int column, int count, bool framed,
                                          const Character& target) {
  const std::vector<int> first = first_rows(target);
  std::vector<InfluenceBinding> bindings;
  for (std::size_t p = 0; p < target.parts.size(); ++p) {
    InfluenceBinding binding;
    binding.part = static_cast<int>(p);
    if (!framed) binding.offsets.push_back(0);
    for (int row = first[p]; row < first[p + 1]; ++row)
      append(rows, row, column, count, row - first[p], framed, binding);
    if (!binding.vertices.empty()) bindings.push_back(std::move(binding));
  }
  return bindings;
}

/// The object itself, without bindings.
InfluenceObject carry_object(const InfluenceObject& object, const Character& source, const RigMap& map,
                             std::vector<std::string>& dropped) {
  InfluenceObject carried = object;
  carried.bindings.clear();
  for (Eigen::Index c = 0; c < object.controls.rows(); ++c)
    carried.controls.row(c) = map.space.position(object.controls.row(c).transpose()).transpose();
  const auto node_of = [&](int node) {
    if (node < 0) return -1;
    if (map.node_of[at(node)] < 0)
      dropped.push_back("object " + object.name + ": node " + source.nodes[at(node)].name);
    return map.node_of[at(node)];
  };
  carried.carrier = node_of(object.carrier);
  carried.node = node_of(object.node);
  if (object.skin < 0) return carried;
  carried.skin = 0;
  for (int& joint : carried.skin_weights.joints) joint = map.skin_joint[at(object.skin)][at(joint)];
  return carried;
}

}  // namespace

std::vector<int> first_rows(const Character& character) {
  std::vector<int> first{0};
  for (const Part& part : character.parts)
    first.push_back(first.back() + static_cast<int>(part.mesh.positions.rows()));
  return first;
}

std::vector<InfluenceObject> carry_objects(const Character& source, const Character& target,
                                           const RigMap& map, std::vector<std::string>& dropped) {
  std::vector<InfluenceObject> objects;
  if (source.objects.empty()) return objects;
  const WeightMatrix rows = map.rows(matrix_of(source));
  int column = 0;
  for (const InfluenceObject& object : source.objects) {
    const bool framed =
        std::holds_alternative<Cluster>(object.form) || std::holds_alternative<Locator>(object.form);
    objects.push_back(carry_object(object, source, map, dropped));
    objects.back().bindings = bindings_of(rows, column, column_count(object), framed, target);
    column += column_count(object);
  }
  return objects;
}

std::vector<ObjectMove> carry_object_moves(const Character& source, const std::vector<ObjectMove>& moves,
                                           const RigMap& map, double factor) {
  std::vector<ObjectMove> carried = moves;
  for (ObjectMove& move : carried)
    if (move.controls.rows() > 0)
      move.controls = factor * map.move(source.objects[at(move.object)].controls, move.controls);
  return carried;
}

}  // namespace mien
