#include "mien/extract/detail/feature_shares.h"

#include <algorithm>
#include <cmath>

#include "mien/character/weld.h"
#include "mien/deform/wires.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/surface_query.h"

namespace mien::detail {
namespace {

/// Per part: #V x (features + 1) shares, and whether a wire reaches the vertex.
struct Reach {
  std::vector<Eigen::MatrixXf> shares;
  std::vector<std::vector<char>> reached;
};

Reach reach_of(const Character& character, const std::vector<std::string>& features) {
  Reach reach;
  const auto columns = static_cast<Eigen::Index>(features.size()) + 1;
  for (const Part& part : character.parts) {
    reach.shares.push_back(Eigen::MatrixXf::Zero(part.mesh.positions.rows(), columns));
    reach.reached.emplace_back(part.mesh.vertex_count(), 0);
  }
  for (const Wire& wire : character.wires) {
    const auto feature = std::find(features.begin(), features.end(), wire.feature) - features.begin();
    for (const WireBinding& binding : wire.bindings)
      for (std::size_t i = 0; i < binding.vertices.size(); ++i)
        reach.shares[binding.part](binding.vertices[i], feature) +=
            std::pow(binding.falloff[i], static_cast<float>(wire.localizing));
  }
  for (std::size_t p = 0; p < reach.shares.size(); ++p)
    for (Eigen::Index v = 0; v < reach.shares[p].rows(); ++v) {
      const float sum = reach.shares[p].row(v).sum();
      if (sum > 0) reach.shares[p].row(v) /= sum;
      reach.reached[p][static_cast<std::size_t>(v)] = sum > 0;
    }
  return reach;
}

/// The reached skin of all parts as one surface that can be asked for its closest point.
struct Skin {
  Skin(const Character& character, const Reach& reach) {
    std::vector<Eigen::Vector3i> corners;
    for (std::size_t p = 0; p < character.parts.size(); ++p) {
      const auto offset = static_cast<Eigen::Index>(rows.size());
      const PointsD part = bind_positions(character, static_cast<int>(p));
      positions.conservativeResize(offset + part.rows(), Eigen::NoChange);
      positions.bottomRows(part.rows()) = part;
      for (Eigen::Index v = 0; v < part.rows(); ++v) rows.push_back(reach.shares[p].row(v));
      const Triangles triangles = triangulate(character.parts[p].mesh.faces);
      for (Eigen::Index t = 0; t < triangles.rows(); ++t)
        if (reach.reached[p][triangles(t, 0)] && reach.reached[p][triangles(t, 1)] &&
            reach.reached[p][triangles(t, 2)])
          corners.push_back(triangles.row(t).transpose().array() + static_cast<int>(offset));
    }
    triangles.resize(static_cast<Eigen::Index>(corners.size()), 3);
    for (std::size_t t = 0; t < corners.size(); ++t)
      triangles.row(static_cast<Eigen::Index>(t)) = corners[t].transpose();
  }
  PointsD positions;
  Triangles triangles;
  std::vector<Eigen::RowVectorXf> rows;  ///< shares by row of positions
};

}  // namespace

FeatureShares::FeatureShares(const Character& character, const std::vector<std::string>& features) {
  Reach reach = reach_of(character, features);
  const Skin skin(character, reach);
  const auto rest = static_cast<Eigen::Index>(features.size());
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Weld weld = weld_seams(character, static_cast<int>(p));
    const std::vector<int> labels =
        connected_components(weld.size(), triangulate(weld_faces(character.parts[p].mesh.faces, weld)));
    const int pieces = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
    std::vector<char> carries(static_cast<std::size_t>(pieces), 0);
    for (std::size_t v = 0; v < weld.of.size(); ++v)
      if (reach.reached[p][v]) carries[labels[weld.of[v]]] = 1;
    Eigen::MatrixXf means = Eigen::MatrixXf::Zero(pieces, rest + 1);
    const PointsD positions = bind_positions(character, static_cast<int>(p));
    if (skin.triangles.rows() > 0) {
      const SurfaceQuery query(skin.positions, skin.triangles);
      for (std::size_t v = 0; v < weld.of.size(); ++v) {
        const int piece = labels[weld.of[v]];
        if (carries[piece]) continue;
        const auto hit = query.closest(positions.row(static_cast<Eigen::Index>(v)).transpose());
        means.row(piece) += skin.rows[skin.triangles(hit.triangle, 0)];
      }
    }
    for (std::size_t v = 0; v < weld.of.size(); ++v) {
      if (reach.reached[p][v]) continue;
      const auto row = static_cast<Eigen::Index>(v);
      const int piece = labels[weld.of[v]];
      const float sum = means.row(piece).sum();
      if (sum > 0)
        reach.shares[p].row(row) = means.row(piece) / sum;
      else
        reach.shares[p](row, rest) = 1;
    }
    shares_.emplace_back();
    for (Eigen::Index f = 0; f <= rest; ++f) shares_.back().push_back(reach.shares[p].col(f));
  }
}

}  // namespace mien::detail
