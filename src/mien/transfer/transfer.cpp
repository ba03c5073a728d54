#include "mien/transfer/transfer.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "mien/character/shown_parts.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/moving_similarity.h"
#include "mien/geometry/thin_plate_spline.h"
#include "mien/transfer/carry_skeleton.h"
#include "mien/transfer/carry_skin_weights.h"
#include "mien/transfer/carry_uvs.h"
#include "mien/transfer/contact.h"
#include "mien/transfer/correspondence.h"
#include "mien/transfer/detail/assemble_target.h"
#include "mien/transfer/detail/eye_balls.h"
#include "mien/transfer/detail/inner_pieces.h"
#include "mien/transfer/detail/pool.h"
#include "mien/transfer/register_surfaces.h"
#include "mien/transfer/thesis.h"

namespace mien {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// Smaller displacements are sculpting noise, relative to the face's size.
constexpr double least_delta = 1e-5;
/// Radius over which areas are compared for the local scale, relative to the face's size.
constexpr double scale_radius = 0.2;

/// Points of the guide: the dense spline goes through the first, contacts look at all.
constexpr std::size_t spline_samples = 500;
constexpr int most_samples = 1000;
/// The blur of each point on the joints, relative to the face's size.
constexpr double joint_softness = 0.005;

/// One transfer on its way: each step reads what the steps before left and adds its own.
class Run {
 public:
  Run(const Character& source, const Character& target, const TransferOptions& options)
      : source_(source), target_(target), options_(options) {}

  TransferResult operator()() {
    check_request();
    step("landmarks", [&] { read_surfaces(); });
    step("skin deformation", [&] { find_guide(); });
    step("dense correspondence", [&] { find_places(); });
    step("joints", [&] { place_joints(); });
    step("shapes", [&] { carry_shapes(); });
    step("skin weights", [&] { carry_weights(); });
    step("UVs", [&] { carry_texture_coordinates(); });
    step("clips", [&] { carry_clips(); });
    report_progress(options_.progress, "done", 1);
    return {std::move(result_), std::move(report_)};
  }

 private:
  template <class Work>
  void step(const char* name, const Work& work) {
    report_progress(options_.progress, name, static_cast<double>(report_.steps.size()) / 8);
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    report_.steps.push_back({name, seconds.count()});
  }

  void warn(std::string what, std::string remedy) {
    report_.warnings.push_back({std::move(what), std::move(remedy)});
  }

  void check_request() const;
  void read_surfaces();
  void find_guide();
  void find_places();
  void place_joints();
  void carry_shapes();
  void carry_weights();
  void carry_texture_coordinates();
  void carry_clips();

  Eigen::VectorXd trust_in(const std::vector<std::string>& landmarks) const;
  double exaggeration_of(const std::string& shape) const;
  PointsD pooled_delta(const Shape& shape) const;
  detail::PieceInput piece_input() const;
  void report_maps();
  void count_flips(std::size_t shape, const PointsD& source_rows, const PointsD& target_rows);

  const Character& source_;
  const Character& target_;
  const TransferOptions& options_;
  Character result_;
  TransferReport report_;

