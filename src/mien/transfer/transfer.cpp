#include "mien/transfer/transfer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "mien/character/shown_parts.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/transfer/carry_objects.h"
#include "mien/transfer/carry_wires.h"
#include "mien/transfer/contact.h"
#include "mien/transfer/detail/assemble_target.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/eye_balls.h"
#include "mien/transfer/detail/run.h"

namespace mien {
namespace detail {
namespace {

/// Smaller displacements are sculpting noise, relative to the face's size.
constexpr double least_delta = 1e-5;
/// Where nothing was estimated there is no noise.
constexpr double least_twin_delta = 1e-9;
/// Radius over which areas are compared for the local scale, relative to the face's size.
constexpr double scale_radius = 0.2;

constexpr int step_count = 9;

}  // namespace

TransferResult Run::operator()() {
  check_request();
  step("landmarks", [&] { read_surfaces(); });
  step("skin deformation", [&] { find_guide(); });
  step("dense correspondence", [&] { find_places(); });
  step("joints", [&] { place_joints(); });
  step("shapes", [&] { carry_shapes(); });
  step("skin weights", [&] { carry_weights(); });
  step("UVs", [&] { carry_texture_coordinates(); });
  step("influence objects", [&] { carry_rig(); });
  step("clips", [&] { carry_clips(); });
  report_progress(options_.progress, "done", 1);
  return {std::move(result_), std::move(report_)};
}

template <class Work>
void Run::step(const char* name, const Work& work) {
  report_progress(options_.progress, name, static_cast<double>(report_.steps.size()) / step_count);
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  report_.steps.push_back({name, seconds.count()});
}

void Run::check_request() const {
  if (source_.parts.empty()) throw invalid_input("source", "has no mesh", "a rigged face");
  if (target_.parts.empty()) throw invalid_input("target", "has no mesh", "a face");
  if (source_.shapes.empty() && source_.skins.empty() && source_.objects.empty() && source_.wires.empty())
    throw invalid_input("source", "has neither shapes nor joints: there is no rig to transfer",
                        "a character with shapes, joints or both (`mien assemble` makes one of OBJ files)");
  if (!std::isfinite(options_.exaggeration))
    throw invalid_input("exaggeration", "is not a number", "a percentage");
  for (const auto& [name, value] : options_.shape_exaggeration) {
    if (find_shape(source_, name) < 0)
      throw invalid_input("exaggeration of " + name, "the source has no such shape",
                          "a name that `mien inspect` lists");
    if (!std::isfinite(value))
      throw invalid_input("exaggeration of " + name, "is not a number", "a percentage");
  }
}

void Run::read_surfaces() {
  report_.pairs = pair_landmarks(source_, target_);
  source_pool_ = pool(source_);
  target_pool_ = pool(target_);
  source_skin_ = skin_pieces(source_pool_, source_, report_.pairs.source);
  target_skin_ = skin_pieces(target_pool_, target_, report_.pairs.target);
  source_surface_ = select_pieces(source_pool_, source_skin_);
  target_surface_ = select_pieces(target_pool_, target_skin_);
  for (const auto* side : {&source_surface_, &target_surface_})
    if (side->surface.triangles.rows() == 0)
      throw invalid_input(side == &source_surface_ ? "source" : "target", "has no faces under its landmarks",
                          "landmarks on the face's skin");
  const auto& left = report_.pairs.only_source;
  if (!left.empty())
    warn(std::to_string(left.size()) + " source landmarks have no partner on the target (" + left.front() +
             " ...)",
         "nothing, if that is meant; name them alike on both sides otherwise");
}

PointsD Run::pooled_delta(const Shape& shape) const {
  PointsD delta = PointsD::Zero(source_pool_.positions.rows(), 3);
  for (const PartDelta& part : shape.parts) {
    const Eigen::Matrix3d linear = source_pool_.part_matrix[at(part.part)].topLeftCorner<3, 3>();
    const auto& welded = source_pool_.welded[at(part.part)];
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
      delta.row(welded[at(part.vertices[i])]) =
          (linear * part.deltas.row(static_cast<Eigen::Index>(i)).transpose().cast<double>()).transpose();
  }
  return delta;
}

double Run::exaggeration_of(const std::string& shape) const {
  const auto found = options_.shape_exaggeration.find(shape);
  return options_.exaggeration * (found == options_.shape_exaggeration.end() ? 1.0 : found->second);
}

void Run::find_scale() {
  const Triangles& triangles = source_surface_.surface.triangles;
  maps_.scale = local_scale(maps_.aligned, registration_.guide, triangles, scale_radius * registration_.unit);
  if (twin_) keep_scale(kept_, maps_.aligned, triangles, registration_.unit, maps_.scale);
}

void Run::carry_shapes() {
  const std::size_t count = source_.shapes.size();
  report_.flips.assign(count, 0);
  report_.source_flips.assign(count, 0);
  if (model_ != DeltaModel::thesis || has_control_points()) find_scale();
  if (count == 0) return;
  result_.sliders = source_.sliders;
  result_.correctives = source_.correctives;
  result_.expressions = source_.expressions;
  const auto skin_delta = [&](std::size_t s) {
    return PointsD(pooled_delta(source_.shapes[s])(source_surface_.vertices, Eigen::all));
  };
  if (twin_ && model_ == DeltaModel::automatic) model_ = DeltaModel::local;
  ContactModel contact(source_surface_.surface, registration_, maps_);
  std::vector<std::string> names;
  for (const Shape& shape : source_.shapes) names.push_back(shape.name);
  const bool close_lids =
      options_.close_lids && !thesis() && !(twin_ && twin_skin_.whole()) &&
      (model_ == DeltaModel::automatic || model_ == DeltaModel::local || model_ == DeltaModel::warp);
  if (close_lids || model_ == DeltaModel::automatic) contact.look_at_shapes(names, skin_delta);
  report_.deltas = contact.decide(model_);
  if (twin_) report_.deltas.reason = "the target is the source's own surface with another mesh";

  result_.shapes.resize(count);
  const RigMap rig = rig_map();
  const PieceInput pieces = piece_input();
  const double least = twin_ ? least_twin_delta : least_delta;
  const std::vector<Ball> balls = thesis() ? std::vector<Ball>() : eye_balls(pieces, plans_);
  parallel_for(count, 1, [&](std::size_t begin, std::size_t) {
    const std::size_t s = begin;
    const Shape& shape = source_.shapes[s];
    const PointsD pooled = pooled_delta(shape);
    const PointsD source_rows = pooled(source_surface_.vertices, Eigen::all);
    PointsD moved = carry_deltas(maps_, model_, report_.deltas.warp_share, source_rows);
    if (close_lids) {
      const double share = contact.lid_warp_share(s, moved);
      if (share > 0)
        moved = (1 - share) * moved + share * carry_deltas(maps_, DeltaModel::warp, 1, source_rows);
      contact.close_lids(s, moved);
    }
    const double exaggeration = exaggeration_of(shape.name);
    const PointsD exaggerated = exaggeration * pooled;
    PointsD skin = exaggeration * PointsD((*carrier_)(moved));
    if (evening_) skin = *evening_ * skin;
    if (close_lids && contact.closes_lid(s)) keep_out_of_eyes(balls, target_surface_.surface.positions, skin);
    PointsD target = PointsD::Zero(target_pool_.positions.rows(), 3);
    for (std::size_t r = 0; r < target_surface_.vertices.size(); ++r)
      target.row(target_surface_.vertices[r]) = skin.row(static_cast<Eigen::Index>(r));
    for (const PiecePlan& plan : plans_) {
      const PointsD piece = carry_piece(pieces, plan, exaggerated, skin);
      for (std::size_t i = 0; i < plan.vertices.size(); ++i)
        target.row(plan.vertices[i]) = piece.row(static_cast<Eigen::Index>(i));
    }
    if (twin_)
      set_twin_rows(*twin_, source_pool_.triangles, twin_->placement.of_vectors(exaggerated), target);
    count_flips(s, source_rows, skin);
    result_.shapes[s] = shape_of_target(shape, target_pool_, result_, target, least * registration_.unit);
    result_.shapes[s].wires = carry_wire_moves(source_, shape.wires, rig, exaggeration);
    result_.shapes[s].objects = carry_object_moves(source_, shape.objects, rig, exaggeration);
  });
}

void Run::count_flips(std::size_t shape, const PointsD& source_rows, const PointsD& target_rows) {
  report_.source_flips[shape] = flipped_triangles(source_surface_.surface, source_rows);
  report_.flips[shape] = flipped_triangles(target_surface_.surface, target_rows);
}

}  // namespace detail

std::string_view name_of(Correspondence correspondence) {
  constexpr std::array<std::string_view, 3> names{"auto", "uvs", "surfaces"};
  return names[static_cast<std::size_t>(correspondence)];
}

TransferResult transfer(const Character& source, const Character& target, const TransferOptions& options) {
  using detail::Run;
  const std::size_t shown = shown_part_count(target);
  if (shown == target.parts.size() && shown_part_count(source) == source.parts.size())
    return Run(source, target, options)();
  const Character seen_source = only_shown(source), seen_target = only_shown(target);
  TransferResult result = Run(seen_source, seen_target, options)();
  for (std::size_t p = seen_source.parts.size(); p < source.parts.size(); ++p)
    result.report.guide.push_back(source.parts[p].mesh.positions);
  for (std::size_t p = shown; p < target.parts.size(); ++p) {
    result.character.parts.push_back(target.parts[p]);
    const Eigen::Index count = target.parts[p].mesh.positions.rows();
    result.report.distance.push_back(Eigen::VectorXf::Zero(count));
    result.report.filled.push_back(Eigen::VectorXf::Zero(count));
  }
  return result;
}

}  // namespace mien
