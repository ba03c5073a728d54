// Measured on 57 sliders of 26,719 vertices: G 20 ms once; the paper's own inverse 22 us a selection there and 1.8 ms at
// 300 sliders, which the rows' form below makes a few solves with G's factor.
#include "mien/pose/attenuate.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <string>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/point_evaluator.h"
#include "mien/pose/detail/dense_box_qp.h"
#include "mien/pose/detail/dense_kernels.h"
#include "mien/pose/detail/gram.h"
#include "mien/pose/detail/pin_checks.h"

namespace mien {
namespace {

constexpr double own_diagonal = 1e-10;  // what a slider's wish to stay where it was put weighs

struct VertexMove {
  int shape = 0;
  Eigen::Vector3f delta = Eigen::Vector3f::Zero();
};

struct VertexMoves {
  std::vector<int> first;  // #V + 1
  std::vector<VertexMove> moves;
};

/// Which shapes move each vertex of a part, and how.
VertexMoves moves_by_vertex(const Character& character, int part) {
  VertexMoves result;
  result.first.assign(character.parts[part].mesh.vertex_count() + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t s = 0; s < character.shapes.size(); ++s)
      for (const PartDelta& delta : character.shapes[s].parts)
        if (delta.part == part)
          for (std::size_t i = 0; i < delta.vertices.size(); ++i)
            visit(delta.vertices[i], VertexMove{static_cast<int>(s),
                                                delta.deltas.row(static_cast<Eigen::Index>(i)).transpose()});
  };
  each([&](int vertex, const VertexMove&) { ++result.first[vertex + 1]; });
  for (std::size_t v = 1; v < result.first.size(); ++v) result.first[v] += result.first[v - 1];
  result.moves.resize(static_cast<std::size_t>(result.first.back()));
  std::vector<int> next(result.first.begin(), result.first.end() - 1);
  each([&](int vertex, const VertexMove& move) { result.moves[next[vertex]++] = move; });
  return result;
}

void check_alpha(const std::optional<double>& alpha) {
  if (alpha && (!(*alpha >= 0) || !std::isfinite(*alpha)))
    throw invalid_input("alpha", "is negative or not finite", "0 or more");
}

const Character& checked(const Character& character, const RigPose& tagging) {
  if (character.sliders.empty())
    throw invalid_input("character", "has no sliders",
                        "shapes, each with its slider, so that there is motion to attenuate");
  detail::check_start(character, tagging);
  return character;
}

}  // namespace

struct Attenuator::Impl {
  Impl(const Character& given, const RigPose& tagging_pose, const AttenuateOptions& given_options)
      : options(given_options),
        tagging(tagging_pose),
        pose(pose_of(checked(given, tagging_pose), tagging_pose)),
        character(given) {
    check_alpha(options.alpha);
    slopes = shape_weight_slopes(character, tagging.sliders).sparseView();
    model = posed_matrices(character, pose);
    for (int p = 0; p < static_cast<int>(character.parts.size()); ++p)
      moves_of_part.push_back(character.parts[p].skin < 0 ? moves_by_vertex(character, p) : VertexMoves{});
    gram = slopes.transpose() * detail::shape_products(character, pose) * slopes;
    for (const Part& part : character.parts) coordinates += 3 * static_cast<double>(part.mesh.vertex_count());
    n = static_cast<int>(gram.rows());
    for (int j = 0; j < n; ++j) gram(j, j) += gram(j, j) > 0 ? own_diagonal * gram(j, j) : 1;
    factor.compute(gram);
    if (factor.info() != Eigen::Success)
      throw invalid_input("shapes", "hold numbers that are not finite", "finite deltas");
    low.resize(n);
    high.resize(n);
    for (int j = 0; j < n; ++j) {
      const Slider& slider = character.sliders[static_cast<std::size_t>(j)];
      low[j] = std::min(slider.minimum - tagging.sliders.values[j], 0.0);
      high[j] = std::max(slider.maximum - tagging.sliders.values[j], 0.0);
    }
    update_map();
  }

  Eigen::MatrixXd shape_rows(const SurfacePoint& point) const;
  void add_rows(const Eigen::MatrixXd& added, int number);
  void drop_rows(int number);
  void update_map();
  double current_alpha() const;

