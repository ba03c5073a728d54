#include "mien/motion/fit_markers.h"

#include <algorithm>
#include <cmath>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/point_evaluator.h"
#include "mien/geometry/similarity.h"
#include "mien/motion/detail/slider_channel.h"
#include "mien/motion/retarget_sliders.h"
#include "mien/pose/solve_pins.h"

namespace mien {
namespace {

constexpr int robust_rounds = 5;
constexpr double least_motion = 1e-4;  // of a slider: less is no channel

std::string text_of(double number) {
  return std::to_string(number);
}

/// One marker's column in the take and its landmark.
struct Match {
  Eigen::Index marker = 0;
  SurfacePoint point;
};

const Landmark* landmark_named(const Character& character, const std::string& name) {
  for (const Landmark& landmark : character.landmarks)
    if (landmark.name == name) return &landmark;
  return nullptr;
}

std::vector<Match> match_markers(const MarkerTake& take, const Character& character,
                                 const FitMarkersOptions& options, FitMarkersResult& result) {
  std::vector<Match> matches;
  for (std::size_t m = 0; m < take.names.size(); ++m) {
    const auto given = options.landmarks.find(take.names[m]);
    const bool is_given = given != options.landmarks.end();
    const Landmark* landmark = landmark_named(character, is_given ? given->second : take.names[m]);
    if (is_given && !landmark)
      throw invalid_input("landmark " + given->second, "does not exist",
                          "name one of the character's landmarks");
    if (!landmark || (!options.landmarks.empty() && !is_given)) {
      result.unmapped.push_back(take.names[m]);
      continue;
    }
    result.matched.push_back(take.names[m]);
    matches.push_back({static_cast<Eigen::Index>(m), landmark->at});
  }
  if (matches.size() < 4)
    throw invalid_input("markers", std::to_string(matches.size()) + " have a landmark of their name",
                        "give a map of at least 4 markers to the character's landmarks");
  return matches;
}

class MarkerFitter {
 public:
  MarkerFitter(const MarkerTake& take, const Character& character, const FitMarkersOptions& options)
      : take_(take), character_(character), options_(options) {}
  FitMarkersResult run();

 private:
  void check() const;
  void gather();
  void bridge_gaps();
  void align();
  Eigen::VectorXd stillness() const;
  PointsD stabilised(std::size_t frame) const;
  PinSolver& solver_for(const std::vector<char>& seen);
  void fit_frame(std::size_t frame);
  void make_clip();

