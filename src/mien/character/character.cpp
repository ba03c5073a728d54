#include "mien/character/character.h"

#include <algorithm>

#include "mien/core/error.h"

namespace mien {
namespace {

template <class Items>
int find_by_name(const Items& items, std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

}  // namespace

Eigen::Matrix4d Transform::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix() * scale.asDiagonal();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

double Clip::duration() const {
  float last = 0;
  for (const Channel& channel : channels)
    if (!channel.times.empty()) last = std::max(last, channel.times.back());
  return last;
}

int find_part(const Character& character, std::string_view name) {
  return find_by_name(character.parts, name);
}
int find_shape(const Character& character, std::string_view name) {
  return find_by_name(character.shapes, name);
}
int find_wire(const Character& character, std::string_view name) {
  return find_by_name(character.wires, name);
}
int find_node(const Character& character, std::string_view name) {
  return find_by_name(character.nodes, name);
}
int find_object(const Character& character, std::string_view name) {
  return find_by_name(character.objects, name);
}

std::vector<Eigen::Matrix4d> model_matrices(const Character& character) {
  std::vector<Eigen::Matrix4d> locals;
  locals.reserve(character.nodes.size());
  for (const Node& node : character.nodes)
    locals.push_back(node.has_matrix ? node.matrix : node.rest.matrix());
  return model_matrices(character, locals);
}

std::vector<Eigen::Matrix4d> model_matrices(const Character& character,
                                            const std::vector<Eigen::Matrix4d>& locals) {
  const auto& nodes = character.nodes;
  const int count = static_cast<int>(nodes.size());
  std::vector<Eigen::Matrix4d> model(count);
  std::vector<char> state(count, 0);  // 0: not seen, 1: on the path, 2: done
  std::vector<int> path;
  for (int start = 0; start < count; ++start) {
    for (int n = start; n != -1 && state[n] != 2; n = nodes[n].parent) {
      const std::string place = "node " + std::to_string(n) + " (" + nodes[n].name + ")";
      if (state[n] == 1) throw invalid_input(place, "is its own ancestor", "a hierarchy without cycles");
      if (nodes[n].parent < -1 || nodes[n].parent >= count)
        throw invalid_input(place, "has parent " + std::to_string(nodes[n].parent),
                            "a parent from -1 to " + std::to_string(count - 1));
      state[n] = 1;
      path.push_back(n);
    }
    for (; !path.empty(); path.pop_back()) {
      const int n = path.back();
      model[n] = nodes[n].parent == -1 ? locals[n] : Eigen::Matrix4d(model[nodes[n].parent] * locals[n]);
      state[n] = 2;
    }
  }
  return model;
}

Eigen::Vector3d position_of(const Mesh& mesh, const Points& positions, const SurfacePoint& point) {
  if (point.face < 0) return positions.row(point.vertex).cast<double>();
  const auto face = mesh.faces[point.face];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    sum += point.barycentric[k] * positions.row(face[point.corners[k]]).cast<double>().transpose();
  return sum;
}

}  // namespace mien
