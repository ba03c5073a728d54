#include "mien/transfer/thesis.h"

#include "mien/core/parallel.h"
#include "mien/geometry/surface_query.h"
#include "mien/geometry/thin_plate_spline.h"
#include "mien/transfer/detail/face_size.h"

namespace mien {
namespace {

std::vector<SurfaceQuery::Hit> closest_points(const PointsD& points, const PointsD& positions,
                                              const Triangles& triangles) {
  const SurfaceQuery query(positions, triangles);
  std::vector<SurfaceQuery::Hit> hits(static_cast<std::size_t>(points.rows()));
  parallel_for(hits.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      hits[v] = query.closest(points.row(static_cast<Eigen::Index>(v)).transpose());
  });
  return hits;
}

}  // namespace

Registration thesis_registration(const Surface& source, const Surface& target,
                                 const PointsD& source_landmarks, const PointsD& target_landmarks) {
  Registration result;
  result.similarity = fit_similarity(source_landmarks, target_landmarks);
  result.unit = detail::face_size(target_landmarks, target.positions);
  result.guide = ThinPlateSpline(source_landmarks, target_landmarks)(source.positions);
  const auto hits = closest_points(result.guide, target.positions, target.triangles);
  for (std::size_t v = 0; v < hits.size(); ++v)
    result.guide.row(static_cast<Eigen::Index>(v)) = hits[v].position.transpose();
  return result;
}

std::vector<SourcePoint> thesis_correspondence(const Registration& registration, const Surface& source,
                                               const Surface& target) {
  const auto hits = closest_points(target.positions, registration.guide, source.triangles);
  std::vector<SourcePoint> points;
  points.reserve(hits.size());
  for (const auto& hit : hits) points.push_back({hit.triangle, hit.barycentric, hit.distance, true});
  return points;
}

}  // namespace mien
