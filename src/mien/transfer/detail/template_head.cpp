#include "mien/transfer/detail/template_head.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mien/core/error.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/openness.h"
#include "mien/transfer/detail/face_size.h"
#include "mien/transfer/detail/inner_pieces.h"
#include "mien/transfer/detail/relief.h"

namespace mien::detail {
namespace {

constexpr int openness_rays = 32;
constexpr int most_samples = 1200;
/// Where the face's attention has fallen to 1/e, and what is left far away.
constexpr double face_radius = 0.5, least_attention = 0.1;
/// Skin that sees less of the open air is a cavity.
constexpr double open_skin = 0.4;

PointsD positions_of(const std::vector<LandmarkPoint>& points) {
  PointsD positions(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    positions.row(static_cast<Eigen::Index>(i)) = points[i].position.transpose();
  return positions;
}

/// Farthest points by distance times attention, so that the face gets more.
std::vector<int> spread_samples(const TemplateHead& head, const Eigen::VectorXd& openness) {
  const Eigen::Index count = head.skin.positions.rows();
  Eigen::VectorXd gap = Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  for (Eigen::Index v = 0; v < count; ++v)
    if (openness[v] < open_skin) gap[v] = 0;
  std::vector<int> samples;
  Eigen::Index next = 0;
  head.skin.positions.rowwise().squaredNorm().minCoeff(&next);
  while (static_cast<int>(samples.size()) < most_samples) {
    samples.push_back(static_cast<int>(next));
    const Eigen::VectorXd from =
        (head.skin.positions.rowwise() - head.skin.positions.row(next)).rowwise().squaredNorm();
    gap = gap.cwiseMin(from);
    if (!(gap.cwiseProduct(head.attention).maxCoeff(&next) > 0)) break;
  }
  return samples;
}

std::vector<int> mirror_rows(const PointsD& points) {
  constexpr double same = 0.06;
  std::vector<int> mirror(static_cast<std::size_t>(points.rows()), -1);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::RowVector3d other(-points(i, 0), points(i, 1), points(i, 2));
    Eigen::Index best = 0;
    const double distance = (points.rowwise() - other).rowwise().norm().minCoeff(&best);
    if (distance < same) mirror[static_cast<std::size_t>(i)] = static_cast<int>(best);
  }
  for (std::size_t i = 0; i < mirror.size(); ++i)  // a pair is one both ways
    if (mirror[i] >= 0 && mirror[static_cast<std::size_t>(mirror[i])] != static_cast<int>(i)) mirror[i] = -1;
  return mirror;
}

}  // namespace

std::vector<LandmarkPoint> all_points(const Character& character) {
  std::vector<LandmarkPoint> points = landmark_points(character);
  Character corners;
  corners.nodes = character.nodes;
  corners.parts = character.parts;
  for (const LandmarkCurve& curve : character.curves)
    for (std::size_t i = 0; i < curve.points.size(); ++i)
      corners.landmarks.push_back({curve.name + " " + std::to_string(i), curve.points[i]});
  for (LandmarkPoint& point : landmark_points(corners)) points.push_back(std::move(point));
  return points;
}

TemplateHead make_template_head(const Character& like, const Eigen::Matrix3d& facing) {
  const std::vector<LandmarkPoint> points = all_points(like);
  if (points.size() < 4)
    throw invalid_input("landmarks", "the head to be like has " + std::to_string(points.size()),
                        "4 or more on its skin");
  const Pool pooled = pool(like);
  const PoolSurface skin = select_pieces(pooled, skin_pieces(pooled, like, points));
  if (skin.surface.triangles.rows() == 0)
    throw invalid_input("landmarks", "the head to be like has no faces under its landmarks",
                        "landmarks on the face's skin");
  const PointsD positions = positions_of(points);
  const double size = face_size(positions, skin.surface.positions);
  if (!(size > 0)) throw invalid_input("landmarks", "are all in one place", "landmarks all over the face");
  TemplateHead head;
  head.to_canonical.scale = 1 / size;
  head.to_canonical.rotation = facing;
  head.to_canonical.translation = -facing * positions.colwise().mean().transpose() / size;
  head.skin = {head.to_canonical(skin.surface.positions), skin.surface.triangles};
  head.points = head.to_canonical(positions);
  head.normals = vertex_normals(head.skin.positions, head.skin.triangles);
  head.attention =
      (-head.skin.positions.rowwise().squaredNorm() / (face_radius * face_radius)).array().exp() +
      least_attention;
  head.openness = openness(head.skin.positions, head.skin.triangles, openness_rays);
  head.relief = relief(head.skin, head.normals, relief_radius);
  head.samples = spread_samples(head, head.openness);
  head.mirror = mirror_rows(head.points);
  return head;
}

SoughtHead make_sought_head(const Character& target) {
  SoughtHead head;
  head.pool = pool(target);
  if (head.pool.triangles.rows() == 0) throw invalid_input("target", "has no faces", "a head");
  const Eigen::VectorXd areas = vertex_areas(head.pool.positions, head.pool.triangles);
  std::vector<double> area(static_cast<std::size_t>(head.pool.piece_count), 0);
  for (std::size_t v = 0; v < head.pool.piece.size(); ++v)
    area[static_cast<std::size_t>(head.pool.piece[v])] += areas[static_cast<Eigen::Index>(v)];
  for (std::size_t p = 0; p < area.size(); ++p) {
    const PieceKind kind = kind_from_name(head.pool.piece_name[p]);
    if (kind != PieceKind::skin && kind != PieceKind::other) area[p] *= 1e-6;
  }
  const auto largest = std::max_element(area.begin(), area.end()) - area.begin();
  head.skin = one_piece(head.pool, static_cast<int>(largest));
  const Surface& surface = head.skin.surface;
  if (surface.triangles.rows() == 0) throw invalid_input("target", "has no faces", "a head");
  head.normals = vertex_normals(surface.positions, surface.triangles);
  head.openness = openness(surface.positions, surface.triangles, openness_rays);
  const Eigen::RowVector3d low = surface.positions.colwise().minCoeff(),
                           high = surface.positions.colwise().maxCoeff();
  head.centre = (low + high) / 2;
  head.size = (high - low).norm();
  if (!(head.size > 0)) throw invalid_input("target", "has no size", "a head");
  return head;
}

}  // namespace mien::detail