  const MarkerTake& take_;
  const Character& character_;
  const FitMarkersOptions& options_;
  FitMarkersResult result_;
  std::vector<Match> matches_;
  std::vector<PointsD> markers_;         ///< per frame, matched markers alone
  std::vector<std::vector<char>> seen_;  ///< per frame
  std::size_t neutral_ = 0;
  PointsD rest_;             ///< the landmarks at rest
  Eigen::VectorXd still_;    ///< per marker: how little the rig moves it, at most 1
  Similarity to_character_;  ///< the actor's neutral to the character's rest
  std::map<std::vector<char>, PinSolver> solvers_;
  Eigen::MatrixXd sliders_;  ///< #frames x #sliders
  double miss_ = 0, motion_ = 0;
};

void MarkerFitter::check() const {
  if (take_.seconds.empty() || take_.positions.size() != take_.seconds.size() ||
      take_.seen.size() != take_.seconds.size())
    throw invalid_input("take", "has no frames or arrays of unequal length", "give one row a frame");
  if (character_.sliders.empty())
    throw invalid_input("character", "has no sliders", "give one with shapes that markers can move");
  for (const auto& [name, value, low] :
       {std::tuple("rho", options_.rho, 1e-12), std::tuple("smooth", options_.smooth, 0.0),
        std::tuple("gap", options_.gap, 0.0)})
    if (!std::isfinite(value) || value < low)
      throw invalid_input(name, "is " + text_of(value), "give a number above 0");
  if (!(options_.neutral_at >= 0) || options_.neutral_at > take_.seconds.back())
    throw invalid_input("neutral time", "is " + text_of(options_.neutral_at),
                        "give seconds from 0 to " + text_of(take_.seconds.back()));
}

void MarkerFitter::gather() {
  const auto count = static_cast<Eigen::Index>(matches_.size());
  for (std::size_t f = 0; f < take_.seconds.size(); ++f) {
    PointsD positions(count, 3);
    std::vector<char> seen;
    for (Eigen::Index m = 0; m < count; ++m) {
      positions.row(m) = take_.positions[f].row(matches_[static_cast<std::size_t>(m)].marker);
      seen.push_back(take_.seen[f][static_cast<std::size_t>(matches_[static_cast<std::size_t>(m)].marker)]);
    }
    markers_.push_back(std::move(positions));
    seen_.push_back(std::move(seen));
  }
  neutral_ = static_cast<std::size_t>(
      std::lower_bound(take_.seconds.begin(), take_.seconds.end(), options_.neutral_at) -
      take_.seconds.begin());
  for (std::size_t m = 0; m < matches_.size(); ++m)
    if (!seen_[neutral_][m])
      throw invalid_input("marker " + result_.matched[m], "is not seen at the neutral time",
                          "give a neutral time that shows every marker, or leave it out of the map");
}

void MarkerFitter::bridge_gaps() {
  for (std::size_t m = 0; m < matches_.size(); ++m) {
    const auto row = static_cast<Eigen::Index>(m);
    std::size_t last = take_.seconds.size();
    for (std::size_t f = 0; f < take_.seconds.size(); ++f) {
      if (!seen_[f][m]) continue;
      if (last < f && take_.seconds[f] - take_.seconds[last] <= options_.gap)
        for (std::size_t between = last + 1; between < f; ++between) {
          const double share =
              (take_.seconds[between] - take_.seconds[last]) / (take_.seconds[f] - take_.seconds[last]);
          markers_[between].row(row) = (1 - share) * markers_[last].row(row) + share * markers_[f].row(row);
          seen_[between][m] = 1;
        }
      last = f;
    }
  }
}

/// The rms motion by the sliders against the least mobile marker's.
Eigen::VectorXd MarkerFitter::stillness() const {
  std::vector<SurfacePoint> points;
  for (const Match& match : matches_) points.push_back(match.point);
  PointEvaluator evaluator(character_, points);
  Freedoms freedoms;
  for (std::size_t s = 0; s < character_.sliders.size(); ++s) freedoms.sliders.push_back(static_cast<int>(s));
  Eigen::MatrixXd jacobian;
  evaluator.jacobian(rest_rig_pose(character_), freedoms, jacobian);
  Eigen::VectorXd mobility(static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index p = 0; p < mobility.size(); ++p) mobility[p] = jacobian.middleRows(3 * p, 3).norm();
  const double typical = mobility.mean();
  return (1 + (mobility.array() / std::max(0.3 * typical, 1e-300)).square()).inverse();
}

void MarkerFitter::align() {
  std::vector<SurfacePoint> points;
  for (const Match& match : matches_) points.push_back(match.point);
  PointEvaluator evaluator(character_, points);
  evaluator.positions(rest_rig_pose(character_), rest_);
  still_ = stillness();
  to_character_ = fit_similarity(markers_[neutral_], rest_);
  result_.scale = to_character_.scale;
}

/// The frame's markers with the head's motion taken out: rigidly fitted to the neutral's, still markers first, and those
/// that do not fit counting less and less.
PointsD MarkerFitter::stabilised(std::size_t frame) const {
  std::vector<Eigen::Index> rows;
  for (std::size_t m = 0; m < matches_.size(); ++m)
    if (seen_[frame][m]) rows.push_back(static_cast<Eigen::Index>(m));
  if (rows.size() < 3)
    throw invalid_input("frame " + std::to_string(frame), "shows " + std::to_string(rows.size()) + " markers",
                        "at least 3 tell where the head is");
  const PointsD from = markers_[frame](rows, Eigen::all), to = markers_[neutral_](rows, Eigen::all);
  const Eigen::VectorXd trust = still_(rows);
  Eigen::VectorXd weights = trust;
  Similarity rigid;
  for (int round = 0; round < robust_rounds; ++round) {
    rigid = fit_similarity(from, to, weights);
    rigid.scale = 1;
    const Eigen::RowVector3d centre_from = weights.transpose() * from / weights.sum();
    const Eigen::RowVector3d centre_to = weights.transpose() * to / weights.sum();
    rigid.translation = centre_to.transpose() - rigid.rotation * centre_from.transpose();
    const Eigen::VectorXd miss = (rigid(from) - to).rowwise().norm();
    const double usual =
        std::max((weights.dot(miss)) / weights.sum(), 1e-12 * (to.rowwise() - centre_to).norm());
    weights = trust.array() / (1 + (miss.array() / usual).square());
  }
  return rigid(markers_[frame]);
}

PinSolver& MarkerFitter::solver_for(const std::vector<char>& seen) {
  const auto known = solvers_.find(seen);
  if (known != solvers_.end()) return known->second;
  std::vector<Pin> pins;
  for (std::size_t m = 0; m < matches_.size(); ++m) {
    if (!seen[m]) continue;
    Pin pin;
    pin.at = matches_[m].point;
    pin.goal = rest_.row(static_cast<Eigen::Index>(m)).transpose();
    pins.push_back(std::move(pin));
  }
  SolvePinsOptions options;
  options.rho = options_.rho;
  return solvers_.emplace(seen, PinSolver(character_, pins, rest_rig_pose(character_), options))
      .first->second;
}

void MarkerFitter::fit_frame(std::size_t frame) {
  const PointsD goals = rest_ + to_character_.of_vectors(stabilised(frame) - markers_[neutral_]);
  PinSolver& solver = solver_for(seen_[frame]);
  int pin = 0;
  for (std::size_t m = 0; m < matches_.size(); ++m) {
    if (!seen_[frame][m]) continue;
    const auto row = static_cast<Eigen::Index>(m);
    solver.set_goal(pin++, goals.row(row).transpose());
    motion_ += (goals.row(row) - rest_.row(row)).squaredNorm();
  }
  const SolvePinsResult& solved = solver.solve();
  for (const double miss : solved.misses) miss_ += miss * miss;
  sliders_.row(static_cast<Eigen::Index>(frame)) = solved.pose.sliders.values.transpose();
}

void MarkerFitter::make_clip() {
  result_.clip.name = "capture";
  for (Eigen::Index s = 0; s < sliders_.cols(); ++s) {
    const Eigen::VectorXd values =
        smooth_stream(sliders_.col(s), take_.seconds, options_.smooth, detail::quick_change);
    if (values.maxCoeff() - values.minCoeff() < least_motion) continue;
    result_.clip.channels.push_back(detail::slider_channel(static_cast<int>(s), take_.seconds, values));
  }
  result_.residual = motion_ > 0 ? std::sqrt(miss_ / motion_) : 0;
}

FitMarkersResult MarkerFitter::run() {
  check();
  matches_ = match_markers(take_, character_, options_, result_);
  gather();
  bridge_gaps();
  align();
  sliders_.resize(static_cast<Eigen::Index>(take_.seconds.size()),
                  static_cast<Eigen::Index>(character_.sliders.size()));
  for (std::size_t f = 0; f < take_.seconds.size(); ++f) {
    fit_frame(f);
    report_progress(options_.progress, "fit markers",
                    static_cast<double>(f + 1) / static_cast<double>(take_.seconds.size()));
  }
  make_clip();
  return std::move(result_);
}

}  // namespace

FitMarkersResult fit_markers(const MarkerTake& take, const Character& character,
                             const FitMarkersOptions& options) {
  return MarkerFitter(take, character, options).run();
}

}  // namespace mien
