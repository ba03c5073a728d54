// What hangs on the skin: nodes, skin weights, UVs, influence objects, wires, constraints, controls and clips.
#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <numeric>

#include "mien/core/parallel.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/moving_similarity.h"
#include "mien/geometry/surface_query.h"
#include "mien/texture/retexture.h"
#include "mien/transfer/carry_clips.h"
#include "mien/transfer/carry_constraints.h"
#include "mien/transfer/carry_objects.h"
#include "mien/transfer/carry_wires.h"
#include "mien/transfer/detail/assemble_target.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/pool_uvs.h"
#include "mien/transfer/detail/run.h"

namespace mien::detail {
namespace {

/// The blur of each point on the joints, relative to the face's size.
constexpr double joint_softness = 0.005;
/// The guide is on the target where it is this close, in face sizes, and turned this much at most; what it counts elsewhere.
constexpr double guide_reach = 0.01, guide_cosine = 0.5, unmatched_trust = 0.01;
/// Smaller skin weights are rounding even where nothing was estimated.
constexpr double least_twin_weight = 1e-6;

/// Each to itself.
std::vector<int> identity(std::size_t count) {
  std::vector<int> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// Sets rows `rows` of a matrix that grows entry by entry.
void append(const WeightMatrix& values, const std::vector<int>& rows,
            std::vector<Eigen::Triplet<double>>& entries) {
  for (Eigen::Index r = 0; r < values.outerSize(); ++r)
    for (WeightMatrix::InnerIterator entry(values, r); entry; ++entry)
      entries.emplace_back(rows[static_cast<std::size_t>(r)], static_cast<int>(entry.col()), entry.value());
}

}  // namespace

/// #V of the source's skin: 1 where the guide lies on the target, facing its way; little elsewhere, where the target has no
/// such place and the guide is only carried along: cavities of a head that has none.
Eigen::VectorXd Run::guide_trust() const {
  const Triangles& triangles = target_surface_.surface.triangles;
  const PointsD& target = target_surface_.surface.positions;
  const PointsD normals = vertex_normals(registration_.guide, source_surface_.surface.triangles);
  const SurfaceQuery skin(target, triangles);
  Eigen::VectorXd trust = Eigen::VectorXd::Constant(normals.rows(), 1);
  parallel_for(static_cast<std::size_t>(normals.rows()), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Index row = static_cast<Eigen::Index>(v);
      const SurfaceQuery::Hit hit = skin.closest(registration_.guide.row(row).transpose());
      const auto corner = [&](int k) {
        return Eigen::Vector3d(target.row(triangles(hit.triangle, k)).transpose());
      };
      const Eigen::Vector3d faces = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      const bool there =
          hit.distance <= guide_reach * registration_.unit && normals.row(row).dot(faces) > guide_cosine;
      if (!there) trust[row] = unmatched_trust;
    }
  });
  return trust;
}

SpaceMap Run::space_map() const {
  const Similarity& similarity = registration_.similarity;
  SpaceMap map;
  if (thesis()) {
    map.position = [this](const Eigen::Vector3d& x) { return (*landmark_spline_)(x); };
    map.rotation = [this](const Eigen::Vector3d& x) {
      return closest_rotation(landmark_spline_->jacobian(x));
    };
    map.scale = [this](const Eigen::Vector3d& x) {
      return std::cbrt(std::abs(landmark_spline_->jacobian(x).determinant()));
    };
    return map;
  }
  if (twin_ && twin_skin_.whole()) {
    map.position = [&similarity](const Eigen::Vector3d& x) { return similarity(x); };
    map.rotation = [&similarity](const Eigen::Vector3d&) { return similarity.rotation; };
    map.scale = [&similarity](const Eigen::Vector3d&) { return similarity.scale; };
    return map;
  }
  const PiecePoints inner = piece_points(piece_input(), plans_);
  const Eigen::Index skin = maps_.aligned.rows(), all = skin + inner.aligned.rows();
  PointsD from(all, 3), to(all, 3);
  from << maps_.aligned, inner.aligned;
  to << registration_.guide, inner.target;
  // A vertex counts by its area, so that dense eyes do not outweigh what lies nearer; a piece's point as a thousandth
  // of the skin.
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(all, 1e-3);
  const Eigen::VectorXd areas = vertex_areas(maps_.aligned, source_surface_.surface.triangles);
  weights.head(skin) = (areas / areas.sum()).cwiseMax(1e-9);
  if (carries_nodes() || has_control_points()) weights.head(skin).array() *= guide_trust().array();
  const auto local = std::make_shared<MovingSimilarity>(
      std::move(from), std::move(to), joint_softness * registration_.unit, std::move(weights));
  map.position = [local, &similarity](const Eigen::Vector3d& x) { return (*local)(similarity(x)); };
  map.rotation = [&similarity](const Eigen::Vector3d&) { return similarity.rotation; };
  map.scale = [local, &similarity](const Eigen::Vector3d& x) {
    return similarity.scale * local->at(similarity(x)).scale;
  };
  return map;
}

