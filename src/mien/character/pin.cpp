#include "mien/character/pin.h"

#include <Eigen/Geometry>
#include <cmath>

#include "mien/core/error.h"

namespace mien {
namespace {

Eigen::Vector3d unit(const Eigen::Vector3d& v, const char* place) {
  if (!v.allFinite() || !(v.norm() > 0))
    throw invalid_input(place, "has no direction", "three finite numbers, not all 0");
  return v / v.norm();
}

}  // namespace

HeldAxes held_axes(std::string_view letters) {
  HeldAxes axes;
  axes.count = 0;
  std::string seen;
  for (const char letter : letters) {
    if (letter < 'x' || letter > 'z' || seen.find(letter) != std::string::npos) {
      axes.count = 0;
      break;
    }
    seen += letter;
    axes.directions.row(axes.count++) = Eigen::RowVector3d::Unit(letter - 'x');
  }
  if (axes.count == 0)
    throw invalid_input("axes \"" + std::string(letters.substr(0, 20)) + "\"", "are not axes",
                        "some of x, y and z, each once");
  return axes;
}

HeldAxes held_in_plane(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = unit(normal, "plane");
  HeldAxes axes;
  axes.directions.row(0) = n.unitOrthogonal();
  axes.directions.row(1) = n.cross(n.unitOrthogonal());
  axes.directions.row(2) = n;
  axes.count = 2;
  return axes;
}

HeldAxes held_along(const Eigen::Vector3d& direction) {
  HeldAxes axes;
  axes.directions.row(0) = unit(direction, "direction");
  axes.directions.row(1) = axes.directions.row(0).transpose().unitOrthogonal();
  axes.directions.row(2) = axes.directions.row(0).cross(axes.directions.row(1));
  axes.count = 1;
  return axes;
}

}  // namespace mien
