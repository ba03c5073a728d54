// Embree keeps floats; hits are therefore refined here in double from the caller's own positions, so that a
// point on a vertex comes back as that vertex. Embree's robust mode matters: without it rays slip through
// shared edges of lips.
#include "mien/geometry/surface_query.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mien/core/error.h"
#include "mien/geometry/triangle.h"

namespace mien {

struct SurfaceQuery::Scene {
  PointsD positions;
  Triangles triangles;
  Points embree_positions;
  double slack = 0;  // see reach_of
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Scene() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  Eigen::Vector3d corner(int triangle, int k) const {
    return positions.row(triangles(triangle, k)).transpose();
  }
};

namespace {

constexpr int no_triangle = std::numeric_limits<int>::max();
using Alike = SurfaceQuery::Alike;

/// Equally close triangles: the one of the lowest number.
bool is_closer(const SurfaceQuery::Hit& best, int triangle, double distance) {
  return distance < best.distance || (distance == best.distance && triangle < best.triangle);
}

/// The slack, what floats lose of a place, keeps equally close triangles in the search: the tie goes to the lowest number.
float reach_of(double distance, double slack) {
  return static_cast<float>(distance * (1 + 1e-6) + slack);
}

bool shrink(RTCPointQuery& query, double distance, double slack) {
  const float radius = reach_of(distance, slack);
  if (radius >= query.radius) return false;
  query.radius = radius;
  return true;
}

struct ClosestSearch {
  const PointsD& positions;
  const Triangles& triangles;
  double slack;
  const SurfaceQuery::Accept* accept;
  Eigen::Vector3d point;
  SurfaceQuery::Hit best;
};

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
  auto& search = *static_cast<ClosestSearch*>(args->userPtr);
  const int t = static_cast<int>(args->primID);
  const auto corner = [&](int k) { return Eigen::Vector3d(search.positions.row(search.triangles(t, k))); };
  const TrianglePoint found = closest_point_on_triangle(search.point, corner(0), corner(1), corner(2));
  const double distance = (found.position - search.point).norm();
  if (!is_closer(search.best, t, distance) || (search.accept && !(*search.accept)(t, found.position)))
    return false;
  search.best = {t, found.barycentric, found.position, distance};
  return shrink(*args->query, distance, search.slack);
}

struct AlikeSearch {
  const PointsD& positions;
  const SurfaceQuery::Attributes& attributes;
  const Triangles& triangles;
  double slack;
  Alike point;
  SurfaceQuery::Hit best;
};

/// Whether triangle `t` is closer than the best one so far.
bool look_at_alike(AlikeSearch& search, int t) {
  const auto triangle = static_cast<std::size_t>(t);
  const double least =
      (search.point - search.attributes.centres[triangle]).norm() - search.attributes.radii[triangle];
  if (least * (1 - 1e-9) > search.best.distance) return false;
  Alike corner[3];
  for (int k = 0; k < 3; ++k) {
    const int v = search.triangles(t, k);
    corner[k] << search.positions.row(v).transpose(), search.attributes.values.row(v).transpose();
  }
  const Eigen::Vector3d weights = closest_barycentric<Alike>(search.point, corner[0], corner[1], corner[2]);
  const Alike found = weights[0] * corner[0] + weights[1] * corner[1] + weights[2] * corner[2];
  const double distance = (found - search.point).norm();
  if (!is_closer(search.best, t, distance)) return false;
  search.best = {t, weights, found.head<3>(), distance};
  return true;
}

bool visit_alike(RTCPointQueryFunctionArguments* args) {
  auto& search = *static_cast<AlikeSearch*>(args->userPtr);
  return look_at_alike(search, static_cast<int>(args->primID)) &&
         shrink(*args->query, search.best.distance, search.slack);
}

/// Runs `visit` over the triangles around `point`, the nearest boxes first.
void query_around(RTCScene scene, const Eigen::Vector3d& point, double radius, RTCPointQueryFunction visit,
                  void* search) {
  RTCPointQuery query{};
  query.x = static_cast<float>(point.x());
  query.y = static_cast<float>(point.y());
  query.z = static_cast<float>(point.z());
  query.radius = static_cast<float>(radius);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &query, &context, visit, search);
}

void check_input(const PointsD& positions, const Triangles& triangles) {
  if (triangles.rows() == 0) throw invalid_input("surface query", "has no triangles", "a mesh with faces");
  if (triangles.minCoeff() < 0 || triangles.maxCoeff() >= positions.rows())
    throw invalid_input("surface query", "a triangle names a vertex out of range",
                        "vertices from 0 to " + std::to_string(positions.rows() - 1));
  if (!positions.allFinite()) throw invalid_input("surface query", "a position is not finite");
}

RTCRay make_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near, double far) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = static_cast<float>(near);
  ray.tfar = static_cast<float>(far);
  ray.mask = ~0u;
  return ray;
}

}  // namespace

SurfaceQuery::SurfaceQuery(const Points& positions, const Triangles& triangles)
    : SurfaceQuery(PointsD(positions.cast<double>()), triangles) {}

