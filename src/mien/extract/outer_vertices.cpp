#include <algorithm>

#include "mien/deform/wires.h"
#include "mien/extract/improve_wires.h"
#include "mien/geometry/openness.h"

namespace mien {
namespace {

constexpr int rays = 32;
constexpr double closed = 0.08;  ///< openness below which a vertex is hidden
constexpr float hidden_weight = 0.02f;
constexpr float near_wire =
    0.9f;  ///< falloff from which a vertex counts whatever it sees: closed lips, lid margins

}  // namespace

std::vector<Eigen::VectorXf> outer_vertex_weights(const Character& character, std::span<const Wire> wires) {
  std::vector<Eigen::VectorXf> weights(character.parts.size());
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Mesh& mesh = character.parts[p].mesh;
    std::vector<float> nearest(mesh.vertex_count(), 0);
    for (const Wire& wire : wires)
      for (const WireBinding& binding : wire.bindings)
        if (binding.part == static_cast<int>(p))
          for (std::size_t i = 0; i < binding.vertices.size(); ++i)
            nearest[binding.vertices[i]] = std::max(nearest[binding.vertices[i]], binding.falloff[i]);
    if (std::all_of(nearest.begin(), nearest.end(), [](float f) { return f == 0; })) continue;
    const Eigen::VectorXd open =
        openness(bind_positions(character, static_cast<int>(p)), triangulate(mesh.faces), rays);
    weights[p] = Eigen::VectorXf::Ones(static_cast<Eigen::Index>(mesh.vertex_count()));
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      if (open[static_cast<Eigen::Index>(v)] < closed && nearest[v] < near_wire)
        weights[p][static_cast<Eigen::Index>(v)] = hidden_weight;
  }
  return weights;
}

}  // namespace mien