  detail::Pool source_pool_, target_pool_;
  std::vector<char> source_skin_, target_skin_;          // per piece
  detail::PoolSurface source_surface_, target_surface_;  // the skins
  Registration registration_;
  DeltaMaps maps_;
  std::unique_ptr<ThinPlateSpline> dense_, landmark_spline_;
  std::unique_ptr<AttributeCarrier> carrier_;
  PointsD warped_source_;        // pooled source vertices on the target
  WeightMatrix source_weights_;  // pooled source vertices x joints; empty without a skin
  std::vector<detail::PieceMotion> piece_motions_;
  std::vector<detail::PiecePlan> plans_;
  CarriedSkeleton skeleton_;
};

void Run::check_request() const {
  if (source_.parts.empty()) throw invalid_input("source", "has no mesh", "a rigged face");
  if (target_.parts.empty()) throw invalid_input("target", "has no mesh", "a face");
  if (source_.shapes.empty() && source_.skins.empty())
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
  source_pool_ = detail::pool(source_);
  target_pool_ = detail::pool(target_);
  source_skin_ = detail::skin_pieces(source_pool_, source_, report_.pairs.source);
  target_skin_ = detail::skin_pieces(target_pool_, target_, report_.pairs.target);
  source_surface_ = detail::select_pieces(source_pool_, source_skin_);
  target_surface_ = detail::select_pieces(target_pool_, target_skin_);
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
  if (options_.method == TransferMethod::thesis) {
    registration_ = thesis_registration(source_surface_.surface, target_surface_.surface, from, to);
  } else {
    RegistrationOptions registration;
    registration.landmark_trust = trust_in(report_.pairs.names);
    registration.landmarks_hold = options_.landmarks_hold;
    registration.progress = options_.progress;
    registration_ =
        register_surfaces(source_surface_.surface, target_surface_.surface, from, to, registration);
  }
  report_.similarity = registration_.similarity;
  report_.unit = registration_.unit;
  maps_.positions = source_surface_.surface.positions;
  maps_.similarity = registration_.similarity;
  maps_.aligned = registration_.similarity(maps_.positions);
  maps_.landmarks = landmark_spline_.get();
  maps_.landmark_image = (*landmark_spline_)(maps_.positions);
  if (options_.method == TransferMethod::thesis && options_.deltas != DeltaModel::warp) return;
  maps_.samples = farthest_points(maps_.aligned, most_samples);
  dense_ = std::make_unique<ThinPlateSpline>(
      dense_spline(maps_.aligned, registration_.guide, registration_.similarity(from), to,
                   std::span(maps_.samples).first(std::min(maps_.samples.size(), spline_samples))));
  maps_.dense = dense_.get();
  maps_.dense_image = (*dense_)(maps_.aligned);
}

void Run::find_places() {
  const bool thesis = options_.method == TransferMethod::thesis;
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  if (!source_.skins.empty())
    source_weights_ = detail::pooled_skin_weights(source_, source_pool_, list_joints(source_));
  std::vector<SourcePoint> points = thesis ? thesis_correspondence(registration_, source, target)
                                           : find_correspondence(registration_, source, target);
  if (!thesis) {
    TearInput tears{source_.shapes.size(),
                    [&](std::size_t s) {
                      return registration_.similarity.of_vectors(
                          pooled_delta(source_.shapes[s])(source_surface_.vertices, Eigen::all));
                    },
                    {},
                    registration_.unit};
    if (source_weights_.rows() > 0)
      tears.weights = detail::select_rows(source_weights_, source_surface_.vertices);
    reject_torn(tears, source, target, points);
  }
  carrier_ = std::make_unique<AttributeCarrier>(std::move(points), source, target);
  warped_source_ = thesis ? (*landmark_spline_)(source_pool_.positions)
                          : (*dense_)(registration_.similarity(source_pool_.positions));
  for (std::size_t r = 0; r < source_surface_.vertices.size(); ++r)
    warped_source_.row(source_surface_.vertices[r]) = registration_.guide.row(static_cast<Eigen::Index>(r));
  piece_motions_ = detail::piece_motions(
      source_pool_, source_skin_, source_.shapes.size(),
      [&](std::size_t s) { return pooled_delta(source_.shapes[s]); }, source_weights_,
      registration_.unit / registration_.similarity.scale);
  plans_ = detail::plan_pieces(piece_input());
  for (const detail::PiecePlan& plan : plans_)
    report_.pieces.push_back({target_pool_.piece_name[at(plan.piece)],
                              std::string(detail::name_of(plan.kind)),
                              std::string(detail::name_of(plan.way))});
  report_maps();
}

detail::PieceInput Run::piece_input() const {
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

void Run::place_joints() {
  const Similarity& similarity = registration_.similarity;
  const bool thesis = options_.method == TransferMethod::thesis;
  SpaceMap map;
  if (thesis) {
    map.position = [&](const Eigen::Vector3d& x) { return (*landmark_spline_)(x); };
    map.rotation = [&](const Eigen::Vector3d& x) { return closest_rotation(landmark_spline_->jacobian(x)); };
    map.scale = [&](const Eigen::Vector3d& x) {
      return std::cbrt(std::abs(landmark_spline_->jacobian(x).determinant()));
    };
  } else {
    const detail::PiecePoints inner = detail::piece_points(piece_input(), plans_);
    const Eigen::Index skin = maps_.aligned.rows(), all = skin + inner.aligned.rows();
    PointsD from(all, 3), to(all, 3);
    from << maps_.aligned, inner.aligned;
    to << registration_.guide, inner.target;
    // A vertex counts by its area, so that dense eyes do not outweigh what lies nearer; a piece's point as a thousandth
    // of the skin.
    Eigen::VectorXd weights = Eigen::VectorXd::Constant(all, 1e-3);
    const Eigen::VectorXd areas = vertex_areas(maps_.aligned, source_surface_.surface.triangles);
    weights.head(skin) = (areas / areas.sum()).cwiseMax(1e-9);
    const auto local = std::make_shared<MovingSimilarity>(
        std::move(from), std::move(to), joint_softness * registration_.unit, std::move(weights));
    map.position = [local, &similarity](const Eigen::Vector3d& x) { return (*local)(similarity(x)); };
    map.rotation = [&similarity](const Eigen::Vector3d&) { return similarity.rotation; };
    map.scale = [local, &similarity](const Eigen::Vector3d& x) {
      return similarity.scale * local->at(similarity(x)).scale;
    };
  }
  result_ = detail::bare_target(target_, target_pool_, !source_.skins.empty());
  if (source_.skins.empty()) {
    skeleton_.node_of.assign(source_.nodes.size(), -1);
    return;
  }
  skeleton_ = carry_skeleton(source_, map, static_cast<int>(result_.nodes.size()));
  result_.nodes.insert(result_.nodes.end(), skeleton_.nodes.begin(), skeleton_.nodes.end());
  result_.skins.push_back(skeleton_.skin);
  for (detail::PiecePlan& plan : plans_) {
    const Eigen::Vector3d centre =
        target_pool_.positions(plan.vertices, Eigen::all).colwise().mean().transpose();
    plan.growth = map.scale(similarity.inverse()(centre));
  }
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

void Run::carry_shapes() {
  const std::size_t count = source_.shapes.size();
  report_.flips.assign(count, 0);
  report_.source_flips.assign(count, 0);
  if (count == 0) return;
  maps_.scale = local_scale(maps_.aligned, registration_.guide, source_surface_.surface.triangles,
                            scale_radius * registration_.unit);
  const auto skin_delta = [&](std::size_t s) {
    return PointsD(pooled_delta(source_.shapes[s])(source_surface_.vertices, Eigen::all));
  };
  ContactModel contact(source_surface_.surface, registration_, maps_);
  DeltaModel model = options_.deltas;
  if (options_.method == TransferMethod::thesis && model == DeltaModel::automatic) model = DeltaModel::thesis;
  std::vector<std::string> names;
  for (const Shape& shape : source_.shapes) names.push_back(shape.name);
  const bool close_lids =
      options_.close_lids && options_.method != TransferMethod::thesis &&
      (model == DeltaModel::automatic || model == DeltaModel::local || model == DeltaModel::warp);
  if (close_lids || model == DeltaModel::automatic) contact.look_at_shapes(names, skin_delta);
  report_.deltas = contact.decide(model);

  result_.shapes.resize(count);
  result_.sliders = source_.sliders;
  result_.correctives = source_.correctives;
  result_.expressions = source_.expressions;
  const detail::PieceInput pieces = piece_input();
  const std::vector<detail::Ball> balls = options_.method == TransferMethod::thesis
                                              ? std::vector<detail::Ball>()
                                              : detail::eye_balls(pieces, plans_);
  parallel_for(count, 1, [&](std::size_t begin, std::size_t) {
    const std::size_t s = begin;
    const Shape& shape = source_.shapes[s];
    const PointsD pooled = pooled_delta(shape);
    const PointsD source_rows = pooled(source_surface_.vertices, Eigen::all);
    PointsD moved = carry_deltas(maps_, model, report_.deltas.warp_share, source_rows);
    if (close_lids) {
      const double share = contact.lid_warp_share(s, moved);
      if (share > 0)
        moved = (1 - share) * moved + share * carry_deltas(maps_, DeltaModel::warp, 1, source_rows);
      contact.close_lids(s, moved);
    }
    const double exaggeration = exaggeration_of(shape.name);
    PointsD skin = exaggeration * PointsD((*carrier_)(moved));
    if (close_lids && contact.closes_lid(s))
      detail::keep_out_of_eyes(balls, target_surface_.surface.positions, skin);
    PointsD target = PointsD::Zero(target_pool_.positions.rows(), 3);
    for (std::size_t r = 0; r < target_surface_.vertices.size(); ++r)
      target.row(target_surface_.vertices[r]) = skin.row(static_cast<Eigen::Index>(r));
    for (const detail::PiecePlan& plan : plans_) {
      const PointsD piece = detail::carry_piece(pieces, plan, exaggeration * pooled, skin);
      for (std::size_t i = 0; i < plan.vertices.size(); ++i)
        target.row(plan.vertices[i]) = piece.row(static_cast<Eigen::Index>(i));
    }
    count_flips(s, source_rows, skin);
    result_.shapes[s] =
        detail::shape_of_target(shape, target_pool_, result_, target, least_delta * registration_.unit);
  });
}

void Run::count_flips(std::size_t shape, const PointsD& source_rows, const PointsD& target_rows) {
  report_.source_flips[shape] = detail::flipped_triangles(source_surface_.surface, source_rows);
  report_.flips[shape] = detail::flipped_triangles(target_surface_.surface, target_rows);
}

void Run::carry_weights() {
  if (source_.skins.empty()) return;
  const Eigen::Index joints = source_weights_.cols();
  const WeightMatrix skin_source = detail::select_rows(source_weights_, source_surface_.vertices);
  const WeightMatrix skin = limit_influences((*carrier_)(skin_source), options_.max_influences);
  Eigen::Index head_joint = 0;
  Eigen::VectorXd total = Eigen::VectorXd::Zero(joints);
  for (Eigen::Index v = 0; v < skin.outerSize(); ++v)
    for (WeightMatrix::InnerIterator entry(skin, v); entry; ++entry) total[entry.col()] += entry.value();
  total.maxCoeff(&head_joint);

  std::vector<Eigen::Triplet<double>> entries;
  const auto append = [&](const WeightMatrix& rows, const std::vector<int>& vertices) {
    for (Eigen::Index r = 0; r < rows.outerSize(); ++r)
      for (WeightMatrix::InnerIterator entry(rows, r); entry; ++entry)
        entries.emplace_back(vertices[static_cast<std::size_t>(r)], static_cast<int>(entry.col()),
                             entry.value());
  };
  append(skin, target_surface_.vertices);
  const detail::PieceInput pieces = piece_input();
  for (const detail::PiecePlan& plan : plans_)
    append(limit_influences(
               detail::carry_piece_weights(pieces, plan, source_weights_, skin, static_cast<int>(head_joint)),
               options_.max_influences),
           plan.vertices);
  WeightMatrix all(target_pool_.positions.rows(), joints);
  all.setFromTriplets(entries.begin(), entries.end());
  for (std::size_t p = 0; p < result_.parts.size(); ++p) {
    result_.parts[p].skin = 0;
    result_.parts[p].skin_weights = to_skin_weights(all, target_pool_.welded[p]);
  }
}

void Run::carry_texture_coordinates() {
  const auto source = detail::skin_uvs(source_, source_pool_, source_surface_);
  if (!source) return;
  for (std::size_t p = 0; p < result_.parts.size(); ++p) {
    Mesh& mesh = result_.parts[p].mesh;
    if (!mesh.uvs.empty() && !options_.replace_uvs) continue;
    detail::assign_uvs(*source, registration_.guide, target_pool_, target_surface_, static_cast<int>(p),
                       mesh);
  }
}

void Run::carry_clips() {
  std::vector<int> shape_of(source_.shapes.size());
  for (std::size_t s = 0; s < shape_of.size(); ++s) shape_of[s] = static_cast<int>(s);
  std::vector<std::string> dropped;
  for (const Clip& clip : source_.clips)
    result_.clips.push_back(carry_clip(source_, clip, skeleton_, shape_of, dropped));
  if (!dropped.empty())
    warn(std::to_string(dropped.size()) + " channels animate what the target does not get (" +
             dropped.front() + " ...)",
         "skin these parts to joints on the source to have them animated on the target");
}

}  // namespace

TransferResult transfer(const Character& source, const Character& target, const TransferOptions& options) {
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
