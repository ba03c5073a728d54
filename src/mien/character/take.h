#pragma once
/// What a capture session gives: streams over time that belong to no character yet. Data only; io reads them,
/// motion puts them on a character.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien {

/// Named numbers over time, such as the sliders of Live Link Face.
struct SliderTake {
  std::vector<std::string> names;
  std::vector<double> seconds;  ///< #frames, ascending from 0
  Eigen::MatrixXd values;       ///< #frames x #names
};

/// Named points over time. A marker that a frame does not show has no position there.
struct MarkerTake {
  std::vector<std::string> names;
  std::vector<double> seconds;          ///< #frames, ascending from 0
  std::vector<PointsD> positions;       ///< per frame #names x 3, in the file's unit and space
  std::vector<std::vector<char>> seen;  ///< per frame, per marker
};

}  // namespace mien