  AttenuateOptions options;
  RigPose tagging;
  Pose pose;
  const Character& character;
  Eigen::SparseMatrix<double> slopes;  // #S x n
  std::vector<Eigen::Matrix4d> model;
  std::vector<VertexMoves> moves_of_part;  // of parts without a skin
  Eigen::MatrixXd gram;                    // G
  Eigen::LLT<Eigen::MatrixXd> factor;
  double coordinates = 0;
  int n = 0, next_number = 0;
  std::vector<int> owner;  // the tag of each row
  Eigen::MatrixXd rows;    // S: k x n
  Eigen::MatrixXd solved;  // Z = G^-1 S': n x k
  Eigen::MatrixXd inner;   // K = S Z: k x k
  Eigen::MatrixXd map;
  double alpha = 0;
  Eigen::VectorXd low, high;  // of the change from tagging
};

/// 3 x #S. A part without a skin is looked up at once; compiling an evaluator would cost more than all the rest of a tag.
Eigen::MatrixXd Attenuator::Impl::shape_rows(const SurfacePoint& point) const {
  const Part& part = character.parts[point.part];
  if (part.skin >= 0) {
    Eigen::MatrixXd rows;
    PointEvaluator(character, {point}).shape_rows(pose, rows);
    return rows;
  }
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(character.shapes.size()));
  for (int k = 0; k < (point.face < 0 ? 1 : 3); ++k) {
    const int vertex = point.face < 0 ? point.vertex : part.mesh.faces[point.face][point.corners[k]];
    const double weight = point.face < 0 ? 1 : point.barycentric[k];
    const VertexMoves& moves = moves_of_part[point.part];
    for (int m = moves.first[vertex]; m < moves.first[vertex + 1]; ++m)
      rows.col(moves.moves[m].shape) += weight * moves.moves[m].delta.cast<double>();
  }
  if (part.node >= 0) rows = (model[part.node].topLeftCorner<3, 3>() * rows).eval();
  return rows;
}

void Attenuator::Impl::add_rows(const Eigen::MatrixXd& added, int number) {
  const Eigen::Index before = rows.rows(), count = added.rows();
  rows.conservativeResize(before + count, n);
  rows.bottomRows(count) = added;
  owner.insert(owner.end(), static_cast<std::size_t>(count), number);
  solved.conservativeResize(n, before + count);
  Eigen::MatrixXd columns = added.transpose();
  factor.solveInPlace(columns);
  solved.rightCols(count) = columns;
  inner.conservativeResize(before + count, before + count);
  inner.rightCols(count).noalias() = rows * solved.rightCols(count);
  inner.bottomLeftCorner(count, before) = inner.topRightCorner(before, count).transpose();
}

void Attenuator::Impl::drop_rows(int number) {
  std::vector<Eigen::Index> kept;
  for (std::size_t r = 0; r < owner.size(); ++r)
    if (owner[r] != number) kept.push_back(static_cast<Eigen::Index>(r));
  rows = rows(kept, Eigen::all).eval();
  solved = solved(Eigen::all, kept).eval();
  inner = inner(kept, kept).eval();
  std::erase(owner, number);
}

double Attenuator::Impl::current_alpha() const {
  const auto tagged = static_cast<double>(rows.rows());
  if (tagged == 0) return 0;
  if (options.alpha) return *options.alpha;
  if (options.rule == AlphaRule::coordinates) return (coordinates - tagged) / tagged;
  const double selected = rows.squaredNorm();
  return selected > 0 ? std::max(0.0, gram.trace() - selected) / selected : 0;
}

/// T = I - alpha Z (I + (alpha - 1) K)^-1 S
void Attenuator::Impl::update_map() {
  alpha = current_alpha();
  map.setIdentity(n, n);
  if (rows.rows() == 0 || alpha == 0) return;
  Eigen::MatrixXd middle = (alpha - 1) * inner;
  middle.diagonal().array() += 1;
  const Eigen::MatrixXd right = alpha * middle.ldlt().solve(rows);
  const detail::DenseKernels& kernels = detail::dense_kernels();
  for (int j = 0; j < n; ++j) {
    double* column = map.col(j).data();
    Eigen::Index k = 0;
    for (; k + 4 <= right.rows(); k += 4)
      kernels.subtract_four(column, solved.col(k).data(), n, &right(k, j), n);
    for (; k < right.rows(); ++k) kernels.add_scaled(column, solved.col(k).data(), -right(k, j), n);
  }
}

Attenuator::Attenuator(const Character& character, const RigPose& tagging, const AttenuateOptions& options)
    : impl_(std::make_unique<Impl>(character, tagging, options)) {}
