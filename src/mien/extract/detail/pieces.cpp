#include "mien/extract/detail/pieces.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mien/character/weld.h"
#include "mien/deform/wires.h"
#include "mien/geometry/laplacian.h"

namespace mien::detail {

Pieces::Pieces(const Character& character, std::span<const Wire> wires) {
  std::vector<int> feature_of_wire;
  for (const Wire& wire : wires) {
    auto found = std::find_if(features_.begin(), features_.end(),
                              [&](const FeatureError& feature) { return feature.feature == wire.feature; });
    if (found == features_.end()) found = features_.insert(found, FeatureError{wire.feature});
    feature_of_wire.push_back(static_cast<int>(found - features_.begin()));
  }
  features_.push_back({});
  const int none = static_cast<int>(features_.size()) - 1;
  Eigen::AlignedBox3d reached;
  const std::vector<Eigen::Matrix4d> model = model_matrices(character);
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Part& part = character.parts[p];
    const std::size_t count = part.mesh.vertex_count();
    std::vector<float> best(count, 0);
    feature_.emplace_back(count, none);
    for (std::size_t w = 0; w < wires.size(); ++w)
      for (const WireBinding& binding : wires[w].bindings) {
        if (binding.part != static_cast<int>(p)) continue;
        for (std::size_t i = 0; i < binding.vertices.size(); ++i)
          if (binding.falloff[i] > best[binding.vertices[i]]) {
            best[binding.vertices[i]] = binding.falloff[i];
            feature_.back()[binding.vertices[i]] = feature_of_wire[w];
          }
      }
    has_skin_.push_back(std::any_of(best.begin(), best.end(), [](float f) { return f > 0; }));
    skin_.emplace_back(count, 0);
    unit_.push_back(part.skin >= 0 || part.node < 0
                        ? 1.0
                        : std::cbrt(std::abs(model[part.node].topLeftCorner<3, 3>().determinant())));
    if (!has_skin_.back()) continue;
    const Weld weld = weld_seams(character, static_cast<int>(p));
    const std::vector<int> labels =
        connected_components(weld.size(), triangulate(weld_faces(part.mesh.faces, weld)));
    std::vector<char> carries(weld.size() + 1, 0);
    for (std::size_t v = 0; v < count; ++v)
      if (best[v] > 0) carries[labels[weld.of[v]]] = 1;
    const PointsD positions = bind_positions(character, static_cast<int>(p));
    for (std::size_t v = 0; v < count; ++v) {
      skin_.back()[v] = carries[labels[weld.of[v]]];
      skin_vertices_ += skin_.back()[v] ? 1 : 0;
      if (!(best[v] > 0)) continue;
      reached.extend(positions.row(static_cast<Eigen::Index>(v)).transpose());
    }
  }
  box_ = reached.isEmpty() ? 0 : reached.diagonal().norm();
}

}  // namespace mien::detail
