#pragma once
/// POINT of the small JSON files: {"vertex": 17}, {"part": "Skin", "vertex": 17}, {"face": 3, "barycentric":
/// [a, b, c]} or {"position": [x, y, z]}.

#include <map>
#include <memory>

#include "mien/character/character.h"
#include "mien/geometry/surface_query.h"
#include "mien/io/detail/json.h"

namespace mien::detail {

/// Reads points on one character; the search structure for positions is built when the first one is met.
class PointReader {
 public:
  explicit PointReader(const Character& character) : character_(character) {}
  SurfacePoint read(const JsonObject& point);

 private:
  struct Surface {
    std::unique_ptr<SurfaceQuery> query;
    std::vector<SurfacePoint> triangles;  ///< per triangle: its part, face and corners
  };
  const Surface& surface_of(int part);
  SurfacePoint read_position(const JsonObject& point, int part);

  const Character& character_;
  std::map<int, Surface> surfaces_;  ///< by part, -1: all parts
};

/// Adds where on its part a point is: a vertex, or a face with barycentric weights. Landmark files and the vendor
/// extension name the part each in its own way.
void add_place_on_part(const SurfacePoint& point, Json& json);

Json point_json(const SurfacePoint& point, const Character& character);

}  // namespace mien::detail
