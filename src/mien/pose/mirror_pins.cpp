#include "mien/pose/mirror_pins.h"

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/geometry/surface_query.h"
#include "mien/pose/detail/pin_checks.h"

namespace mien {

MirrorPlane middle_plane(const Character& character) {
  Box all;
  bool first = true;
  for (const Points& part : evaluate(character, rest_pose(character))) {
    if (part.rows() == 0) continue;
    const Box box = bounding_box(part);
    all = first ? box : Box{all.low.cwiseMin(box.low), all.high.cwiseMax(box.high)};
    first = false;
  }
  return {Eigen::Vector3d::UnitX(), all.centre().x()};
}

std::vector<Pin> mirror_pins(const Character& character, const std::vector<Pin>& pins,
                             const MirrorPlane& plane) {
  if (!(plane.normal.norm() > 0))
    throw invalid_input("mirror plane", "has no normal", "a vector that is not 0");
  const std::vector<Points> rest = evaluate(character, rest_pose(character));
  std::vector<Pin> both = pins;
  for (std::size_t p = 0; p < pins.size(); ++p) {
    const SurfacePoint* point = std::get_if<SurfacePoint>(&pins[p].at);
    if (!point) continue;
    detail::check_surface_point(character, *point, detail::pin_name(p));
    const Part& part = character.parts[point->part];
    const Eigen::Vector3d at = position_of(part.mesh, rest[point->part], *point), image = plane.mirrored(at);
    if ((image - at).norm() < 1e-3 * bounding_box(rest[point->part]).diagonal()) continue;
    const Triangles triangles = triangulate(part.mesh.faces);
    const SurfaceQuery::Hit hit = SurfaceQuery(rest[point->part], triangles).closest(image);
    const int face = face_of_triangle(part.mesh.faces)[hit.triangle];
    int corner = 2;  // of the fan: (0, corner - 1, corner)
    for (int t = hit.triangle; t > 0 && face_of_triangle(part.mesh.faces)[t - 1] == face; --t) ++corner;
    Pin twin = pins[p];
    twin.at = SurfacePoint{point->part, face, -1, hit.barycentric, {0, corner - 1, corner}};
    twin.goal = pins[p].goal_is_move ? plane.mirrored_vector(pins[p].goal) : plane.mirrored(pins[p].goal);
    for (int a = 0; a < 3; ++a)
      twin.axes.directions.row(a) =
          plane.mirrored_vector(pins[p].axes.directions.row(a).transpose()).transpose();
    both.push_back(twin);
  }
  return both;
}

}  // namespace mien
