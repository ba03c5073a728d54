#pragma once
/// Where on the source each pixel of a target's layout lies.

#include <Eigen/Core>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/geometry/surface_query.h"
#include "mien/texture/texel_grid.h"

namespace mien::detail {

/// Triangles of all shown parts, each with where it came from.
struct BakeSurface {
  PointsD positions, normals;               ///< #V x 3, seams welded, model space
  Triangles triangles;                      ///< #T x 3
  std::vector<int> part, face, material;    ///< #T; material -1: none
  std::vector<std::array<int, 3>> corners;  ///< #T: which corners of the face
  std::vector<int> piece;                   ///< #T: connected piece
  int piece_count = 0;
  std::vector<char> skin;  ///< by piece: one of the character's landmarks lies on it
};
///   positions  model space, one #V x 3 a shown part
BakeSurface bake_surface(const Character& character, const std::vector<Points>& positions);

/// The parts' own vertices in model space.
std::vector<Points> in_model_space(const Character& character);

struct Place {
  int triangle = -1;  ///< of the source, -1: none
  Eigen::Vector3f barycentric = Eigen::Vector3f::Zero();
  bool facing = false;  ///< the source faces there as the target does
};

class PlaceFinder {
 public:
  /// `guide`: the source's surface where it lies on the target. Skin finds its place on skin, and what is none (eyes, brows) on what
  /// is none: lids lie closer to a large eye than the source's eye does.
  PlaceFinder(const BakeSurface& guide, const BakeSurface& target);
  ~PlaceFinder();
  /// A place for each covered pixel; `triangle_of` are the target's triangles that the grid was drawn with.
  std::vector<Place> find(const TexelGrid& grid, const std::vector<int>& triangle_of) const;

 private:
  struct Part;
  Place find(const Part& part, const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const;
  std::vector<char> pieces_under(const Part& candidates, const std::vector<int>& triangles) const;
  std::vector<char> pieces_like(int target_piece) const;
  const BakeSurface& guide_;
  const BakeSurface& target_;
  double reach_;
  std::map<std::vector<char>, std::unique_ptr<Part>> parts_;  ///< by the pieces of the guide in them
  std::vector<const Part*> part_of_piece_;                    ///< by piece of the target
};

}  // namespace mien::detail
