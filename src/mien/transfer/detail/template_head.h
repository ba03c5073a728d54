#pragma once
/// The two heads that finding landmarks works with: one whose landmarks are known, one where they are sought.

#include <string>
#include <vector>

#include "mien/transfer/detail/pool.h"
#include "mien/transfer/register_surfaces.h"

namespace mien::detail {

/// Radius of the relief that faces are compared by, in face sizes.
constexpr double relief_radius = 0.05;

/// A head with known landmarks in its canonical frame: the face looks along +Z, Y up, its left at +X, landmarks'
/// mean at the origin, `face_size` one.
struct TemplateHead {
  Surface skin;
  PointsD normals;            ///< #V, unit
  Eigen::VectorXd attention;  ///< #V: 1 on the face, falling to a tenth on cranium and neck
  Eigen::VectorXd openness;   ///< #V
  Eigen::VectorXd relief;     ///< #V, with `relief_radius`
  std::vector<int>
      samples;     ///< vertices of the open skin, far from each other, denser on the face; any prefix is even
  PointsD points;  ///< #L: landmarks and curve points, canonical
  std::vector<int> mirror;  ///< #L: the row on the other side (itself on the midline), -1: none
  Similarity to_canonical;  ///< model space to canonical
};

/// The landmarks and then the curves' points of a character, as surface points with names ("curve 2" for the third
/// point of a curve).
std::vector<LandmarkPoint> all_points(const Character& character);

///   facing  model space to a space where the head looks along +Z with +Y up
///   throws  invalid_input: fewer than 4 landmarks, all in one place
TemplateHead make_template_head(const Character& like, const Eigen::Matrix3d& facing);

/// The largest piece that its name does not call an eye, tooth, tongue or lash, as a welded surface: the head's skin.
struct SoughtHead {
  Pool pool;
  PoolSurface skin;
  PointsD normals;
  Eigen::VectorXd openness;
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();  ///< of the skin's box
  double size = 1;                                         ///< its diagonal
};
///   throws  invalid_input: no faces
SoughtHead make_sought_head(const Character& target);

}  // namespace mien::detail
