// What the report's figures are measured from. The thesis's method is run a second time on the same inputs: every report
// says what was gained over it.
#include <algorithm>
#include <cmath>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/report/detail/at.h"
#include "mien/report/detail/data.h"
#include "mien/report/detail/measure_clips.h"
#include "mien/report/detail/measure_joints.h"
#include "mien/report/detail/poses.h"
#include "mien/report/shape_measures.h"

namespace mien::detail {
namespace {

void measure_landmarks(const ReportInput& input, Data& data) {
  const TransferReport& report = input.result.report;
  int count = 0;
  for (std::size_t i = 0; i < report.pairs.names.size(); ++i) {
    // Samples of curves lie between surface points: their place on the guide is not known as exactly.
    const auto& landmarks = input.source.landmarks;
    const auto named = [&](const Landmark& l) { return l.name == report.pairs.names[i]; };
    if (std::none_of(landmarks.begin(), landmarks.end(), named)) continue;
    const SurfacePoint& point = report.pairs.source[i].at;
    const Mesh& mesh = input.source.parts[at(point.part)].mesh;
    const Eigen::Vector3d reached = position_of(mesh, report.guide[at(point.part)], point);
    const double miss = (reached - report.pairs.target[i].position).norm() / report.unit;
    data.landmark_mean += miss;
    ++count;
    if (data.worst_landmark.empty() || miss > data.landmark_worst) {
      data.landmark_worst = miss;
      data.worst_landmark = report.pairs.names[i];
    }
  }
  if (count) data.landmark_mean /= count;
}

void measure_distance(const TransferReport& report, Data& data) {
  std::vector<float> distances;
  std::size_t vertices = 0, filled = 0;
  for (std::size_t p = 0; p < report.distance.size(); ++p)
    for (Eigen::Index v = 0; v < report.distance[p].size(); ++v) {
      ++vertices;
      if (report.filled[p][v] > 0)
        ++filled;
      else if (report.distance[p][v] > 0)
        distances.push_back(report.distance[p][v]);
    }
  if (vertices) data.filled_share = static_cast<double>(filled) / static_cast<double>(vertices);
  if (distances.empty()) return;
  std::sort(distances.begin(), distances.end());
  const auto quantile = [&](double q) {
    return static_cast<double>(
        distances[static_cast<std::size_t>(q * static_cast<double>(distances.size() - 1))]);
  };
  data.distance_median = quantile(0.5);
  data.distance_95 = quantile(0.95);
  data.distance_worst = quantile(1);
}

void run_thesis(const ReportInput& input, Data& data) {
  if (input.options.method == TransferMethod::thesis) return;
  TransferOptions options = input.options;
  options.method = TransferMethod::thesis;
  options.deltas = DeltaModel::automatic;
  options.progress = {};
  try {
    data.thesis = transfer(input.source, input.target, options);
  } catch (const Error& error) {
    data.thesis_problem = error.what();
  }
}

std::vector<Eigen::VectorXf> zeros_like(const std::vector<Points>& parts) {
  std::vector<Eigen::VectorXf> zeros;
  for (const Points& part : parts) zeros.push_back(Eigen::VectorXf::Zero(part.rows()));
  return zeros;
}

/// Shapes of one report after the other: each is posed on the source, the target and the thesis's target.
class ShapeRows {
 public:
  ShapeRows(const ReportInput& input, Data& data)
      : input_(input),
        data_(data),
        source_rest_(at_rest(input.source)),
        target_rest_(at_rest(input.result.character)),
        source_(input.source, source_rest_, input.result.report.unit / input.result.report.similarity.scale),
        target_(input.result.character, target_rest_, input.result.report.unit),
        torn_(target_.edge_count(), 0) {
    data.folds = data.thesis_folds = zeros_like(target_rest_);
    if (data.thesis) thesis_rest_ = at_rest(data.thesis->character);
  }

