#include "mien/extract/extract_wires.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/wires.h"
#include "mien/extract/detail/deltas.h"
#include "mien/extract/detail/pieces.h"
#include "mien/extract/detail/wire_system.h"

namespace mien {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void check_wires(std::span<const Wire> wires, const WireSolverOptions& options) {
  if (wires.empty()) throw invalid_input("wires", "are none", "one or more");
  for (const Wire& wire : wires)
    if (wire.bindings.empty()) throw invalid_input("wire " + wire.name, "reaches no vertex", "bind it first");
  if (!(options.ridge > 0) || !std::isfinite(options.ridge))
    throw invalid_input("ridge", "is " + std::to_string(options.ridge), "a finite number above 0");
}

/// Per part and row of the field.
std::vector<std::vector<float>> row_weights(const Character& character, const WireField& field,
                                            const std::vector<Eigen::VectorXf>& given) {
  if (!given.empty() && given.size() != character.parts.size())
    throw invalid_input("vertex weights", "are for " + std::to_string(given.size()) + " parts",
                        std::to_string(character.parts.size()));
  std::vector<std::vector<float>> weights;
  for (std::size_t p = 0; p < field.parts().size(); ++p) {
    const std::vector<int>& vertices = field.parts()[p].vertices;
    weights.emplace_back(vertices.size(), 1.f);
    if (given.empty() || given[p].size() == 0) continue;
    if (given[p].size() != character.parts[p].mesh.positions.rows() || !given[p].allFinite() ||
        given[p].minCoeff() < 0)
      throw invalid_input("vertex weights of part " + character.parts[p].name,
                          "are negative, not finite or of another number", "one a vertex, 0 or more");
    for (std::size_t row = 0; row < vertices.size(); ++row) weights[p][row] = given[p][vertices[row]];
  }
  return weights;
}

}  // namespace

struct WireSolver::State {
  State(const Character& character, std::span<const Wire> wires, const WireSolverOptions& options)
      : field(character, wires),
        system(field, wires, row_weights(character, field, options.vertex_weights), options.ridge) {
    for (const Wire& wire : wires) {
      controls.push_back(wire.curve.control_count());
      turns.push_back(wire.turn_controls);
    }
    const auto model = model_matrices(character);
    for (std::size_t p = 0; p < character.parts.size(); ++p) {
      const Part& part = character.parts[p];
      vertex_counts.push_back(static_cast<Eigen::Index>(part.mesh.vertex_count()));
      to_model.push_back(part.skin >= 0 || part.node < 0
                             ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                             : Eigen::Matrix3d(model[part.node].topLeftCorner<3, 3>()));
      rows.emplace_back(part.mesh.vertex_count(), -1);
      const std::vector<int>& reached = field.parts()[p].vertices;
      for (std::size_t row = 0; row < reached.size(); ++row)
        rows.back()[reached[row]] = static_cast<int>(row);
    }
  }

  WireField field;
  detail::WireSystem system;
  std::vector<int> controls, turns;         ///< per wire
  std::vector<std::vector<int>> rows;       ///< per part and vertex: its row in the field, -1: out of reach
  std::vector<Eigen::Matrix3d> to_model;    ///< per part: its vectors to model space
  std::vector<Eigen::Index> vertex_counts;  ///< per part
};

WireSolver::WireSolver(const Character& character, std::span<const Wire> wires,
                       const WireSolverOptions& options) {
  check_wires(wires, options);
  state_ = std::make_unique<State>(character, wires, options);
}
WireSolver::~WireSolver() = default;
WireSolver::WireSolver(WireSolver&&) noexcept = default;
WireSolver& WireSolver::operator=(WireSolver&&) noexcept = default;

