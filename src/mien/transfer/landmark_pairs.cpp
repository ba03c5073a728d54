#include "mien/transfer/landmark_pairs.h"

#include <Eigen/SVD>
#include <algorithm>

#include "mien/core/error.h"

namespace mien {
namespace {

template <class Items>
auto find_named(const Items& items, const std::string& name) {
  return std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
}

PointsD positions_of(const std::vector<LandmarkPoint>& points) {
  PointsD positions(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    positions.row(static_cast<Eigen::Index>(i)) = points[i].position.transpose();
  return positions;
}

std::string some_names(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < 4; ++i) text += (i ? ", " : "") + names[i];
  return names.size() > 4 ? text + ", ..." : text;
}

void require_spread(const std::vector<std::string>& names, const PointsD& positions,
                    const std::string& side) {
  const double diagonal = bounding_box(positions).diagonal();
  for (Eigen::Index i = 0; i < positions.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if ((positions.row(i) - positions.row(j)).norm() <= 1e-6 * diagonal)
        throw invalid_input(side + " landmarks",
                            names[static_cast<std::size_t>(j)] + " and " +
                                names[static_cast<std::size_t>(i)] + " are at the same place",
                            "two different places, or one of them left out");
  const PointsD centred = positions.rowwise() - positions.colwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centred);
  if (svd.singularValues()[2] < 1e-4 * svd.singularValues()[0])
    throw invalid_input(side + " landmarks", "all lie in one plane (" + some_names(names) + ")",
                        "one or more off that plane, such as the tip of the nose or an ear");
}

}  // namespace

PointsD LandmarkPairs::source_positions() const {
  return positions_of(source);
}
PointsD LandmarkPairs::target_positions() const {
  return positions_of(target);
}

LandmarkPairs pair_landmarks(const Character& source, const Character& target) {
  LandmarkPairs pairs;
  const auto source_points = landmark_points(source), target_points = landmark_points(target);
  for (const LandmarkPoint& point : source_points) {
    const auto other = find_named(target_points, point.name);
    if (other == target_points.end()) {
      pairs.only_source.push_back(point.name);
      continue;
    }
    pairs.names.push_back(point.name);
    pairs.source.push_back(point);
    pairs.target.push_back(*other);
  }
  for (const LandmarkCurve& curve : source.curves) {
    const auto other = find_named(target.curves, curve.name);
    if (other == target.curves.end()) {
      pairs.only_source.push_back(curve.name);
      continue;
    }
    const auto from = sample_curve(source, curve, curve.count),
               to = sample_curve(target, *other, curve.count);
    for (std::size_t i = 0; i < from.size(); ++i) {
      // A sample on a landmark (a curve that starts at one) says nothing new and would make the spline singular.
      const auto taken = [&](const std::vector<LandmarkPoint>& points, const LandmarkPoint& sample) {
        return std::any_of(points.begin(), points.end(), [&](const LandmarkPoint& p) {
          return (p.position - sample.position).norm() == 0;
        });
      };
      if (taken(pairs.source, from[i]) || taken(pairs.target, to[i])) continue;
      pairs.names.push_back(from[i].name);
      pairs.source.push_back(from[i]);
      pairs.target.push_back(to[i]);
    }
  }
  for (const LandmarkPoint& point : target_points)
    if (find_named(source_points, point.name) == source_points.end()) pairs.only_target.push_back(point.name);
  for (const LandmarkCurve& curve : target.curves)
    if (find_named(source.curves, curve.name) == source.curves.end()) pairs.only_target.push_back(curve.name);

  if (pairs.names.size() < 4)
    throw invalid_input(
        "landmarks",
        std::to_string(pairs.names.size()) + " of the source's " + std::to_string(source_points.size()) +
            " have a partner of the same name among the target's " + std::to_string(target_points.size()),
        "4 or more names that both sides have");
  require_spread(pairs.names, pairs.source_positions(), "source");
  require_spread(pairs.names, pairs.target_positions(), "target");
  return pairs;
}

}  // namespace mien
