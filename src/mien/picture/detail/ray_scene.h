#pragma once
/// All parts of a posed character as one triangle soup that rays can hit.

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mien/character/character.h"
#include "mien/picture/detail/looks.h"
#include "mien/picture/render.h"

namespace mien::detail {

/// UVs of a triangle's corners, v up.
using CornerUvs = std::array<Eigen::Vector2f, 3>;

/// What does not depend on the pose.
struct SoupPart {
  std::vector<int> welded;           ///< #V: welded number
  std::vector<int> first;            ///< #W: a vertex with that number
  Triangles welded_triangles;        ///< all triangles by welded numbers
  Triangles triangles;               ///< those that are drawn, by the part's own vertices
  std::vector<std::uint16_t> looks;  ///< per drawn triangle: index into Soup::looks
  std::vector<std::uint8_t>
      edges;  ///< per drawn triangle: bit k set when the side opposite corner k is a polygon's
  std::vector<CornerUvs> uvs;  ///< per drawn triangle, or none in a part without images
  Points colors;               ///< #V, linear RGB, or no rows
};
struct Soup {
  std::vector<SoupPart> parts;
  std::vector<Look> looks;
  Paint paint;
};
/// `painted`: with the character's images and vertex colours.
Soup make_soup(const Character& character, bool painted);

/// One pose, in Embree. Scene space: the middle of the box at the origin, its diagonal 1; floats are finest
/// there.
class RayScene {
 public:
  RayScene(const Soup& soup, const std::vector<Points>& posed, const VertexMap* map);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Everything; hits are numbered by `triangle_of`.
  RTCScene all() const { return all_; }
  /// Without thin things such as lashes, which cast no shadow.
  RTCScene solid() const { return solid_; }
  int triangle_of(unsigned geometry, unsigned primitive) const {
    return static_cast<int>(primitive) + (geometry == 0 ? 0 : solid_count_);
  }
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the box, model space
  double size = 1;                                   ///< diagonal of the box, model units
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<float> values;               ///< per vertex, or empty
  std::vector<Eigen::Vector3f> colors;     ///< per vertex, white where a part has none
  std::vector<char> mapped;                ///< per triangle: drawn by `values`
  std::vector<Eigen::Vector3i> triangles;  ///< the solid ones, then the thin ones
  std::vector<std::uint16_t> looks;
  std::vector<std::uint8_t> edges;
  std::vector<CornerUvs> uvs;  ///< per triangle

 private:
  void add_vertices(const SoupPart& part, const Points& posed, const Eigen::VectorXf* values);
  void add_triangles(const Soup& soup, const VertexMap* map, bool thin);
  RTCGeometry make_geometry(std::size_t begin, std::size_t end) const;
  void build();
  RTCDevice device_ = nullptr;
  RTCScene all_ = nullptr, solid_ = nullptr;
  int solid_count_ = 0;
};

}  // namespace mien::detail
