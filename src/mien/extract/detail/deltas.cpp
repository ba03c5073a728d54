#include "mien/extract/detail/deltas.h"

#include <algorithm>

namespace mien::detail {

Points dense_delta(const Character& character, const Shape& shape, int part) {
  Points dense = Points::Zero(character.parts[part].mesh.positions.rows(), 3);
  for (const PartDelta& delta : shape.parts)
    if (delta.part == part)
      for (std::size_t i = 0; i < delta.vertices.size(); ++i)
        dense.row(delta.vertices[i]) += delta.deltas.row(static_cast<Eigen::Index>(i));
  return dense;
}

PartDelta sparse_delta(int part, const Points& dense) {
  PartDelta delta;
  delta.part = part;
  for (Eigen::Index v = 0; v < dense.rows(); ++v)
    if (dense.row(v).squaredNorm() > 0) delta.vertices.push_back(static_cast<int>(v));
  delta.deltas.resize(static_cast<Eigen::Index>(delta.vertices.size()), 3);
  for (std::size_t i = 0; i < delta.vertices.size(); ++i)
    delta.deltas.row(static_cast<Eigen::Index>(i)) = dense.row(delta.vertices[i]);
  return delta;
}

std::vector<Eigen::Matrix3d> vectors_to_model(const Character& character) {
  const std::vector<Eigen::Matrix4d> model = model_matrices(character);
  std::vector<Eigen::Matrix3d> vectors;
  for (const Part& part : character.parts)
    vectors.push_back(part.skin >= 0 || part.node < 0
                          ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                          : Eigen::Matrix3d(model[part.node].topLeftCorner<3, 3>()));
  return vectors;
}

void replace_delta(Shape& shape, PartDelta delta) {
  auto at = std::lower_bound(shape.parts.begin(), shape.parts.end(), delta.part,
                             [](const PartDelta& d, int part) { return d.part < part; });
  if (at != shape.parts.end() && at->part == delta.part)
    *at = std::move(delta);
  else
    shape.parts.insert(at, std::move(delta));
}

}  // namespace mien::detail