bool Run::carries_nodes() const {
  const auto& controls = source_.controls;
  return !source_.skins.empty() || !source_.objects.empty() || !source_.constraints.empty() ||
         std::any_of(controls.begin(), controls.end(), [](const Control& c) { return c.node >= 0; });
}

void Run::place_joints() {
  space_ = space_map();
  result_ = bare_target(target_, target_pool_, !source_.skins.empty());
  // Without joints to tell it by, a piece grows as the face does.
  for (PiecePlan& plan : plans_) {
    if (source_.skins.empty()) break;
    const Eigen::Vector3d centre =
        target_pool_.positions(plan.vertices, Eigen::all).colwise().mean().transpose();
    plan.growth = space_.scale(registration_.similarity.inverse()(centre));
  }
  if (!carries_nodes()) {
    skeleton_.node_of.assign(source_.nodes.size(), -1);
    return;
  }
  skeleton_ = carry_skeleton(source_, space_, static_cast<int>(result_.nodes.size()));
  result_.nodes.insert(result_.nodes.end(), skeleton_.nodes.begin(), skeleton_.nodes.end());
  if (!source_.skins.empty()) result_.skins.push_back(skeleton_.skin);
}

void Run::carry_weights() {
  if (source_.skins.empty()) return;
  const Eigen::Index joints = source_weights_.cols();
  const WeightMatrix skin_source = select_rows(source_weights_, source_surface_.vertices);
  const WeightMatrix skin = limit_influences((*carrier_)(skin_source), options_.max_influences);
  Eigen::Index head_joint = 0;
  Eigen::VectorXd total = Eigen::VectorXd::Zero(joints);
  for (Eigen::Index v = 0; v < skin.outerSize(); ++v)
    for (WeightMatrix::InnerIterator entry(skin, v); entry; ++entry) total[entry.col()] += entry.value();
  total.maxCoeff(&head_joint);

  std::vector<Eigen::Triplet<double>> entries;
  append(skin, target_surface_.vertices, entries);
  const PieceInput pieces = piece_input();
  for (const PiecePlan& plan : plans_)
    append(limit_influences(
               carry_piece_weights(pieces, plan, source_weights_, skin, static_cast<int>(head_joint)),
               options_.max_influences),
           plan.vertices, entries);
  WeightMatrix all(target_pool_.positions.rows(), joints);
  all.setFromTriplets(entries.begin(), entries.end());
  if (twin_)
    all = limit_influences(with_twin_rows(*twin_, source_pool_.triangles, source_weights_, all),
                           options_.max_influences, least_twin_weight);
  for (std::size_t p = 0; p < result_.parts.size(); ++p) {
    result_.parts[p].skin = 0;
    result_.parts[p].skin_weights = to_skin_weights(all, target_pool_.welded[p]);
  }
}

void Run::carry_texture_coordinates() {
  const auto source = uv_layout(source_, source_pool_, source_surface_);
  if (!source) return;
  const int material = skin_material(source_, source_pool_, source_surface_);
  int shared = -1;
  for (std::size_t p = 0; p < result_.parts.size(); ++p) {
    Mesh& mesh = result_.parts[p].mesh;
    if (!mesh.uvs.empty() && !options_.replace_uvs) continue;
    assign_uvs(*source, registration_.guide, target_pool_, target_surface_, static_cast<int>(p), mesh);
    if (material < 0 || mesh.uvs.empty()) continue;
    if (shared < 0) shared = copy_material(source_, material, result_.appearance);
    hang_material(shared, result_.appearance, mesh);
  }
}

RigMap Run::rig_map() const {
  RigMap map;
  map.space = space_;
  map.move = [this](const PointsD& at, const PointsD& moves) { return move(at, moves); };
  map.rows = [this](const WeightMatrix& rows) { return carry_rows(rows); };
  map.surface_point = [this](const SurfacePoint& point) { return carry_point(point); };
  map.node_of = skeleton_.node_of;
  map.skin_joint = list_joints(source_).skin_joint;
  return map;
}