SurfaceQuery::SurfaceQuery(const PointsD& positions, const Triangles& triangles, Build build)
    : scene_(std::make_unique<Scene>()) {
  check_input(positions, triangles);
  scene_->positions = positions;
  scene_->triangles = triangles;
  scene_->slack = 4 * std::numeric_limits<float>::epsilon() * positions.cwiseAbs().maxCoeff();
  // Embree reads 16 bytes at the last vertex: one row of padding.
  scene_->embree_positions = Points::Zero(positions.rows() + 1, 3);
  scene_->embree_positions.topRows(positions.rows()) = positions.cast<float>();
  scene_->device = rtcNewDevice(nullptr);
  scene_->scene = rtcNewScene(scene_->device);
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  const RTCBuildQuality quality = build == Build::fast ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
  rtcSetSceneBuildQuality(scene_->scene, quality);
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             scene_->embree_positions.data(), 0, 3 * sizeof(float), positions.rows());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, scene_->triangles.data(),
                             0, 3 * sizeof(int), triangles.rows());
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

SurfaceQuery::Hit SurfaceQuery::closest(const Eigen::Vector3d& point, double max_distance) const {
  return closest(point, max_distance, nullptr);
}

SurfaceQuery::Hit SurfaceQuery::closest(const Eigen::Vector3d& point, double max_distance,
                                        const Accept& accept) const {
  ClosestSearch search{
      scene_->positions, scene_->triangles, scene_->slack, accept ? &accept : nullptr, point, {}};
  search.best.distance = max_distance;
  search.best.triangle = no_triangle;
  query_around(scene_->scene, point, max_distance, visit_triangle, &search);
  return search.best.triangle == no_triangle ? Hit{} : search.best;
}

SurfaceQuery::Attributes SurfaceQuery::with(PointsD values) const {
  const Triangles& triangles = scene_->triangles;
  Attributes result{std::move(values), std::vector<Alike>(static_cast<std::size_t>(triangles.rows())),
                    std::vector<double>(static_cast<std::size_t>(triangles.rows()))};
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    Alike corner[3];
    for (int k = 0; k < 3; ++k)
      corner[k] << scene_->positions.row(triangles(t, k)).transpose(),
          result.values.row(triangles(t, k)).transpose();
    const Alike centre = (corner[0] + corner[1] + corner[2]) / 3;
    double square = 0;
    for (const Alike& c : corner) square = std::max(square, (c - centre).squaredNorm());
    result.centres[static_cast<std::size_t>(t)] = centre;
    result.radii[static_cast<std::size_t>(t)] = std::sqrt(square);
  }
  return result;
}

SurfaceQuery::Hit SurfaceQuery::most_alike(const Eigen::Vector3d& point, const Eigen::Vector3d& attribute,
                                           const Attributes& attributes, int guess) const {
  AlikeSearch search{scene_->positions, attributes, scene_->triangles, scene_->slack, {}, {}};
  search.point << point, attribute;
  search.best.triangle = no_triangle;
  if (guess >= 0) look_at_alike(search, guess);
  query_around(scene_->scene, point, reach_of(search.best.distance, search.slack), visit_alike, &search);
  if (search.best.triangle == no_triangle) return Hit{};
  search.best.distance = (search.best.position - point).norm();
  return search.best;
}

SurfaceQuery::Hit SurfaceQuery::first_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                            double near, double far) const {
  RTCRayHit ray{};
  ray.ray = make_ray(origin, direction, near, far);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Hit{};
  const int t = static_cast<int>(ray.hit.primID);
  const Eigen::Vector3d weights(1.0 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v);
  const Eigen::Vector3d position = weights[0] * scene_->corner(t, 0) + weights[1] * scene_->corner(t, 1) +
                                   weights[2] * scene_->corner(t, 2);
  return {t, weights, position, static_cast<double>(ray.ray.tfar)};
}

bool SurfaceQuery::occluded(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near,
                            double far) const {
  RTCRay ray = make_ray(origin, direction, near, far);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene, &context, &ray);
  return ray.tfar < 0;
}

int SurfaceQuery::count_free(const Eigen::Vector3d& origin, const PointsD& directions, double far) const {
  constexpr int packet = 16;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  int free = 0;
  for (Eigen::Index first = 0; first < directions.rows(); first += packet) {
    RTCRay16 rays{};
    alignas(64) int valid[packet];
    const int count = static_cast<int>(std::min<Eigen::Index>(packet, directions.rows() - first));
    for (int i = 0; i < packet; ++i) {
      valid[i] = i < count ? -1 : 0;
      const Eigen::Index r = first + std::min(i, count - 1);
      rays.org_x[i] = static_cast<float>(origin.x());
      rays.org_y[i] = static_cast<float>(origin.y());
      rays.org_z[i] = static_cast<float>(origin.z());
      rays.dir_x[i] = static_cast<float>(directions(r, 0));
      rays.dir_y[i] = static_cast<float>(directions(r, 1));
      rays.dir_z[i] = static_cast<float>(directions(r, 2));
      rays.tfar[i] = static_cast<float>(far);
      rays.mask[i] = ~0u;
    }
    rtcOccluded16(valid, scene_->scene, &context, &rays);
    for (int i = 0; i < count; ++i) free += !(rays.tfar[i] < 0);
  }
  return free;
}

}  // namespace mien
