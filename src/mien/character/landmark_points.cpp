#include "mien/character/landmark_points.h"

#include <algorithm>

#include "mien/core/error.h"

namespace mien {
namespace {

Eigen::Vector3d model_position(const Character& character, const std::vector<Eigen::Matrix4d>& model,
                               const SurfacePoint& at) {
  const Part& part = character.parts[static_cast<std::size_t>(at.part)];
  const Eigen::Vector3d local = position_of(part.mesh, part.mesh.positions, at);
  if (part.skin >= 0 || part.node < 0) return local;
  return (model[static_cast<std::size_t>(part.node)] * local.homogeneous()).head<3>();
}

}  // namespace

std::vector<LandmarkPoint> landmark_points(const Character& character) {
  const auto model = model_matrices(character);
  std::vector<LandmarkPoint> points;
  for (const Landmark& landmark : character.landmarks)
    points.push_back({landmark.name, model_position(character, model, landmark.at), landmark.at});
  return points;
}

std::vector<LandmarkPoint> sample_curve(const Character& character, const LandmarkCurve& curve, int count) {
  const std::string place = "curve " + curve.name;
  if (curve.points.size() < 2)
    throw invalid_input(place, "has " + std::to_string(curve.points.size()) + " points", "two or more");
  if (count < 1) throw invalid_input(place, "has count " + std::to_string(count), "a count of 1 or more");
  const auto model = model_matrices(character);
  std::vector<Eigen::Vector3d> corners;
  std::vector<double> length{0};
  for (const SurfacePoint& at : curve.points) {
    corners.push_back(model_position(character, model, at));
    if (corners.size() > 1)
      length.push_back(length.back() + (corners.back() - corners[corners.size() - 2]).norm());
  }
  std::vector<LandmarkPoint> samples;
  for (int i = 0; i < count; ++i) {
    const double wanted = length.back() * (count == 1 ? 0.5 : static_cast<double>(i) / (count - 1));
    const std::size_t after = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(length.begin(), length.end(), wanted) - length.begin()), 1,
        length.size() - 1);
    const double span = length[after] - length[after - 1];
    const double t = span > 0 ? (wanted - length[after - 1]) / span : 0;
    samples.push_back({curve.name + "." + std::to_string(i),
                       corners[after - 1] + t * (corners[after] - corners[after - 1]),
                       curve.points[t < 0.5 ? after - 1 : after]});
  }
  return samples;
}

}  // namespace mien
