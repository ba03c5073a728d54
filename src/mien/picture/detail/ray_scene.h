#pragma once
/// All parts of a posed character as one triangle soup that rays can hit.

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mien/character/character.h"
#include "mien/picture/detail/looks.h"
#include "mien/picture/render.h"

namespace mien::detail {

/// What does not depend on the pose.
struct SoupPart {
  std::vector<int> welded;           ///< #V: welded number
  std::vector<int> first;            ///< #W: a vertex with that number
  Triangles welded_triangles;        ///< all triangles by welded numbers
  Triangles triangles;               ///< those that are drawn, by the part's own vertices
  std::vector<std::uint16_t> looks;  ///< per drawn triangle: index into Soup::looks
  std::vector<std::uint8_t>
      edges;  ///< per drawn triangle: bit k set when the side opposite corner k is a polygon's
};
struct Soup {
  std::vector<SoupPart> parts;
  std::vector<Look> looks;
};
Soup make_soup(const Character& character);

/// One pose, in Embree. Scene space: the middle of the box at the origin, its diagonal 1; floats are finest
/// there.
class RayScene {
 public:
  RayScene(const Soup& soup, const std::vector<Points>& posed, const VertexMap* map);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  RTCScene embree() const { return scene_; }
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the box, model space
  double size = 1;                                   ///< diagonal of the box, model units
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<float> values;  ///< per vertex, or empty
  std::vector<char> mapped;   ///< per triangle: drawn by `values`
  Triangles triangles;
  std::vector<std::uint16_t> looks;
  std::vector<std::uint8_t> edges;

 private:
  void add_part(const SoupPart& part, const Points& posed, const Eigen::VectorXf* values);
  void build();
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace mien::detail