  void operator()() {
    const std::size_t count = input_.result.character.shapes.size();
    for (std::size_t s = 0; s < count; ++s) {
      report_progress(input_.progress, "report: measures",
                      0.1 + 0.1 * static_cast<double>(s) / static_cast<double>(count));
      data_.shapes.push_back(row(s));
    }
    if (!torn_.empty())
      data_.torn_share =
          static_cast<double>(std::count(torn_.begin(), torn_.end(), 1)) / static_cast<double>(torn_.size());
  }

 private:
  ShapeRow row(std::size_t s) {
    const TransferReport& report = input_.result.report;
    const std::vector<Points> posed = in_shape(input_.result.character, s);
    ShapeRow row;
    row.name = input_.result.character.shapes[s].name;
    row.flips = s < report.flips.size() ? report.flips[s] : 0;
    row.source_flips = s < report.source_flips.size() ? report.source_flips[s] : 0;
    row.source_stretch = source_.worst_stretch(in_shape(input_.source, s));
    row.stretch = target_.worst_stretch(posed);
    const double moved = displacement(posed, target_rest_).rms;
    row.moved = moved / report.unit;
    target_.count_folds(posed, data_.folds);
    if (data_.thesis) compare(s, posed, moved, row);
    return row;
  }

  void compare(std::size_t s, const std::vector<Points>& posed, double moved, ShapeRow& row) {
    const std::vector<Points> thesis = in_shape(data_.thesis->character, s);
    const Displacement apart = displacement(thesis, posed);
    row.difference = moved > 0 ? apart.rms / moved : 0;
    row.largest_difference = apart.largest / input_.result.report.unit;
    row.thesis_flips = data_.thesis->report.flips[s];
    const std::vector<char> torn = target_.torn_edges(thesis, posed);
    row.thesis_torn = static_cast<int>(std::count(torn.begin(), torn.end(), 1));
    for (std::size_t e = 0; e < torn.size(); ++e) torn_[e] |= torn[e];
    target_.count_folds(thesis, data_.thesis_folds);
  }

  const ReportInput& input_;
  Data& data_;
  std::vector<Points> source_rest_, target_rest_, thesis_rest_;
  ShapeMeasure source_, target_;
  std::vector<char> torn_;
};

void check(const ReportInput& input) {
  const TransferReport& report = input.result.report;
  const auto expect = [](bool fits, const char* what) {
    if (!fits)
      throw invalid_input("report",
                          std::string("the result has other ") + what + " than what it is said to come from",
                          "the source, the target and the result of one transfer");
  };
  const auto fits = [](const Part& part, const Eigen::Index rows) {
    return part.mesh.positions.rows() == rows;
  };
  expect(report.guide.size() == input.source.parts.size(), "source parts");
  expect(report.distance.size() == input.target.parts.size() &&
             report.filled.size() == report.distance.size() &&
             input.result.character.parts.size() == input.target.parts.size(),
         "target parts");
  expect(input.result.character.shapes.size() == input.source.shapes.size(), "shapes");
  for (std::size_t p = 0; p < report.guide.size(); ++p)
    expect(fits(input.source.parts[p], report.guide[p].rows()), "source vertices");
  for (std::size_t p = 0; p < report.distance.size(); ++p)
    expect(fits(input.target.parts[p], report.distance[p].size()) &&
               fits(input.result.character.parts[p], report.filled[p].size()),
           "target vertices");
}

}  // namespace

Data measure(const ReportInput& input) {
  check(input);
  Data data;
  measure_landmarks(input, data);
  measure_distance(input.result.report, data);
  report_progress(input.progress, "report: thesis's method", 0);
  run_thesis(input, data);
  ShapeRows(input, data)();
  data.joints = measure_joints(input, 12);
  report_progress(input.progress, "report: curves", 0.2);
  data.clips = measure_clips(input);
  return data;
}

}  // namespace mien::detail