std::vector<WireMove> WireSolver::solve(const Shape& shape) const {
  detail::WireVector right = state_->system.zero();
  bool moved = false;
  for (const PartDelta& delta : shape.parts) {
    if (delta.part < 0 || delta.part >= static_cast<int>(state_->rows.size()))
      throw invalid_input("shape " + shape.name, "moves part " + std::to_string(delta.part),
                          "a part that exists");
    for (std::size_t i = 0; i < delta.vertices.size(); ++i) {
      const int row = state_->rows[delta.part][delta.vertices[i]];
      if (row < 0) continue;
      const Eigen::Vector3d displacement =
          delta.deltas.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
      moved = moved || displacement.squaredNorm() > 0;
      state_->system.add(delta.part, row, state_->to_model[delta.part] * displacement, right);
    }
  }
  std::vector<WireMove> moves;
  if (!moved) return moves;
  const detail::WireVector found = state_->system.solve(right);
  const detail::WireColumns& columns = state_->system.columns();
  for (std::size_t w = 0; w < state_->controls.size(); ++w) {
    WireMove move;
    move.wire = static_cast<int>(w);
    move.controls = found.controls.middleRows(columns.controls[w], state_->controls[w]);
    const int sigma = columns.unknowns[columns.coupled[w]];
    move.scale = found.coupled[sigma];
    move.turns.resize(state_->turns[w], 3);
    for (int t = 0; t < state_->turns[w]; ++t)
      move.turns.row(t) = found.coupled.segment<3>(sigma + 1 + 3 * t).transpose();
    moves.push_back(std::move(move));
  }
  return moves;
}

std::vector<PartDelta> WireSolver::apply(std::span<const WireMove> moves) const {
  std::vector<PartDelta> deltas;
  for (std::size_t p = 0; p < state_->rows.size(); ++p) {
    const std::vector<int>& reached = state_->field.parts()[p].vertices;
    if (reached.empty()) continue;
    PointsD positions = PointsD::Zero(state_->vertex_counts[p], 3);
    state_->field.add(static_cast<int>(p), moves, positions);
    PartDelta delta;
    delta.part = static_cast<int>(p);
    delta.vertices = reached;
    delta.deltas.resize(static_cast<Eigen::Index>(reached.size()), 3);
    for (std::size_t i = 0; i < reached.size(); ++i)
      delta.deltas.row(static_cast<Eigen::Index>(i)) = positions.row(reached[i]).cast<float>();
    deltas.push_back(std::move(delta));
  }
  return deltas;
}

namespace {

/// Takes one shape apart into what wires rebuild, what is kept beside them and what is lost.
class Fitter {
 public:
  Fitter(const Character& character, const WireSolver& solver, const detail::Pieces& pieces, double threshold)
      : character_(character), solver_(solver), pieces_(pieces), threshold_(threshold) {}

  /// Sums of squares by feature go to `features`.
  WireFit fit(const Shape& shape, std::vector<FeatureError>& features) const;

 private:
  void fit_part(const Shape& shape, int part, WireFit& fit, std::vector<FeatureError>& features) const;
  const Character& character_;
  const WireSolver& solver_;
  const detail::Pieces& pieces_;
  double threshold_;
};

WireFit Fitter::fit(const Shape& shape, std::vector<FeatureError>& features) const {
  WireFit result;
  result.shape = shape.name;
  result.moves = solver_.solve(shape);
  result.rebuilt = solver_.apply(result.moves);
  for (std::size_t p = 0; p < character_.parts.size(); ++p)
    if (pieces_.has_skin(static_cast<int>(p))) fit_part(shape, static_cast<int>(p), result, features);
  result.displacement = std::sqrt(result.displacement);
  result.error = std::sqrt(result.error);
  result.kept_error = std::sqrt(result.kept_error);
  return result;
}

void Fitter::fit_part(const Shape& shape, int part, WireFit& fit, std::vector<FeatureError>& features) const {
  const Points wanted = detail::dense_delta(character_, shape, part);
  Points left = wanted, kept = Points::Zero(wanted.rows(), 3);
  for (const PartDelta& delta : fit.rebuilt)
    if (delta.part == part)
      for (std::size_t i = 0; i < delta.vertices.size(); ++i)
        left.row(delta.vertices[i]) -= delta.deltas.row(static_cast<Eigen::Index>(i));
  for (Eigen::Index v = 0; v < wanted.rows(); ++v) {
    if (!pieces_.is_skin(part, static_cast<int>(v))) continue;
    const double scale = pieces_.unit(part), error = scale * left.row(v).cast<double>().norm(),
                 displacement = scale * wanted.row(v).cast<double>().norm();
    fit.displacement += displacement * displacement;
    fit.error += error * error;
    FeatureError& feature = features[pieces_.feature(part, static_cast<int>(v))];
    feature.displacement += displacement * displacement;
    feature.error += error * error;
    if (error > fit.largest) {
      fit.largest = error;
      fit.part = part;
      fit.vertex = static_cast<int>(v);
    }
    const double lost = std::min(error, threshold_);
    fit.kept_error += lost * lost;
    if (error > threshold_) kept.row(v) = static_cast<float>(1 - threshold_ / error) * left.row(v);
  }
  PartDelta residual = detail::sparse_delta(part, kept);
  if (!residual.vertices.empty()) fit.residual.push_back(std::move(residual));
}

/// The shape's new displacements: by wires and what is kept on the skin, its own elsewhere.
std::vector<PartDelta> replaced(const Character& character, const detail::Pieces& pieces, const Shape& shape,
                                const WireFit& fit) {
  std::vector<PartDelta> parts;
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    Points dense = detail::dense_delta(character, shape, part);
    for (Eigen::Index v = 0; v < dense.rows(); ++v)
      if (pieces.is_skin(part, static_cast<int>(v))) dense.row(v).setZero();
    for (const std::vector<PartDelta>* list : {&fit.rebuilt, &fit.residual})
      for (const PartDelta& delta : *list)
        if (delta.part == part)
          for (std::size_t i = 0; i < delta.vertices.size(); ++i)
            dense.row(delta.vertices[i]) += delta.deltas.row(static_cast<Eigen::Index>(i));
    const bool listed = std::any_of(shape.parts.begin(), shape.parts.end(),
                                    [&](const PartDelta& delta) { return delta.part == part; });
    PartDelta delta = detail::sparse_delta(part, dense);
    if (listed || !delta.vertices.empty()) parts.push_back(std::move(delta));
  }
  return parts;
}

