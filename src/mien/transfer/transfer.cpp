#include "mien/transfer/transfer.h"

#include <algorithm>
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
#include "mien/transfer/detail/face_size.h"
#include "mien/transfer/detail/run.h"
#include "mien/transfer/thesis.h"

namespace mien {
namespace detail {
namespace {

/// Smaller displacements are sculpting noise, relative to the face's size.
constexpr double least_delta = 1e-5;
/// Where nothing was estimated there is no noise.
constexpr double least_twin_delta = 1e-9;
/// Radius over which areas are compared for the local scale, relative to the face's size.
constexpr double scale_radius = 0.2;

/// Points of the guide: the dense spline goes through the first, contacts look at all.
constexpr std::size_t spline_samples = 500;
constexpr int most_samples = 1000;

/// How far the chords of a twin's triangles may cut below the source, relative to the face's size.
constexpr double kept_reach = 0.02;

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

/// None in what was found; given ones among them count as much as their share: a few that pull alone would dent the guide
/// around them. A curve's samples are named after it.
Eigen::VectorXd Run::trust_in(const std::vector<std::string>& landmarks) const {
  const auto found = [&](const std::string& name) {
    const auto& all = options_.found_landmarks;
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  Eigen::VectorXd given = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(landmarks.size()));
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (found(landmarks[i]) || found(landmarks[i].substr(0, landmarks[i].rfind('.'))))
      given[static_cast<Eigen::Index>(i)] = 0;
  return given.mean() * given;
}

void Run::find_guide() {
  const PointsD from = report_.pairs.source_positions(), to = report_.pairs.target_positions();
  landmark_spline_ = std::make_unique<ThinPlateSpline>(from, to);
  if (thesis()) {
    registration_ = thesis_registration(source_surface_.surface, target_surface_.surface, from, to);
  } else if (!register_twin(from, to)) {
    RegistrationOptions registration;
    registration.landmark_trust = trust_in(report_.pairs.names);
    registration.landmarks_hold = options_.landmarks_hold;
    registration.progress = options_.progress;
    registration_ =
        register_surfaces(source_surface_.surface, target_surface_.surface, from, to, registration);
    if (twin_) keep_twin();
  }
  report_.similarity = registration_.similarity;
  report_.unit = registration_.unit;
  maps_.positions = source_surface_.surface.positions;
  maps_.similarity = registration_.similarity;
  maps_.aligned = registration_.similarity(maps_.positions);
  maps_.landmarks = landmark_spline_.get();
  maps_.landmark_image = (*landmark_spline_)(maps_.positions);
  model_ = thesis() && options_.deltas == DeltaModel::automatic ? DeltaModel::thesis : options_.deltas;
  if (thesis() && options_.deltas != DeltaModel::warp) return;
  maps_.samples = farthest_points(maps_.aligned, most_samples);
  dense_ = std::make_unique<ThinPlateSpline>(
      dense_spline(maps_.aligned, registration_.guide, registration_.similarity(from), to,
                   std::span(maps_.samples).first(std::min(maps_.samples.size(), spline_samples))));
  maps_.dense = dense_.get();
  maps_.dense_image = (*dense_)(maps_.aligned);
}

/// Looks whether the target is the source with another mesh; true where no registration is needed then.
bool Run::register_twin(const PointsD& from, const PointsD& to) {
  twin_ =
      find_twin({source_pool_.positions, source_pool_.triangles},
                {target_pool_.positions, target_pool_.triangles}, {Similarity{}, fit_similarity(from, to)});
  if (!twin_) return false;
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  twin_skin_ = twin_of_surfaces(*twin_, source_surface_, target_surface_, source_pool_.triangles.rows());
  if (!twin_skin_.whole()) return false;
  registration_.similarity = twin_->placement;
  registration_.unit = face_size(to, target.positions);
  registration_.guide = twin_->placement(source.positions);
  kept_.assign(static_cast<std::size_t>(source.positions.rows()), 1);
  return true;
}

/// After a registration: what is the source's own surface stays exactly that.
void Run::keep_twin() {
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  registration_.similarity = twin_->placement;
  kept_ = kept_vertices(twin_skin_, source, target, kept_reach * registration_.unit);
  settle_guide(twin_skin_, kept_, source, registration_.guide);
}

std::vector<SourcePoint> Run::find_points() const {
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  if (thesis()) return thesis_correspondence(registration_, source, target);
  if (twin_ && twin_skin_.whole()) return twin_skin_.points;
  std::vector<SourcePoint> points = find_correspondence(registration_, source, target);
  TearInput tears{source_.shapes.size(),
                  [&](std::size_t s) {
                    return registration_.similarity.of_vectors(
                        pooled_delta(source_.shapes[s])(source_surface_.vertices, Eigen::all));
                  },
                  {},
                  registration_.unit};
  if (source_weights_.rows() > 0) tears.weights = select_rows(source_weights_, source_surface_.vertices);
  reject_torn(tears, source, target, points);
  for (std::size_t v = 0; v < twin_skin_.points.size(); ++v)
    if (twin_skin_.points[v].accepted) points[v] = twin_skin_.points[v];
  return points;
}

/// The skin is where the guide is; the spline takes along what lies inside.
void Run::warp_source() {
  warped_source_.resize(source_pool_.positions.rows(), 3);
  for (std::size_t r = 0; r < source_surface_.vertices.size(); ++r)
    warped_source_.row(source_surface_.vertices[r]) = registration_.guide.row(static_cast<Eigen::Index>(r));
  std::vector<int> inside;
  for (std::size_t v = 0; v < source_pool_.piece.size(); ++v)
    if (!source_skin_[at(source_pool_.piece[v])]) inside.push_back(static_cast<int>(v));
  const PointsD positions = source_pool_.positions(inside, Eigen::all);
  warped_source_(inside, Eigen::all) =
      thesis() ? (*landmark_spline_)(positions) : (*dense_)(registration_.similarity(positions));
}

void Run::find_places() {
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  if (!source_.skins.empty())
    source_weights_ = pooled_skin_weights(source_, source_pool_, list_joints(source_));
  carrier_ = std::make_unique<AttributeCarrier>(find_points(), source, target);
  warp_source();
  piece_motions_ = piece_motions(
      source_pool_, source_skin_, source_.shapes.size(),
      [&](std::size_t s) { return pooled_delta(source_.shapes[s]); }, source_weights_,
      registration_.unit / registration_.similarity.scale);
  plans_ = plan_pieces(piece_input());
  for (const PiecePlan& plan : plans_)
    report_.pieces.push_back({target_pool_.piece_name[at(plan.piece)], std::string(name_of(plan.kind)),
                              std::string(name_of(plan.way))});
  if (has_control_points()) {
    aligned_query_ = std::make_unique<SurfaceQuery>(maps_.aligned, source.triangles);
    target_query_ = std::make_unique<SurfaceQuery>(target.positions, target.triangles);
  }
  report_maps();
}

PieceInput Run::piece_input() const {
  return {source_pool_,
          target_pool_,
          source_skin_,
          target_skin_,
          target_surface_,
          warped_source_,
          registration_.similarity,
          piece_motions_,
          registration_.unit};
}

void Run::report_maps() {
  for (std::size_t p = 0; p < source_.parts.size(); ++p) {
    Points positions(source_.parts[p].mesh.positions.rows(), 3);
    for (Eigen::Index v = 0; v < positions.rows(); ++v)
      positions.row(v) =
          warped_source_.row(source_pool_.welded[p][static_cast<std::size_t>(v)]).cast<float>();
    report_.guide.push_back(std::move(positions));
  }
  std::vector<char> filled(carrier_->correspondence().size(), 0);
  for (const int v : carrier_->filled()) filled[at(v)] = 1;
  for (std::size_t p = 0; p < target_.parts.size(); ++p) {
    const Eigen::Index count = target_.parts[p].mesh.positions.rows();
    Eigen::VectorXf distance = Eigen::VectorXf::Zero(count), fill = Eigen::VectorXf::Zero(count);
    for (Eigen::Index v = 0; v < count; ++v) {
      const int r = target_surface_.row_of[at(target_pool_.welded[p][static_cast<std::size_t>(v)])];
      if (r < 0) continue;
      distance[v] = static_cast<float>(carrier_->correspondence()[at(r)].distance / registration_.unit);
      fill[v] = filled[at(r)];
    }
    report_.distance.push_back(std::move(distance));
    report_.filled.push_back(std::move(fill));
  }
  const double share = static_cast<double>(carrier_->filled().size()) / static_cast<double>(filled.size());
  if (share > 0.1)
    warn("the guide reaches only " + std::to_string(static_cast<int>(100 * (1 - share))) +
             " % of the target's skin",
         "look at the error map; landmarks on the part that the source lacks do not help, more on the face "
         "may");
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