Attenuator::~Attenuator() = default;
Attenuator::Attenuator(Attenuator&&) noexcept = default;
Attenuator& Attenuator::operator=(Attenuator&&) noexcept = default;

int Attenuator::add_tag(const Tag& tag) {
  Impl& a = *impl_;
  detail::check_surface_point(a.character, tag.at, "tag " + std::to_string(a.next_number + 1));
  if (tag.axes.count < 1 || tag.axes.count > 3)
    throw invalid_input("tag " + std::to_string(a.next_number + 1), "holds no axis", "one to three");
  a.add_rows(tag.axes.directions.topRows(tag.axes.count) * a.shape_rows(tag.at) * a.slopes, a.next_number);
  a.update_map();
  return a.next_number++;
}

void Attenuator::remove_tag(int number) {
  if (std::find(impl_->owner.begin(), impl_->owner.end(), number) == impl_->owner.end())
    throw invalid_input("tag " + std::to_string(number + 1), "does not exist", "one that add_tag gave");
  impl_->drop_rows(number);
  impl_->update_map();
}

void Attenuator::set_alpha(std::optional<double> alpha) {
  check_alpha(alpha);
  impl_->options.alpha = alpha;
  impl_->update_map();
}

double Attenuator::alpha() const {
  return impl_->alpha;
}

const Eigen::MatrixXd& Attenuator::map() const {
  return impl_->map;
}

SliderValues Attenuator::attenuate(const SliderValues& sliders) {
  Impl& a = *impl_;
  if (sliders.values.size() != a.n)
    throw invalid_input("slider values", "are " + std::to_string(sliders.values.size()),
                        "the character has " + std::to_string(a.n) + " sliders");
  if (!sliders.values.allFinite()) throw invalid_input("slider values", "are not finite", "finite numbers");
  const Eigen::VectorXd wished = sliders.values - a.tagging.sliders.values;
  if (wished.isZero(0)) return sliders;
  Eigen::VectorXd change = a.map * wished;
  const bool inside = (change.array() >= a.low.array()).all() && (change.array() <= a.high.array()).all();
  if (a.options.within_limits && !inside) {
    const Eigen::MatrixXd selected = a.rows.transpose() * a.rows;
    const Eigen::MatrixXd h = a.gram + (a.alpha - 1) * selected;
    detail::minimise_in_box(h, (a.gram - selected) * wished, a.low, a.high, change);
  }
  return SliderValues(a.tagging.sliders.values + change);
}

void Attenuator::move_slider(int slider, double change, SliderValues& attenuated) const {
  attenuated.values += change * impl_->map.col(slider);
}

AttenuateResult attenuate(const Character& character, const std::vector<Tag>& tags, const RigPose& tagging,
                          const SliderValues& sliders, const AttenuateOptions& options) {
  if (tags.empty()) throw invalid_input("tags", "are none", "one or more coordinates to keep still");
  Attenuator attenuator(character, tagging, options);
  std::vector<SurfacePoint> points;
  for (const Tag& tag : tags) {
    attenuator.add_tag(tag);
    points.push_back(tag.at);
  }
  AttenuateResult result{attenuator.attenuate(sliders), attenuator.alpha()};
  PointEvaluator evaluator(character, points);
  PointsD before, after, without;
  evaluator.positions(pose_of(character, tagging), before);
  evaluator.positions(pose_of(character, {result.sliders, tagging.locals}), after);
  evaluator.positions(pose_of(character, {sliders, tagging.locals}), without);
  int count = 0;
  for (std::size_t t = 0; t < tags.size(); ++t)
    for (int a = 0; a < tags[t].axes.count; ++a, ++count) {
      const auto row = static_cast<Eigen::Index>(t);
      const Eigen::RowVector3d axis = tags[t].axes.directions.row(a);
      result.drift += std::pow(axis.dot(after.row(row) - before.row(row)), 2);
      result.unattenuated_drift += std::pow(axis.dot(without.row(row) - before.row(row)), 2);
    }
  result.drift = std::sqrt(result.drift / count);
  result.unattenuated_drift = std::sqrt(result.unattenuated_drift / count);
  return result;
}

std::vector<Pin> held_by_tags(const std::vector<Tag>& tags, double weight) {
  std::vector<Pin> pins;
  for (const Tag& tag : tags) {
    Pin pin;
    pin.at = tag.at;
    pin.axes = tag.axes;
    pin.goal_is_move = true;
    pin.weight = weight;
    pins.push_back(pin);
  }
  return pins;
}

}  // namespace mien