void add_up(ExtractResult& result) {
  const auto add = [](double& sum, double value) { sum += value * value; };
  for (const WireFit& fit : result.shapes) {
    add(result.displacement, fit.displacement);
    add(result.error, fit.error);
    add(result.kept_error, fit.kept_error);
    result.largest = std::max(result.largest, fit.largest);
  }
  for (double* sum : {&result.displacement, &result.error, &result.kept_error}) *sum = std::sqrt(*sum);
  for (FeatureError& feature : result.features) {
    feature.displacement = std::sqrt(feature.displacement);
    feature.error = std::sqrt(feature.error);
  }
}

}  // namespace

ExtractResult extract_wires(const Character& character, std::span<const Wire> wires,
                            const ExtractOptions& options) {
  if (!(options.residual >= 0) || !std::isfinite(options.residual))
    throw invalid_input("residual", "is " + std::to_string(options.residual),
                        "a part of the face's box, 0 or more");
  std::set<std::string> names;
  for (const Wire& wire : wires)
    if (!names.insert(wire.name).second)
      throw invalid_input("wire " + wire.name, "is there twice", "names of their own");
  ExtractResult result;
  report_progress(options.progress, "set up", 0);
  auto start = Clock::now();
  const WireSolver solver(character, wires, options.solver);
  result.setup_seconds = seconds_since(start);
  const detail::Pieces pieces(character, wires);
  result.box = pieces.box();
  result.skin_vertices = pieces.skin_vertices();
  result.skin = pieces.skin();
  std::vector<std::vector<FeatureError>> features(character.shapes.size(), pieces.features());
  result.features = pieces.features();
  result.shapes.resize(character.shapes.size());
  const Fitter fitter(character, solver, pieces, options.residual * result.box);
  start = Clock::now();
  parallel_for(character.shapes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) result.shapes[s] = fitter.fit(character.shapes[s], features[s]);
  });
  result.solve_seconds = seconds_since(start);
  for (const auto& list : features)
    for (std::size_t f = 0; f < list.size(); ++f) {
      result.features[f].displacement += list[f].displacement;
      result.features[f].error += list[f].error;
    }
  add_up(result);
  report_progress(options.progress, "write shapes", 0.9);
  result.character = character;
  result.character.wires.assign(wires.begin(), wires.end());
  for (std::size_t s = 0; s < character.shapes.size(); ++s) {
    Shape& shape = result.character.shapes[s];
    shape.wires = result.shapes[s].moves;
    if (!options.exact && !shape.wires.empty())
      shape.parts = replaced(character, pieces, character.shapes[s], result.shapes[s]);
  }
  report_progress(options.progress, "write shapes", 1);
  return result;
}

}  // namespace mien