PointsD Run::move(const PointsD& at, const PointsD& moves) const {
  DeltaMaps maps;
  maps.positions = at;
  maps.similarity = registration_.similarity;
  maps.aligned = registration_.similarity(at);
  maps.dense = dense_.get();
  maps.landmarks = landmark_spline_.get();
  // Control points lie near the skin, not on it: they move as the skin nearest to them.
  const Triangles& triangles = source_surface_.surface.triangles;
  maps.scale.resize(at.rows());
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    const SurfaceQuery::Hit hit = aligned_query_->closest(maps.aligned.row(i).transpose());
    maps.scale[i] = 0;
    for (int k = 0; k < 3; ++k) maps.scale[i] += hit.barycentric[k] * maps_.scale[triangles(hit.triangle, k)];
  }
  return carry_deltas(maps, model_, report_.deltas.warp_share, moves);
}

WeightMatrix Run::carry_rows(const WeightMatrix& rows) const {
  const std::vector<int> first = first_rows(source_);
  std::vector<int> copies;
  for (const auto& [part, vertex] : source_pool_.first_copy) copies.push_back(first[at(part)] + vertex);
  const WeightMatrix pooled = select_rows(rows, copies);
  const WeightMatrix skin = (*carrier_)(select_rows(pooled, source_surface_.vertices));
  std::vector<Eigen::Triplet<double>> entries;
  append(skin, target_surface_.vertices, entries);
  const PieceInput pieces = piece_input();
  for (const PiecePlan& plan : plans_) {
    WeightMatrix piece = carry_piece_rows(pieces, plan, pooled, skin);
    if (plan.way == PiecePlan::Way::attached)
      for (Eigen::Index i = 0; i < piece.rows(); ++i) piece.row(i) *= plan.fade[static_cast<std::size_t>(i)];
    append(piece, plan.vertices, entries);
  }
  WeightMatrix all(target_pool_.positions.rows(), rows.cols());
  all.setFromTriplets(entries.begin(), entries.end());
  if (twin_) all = with_twin_rows(*twin_, source_pool_.triangles, pooled, all);
  std::vector<int> row_of;
  for (const std::vector<int>& welded : target_pool_.welded)
    row_of.insert(row_of.end(), welded.begin(), welded.end());
  return select_rows(all, row_of);
}

std::optional<SurfacePoint> Run::carry_point(const SurfacePoint& point) const {
  const std::size_t part = at(point.part);
  const Eigen::Vector3d place = position_of(source_.parts[part].mesh, report_.guide[part], point);
  return surface_point(target_pool_, target_surface_, target_query_->closest(place));
}

void Run::warn_of_dropped(const std::vector<std::string>& dropped, const std::string& what,
                          const std::string& remedy) {
  if (dropped.empty()) return;
  warn(std::to_string(dropped.size()) + " " + what + " what the target does not get (" + dropped.front() +
           " ...)",
       remedy);
}

/// Sliders drive shapes: without shapes there are none.
std::vector<int> Run::carried_sliders() const {
  return source_.shapes.empty() ? std::vector<int>(source_.sliders.size(), -1)
                                : identity(source_.sliders.size());
}

void Run::carry_rig() {
  std::vector<std::string> dropped;
  const RigMap map = rig_map();
  result_.objects = carry_objects(source_, result_, map, dropped);
  result_.wires = carry_wires(source_, result_, map);
  result_.constraints = carry_constraints(source_, result_, map, dropped);
  result_.controls = carry_controls(source_, carried_sliders(), skeleton_.node_of, dropped);
  warn_of_dropped(dropped, "objects, constraints or controls name",
                  "have them name joints or nodes without a mesh on the source");
}

void Run::carry_clips() {
  if (source_.clips.empty()) return;
  const RigMap rig = rig_map();
  ClipMap map;
  map.nodes = node_motions(source_, skeleton_);
  map.shape_of = identity(source_.shapes.size());
  map.slider_of = carried_sliders();
  map.wire_of = identity(source_.wires.size());
  map.object_of = identity(source_.objects.size());
  map.move = rig.move;
  map.rotation = rig.space.rotation;
  std::vector<std::string> dropped;
  for (const Clip& clip : source_.clips) result_.clips.push_back(carry_clip(source_, clip, map, dropped));
  warn_of_dropped(dropped, "channels animate",
                  "skin these parts to joints on the source to have them animated on the target");
}

}  // namespace mien::detail
