#pragma once
/// What sits inside a head: eyeballs, teeth, tongue; and the hair that grows on it: brows and lashes.

#include "mien/geometry/mesh.h"
#include "mien/sample/detail/head_mesh.h"

namespace mien::sample {

/// Indices into the materials of every built-in character.
enum MaterialId {
  skin_material,
  white_material,
  iris_material,
  pupil_material,
  tooth_material,
  gum_material,
  tongue_material,
  hair_material,
  mouth_material,
  lip_material,
  limbus_material
};

/// One eyeball around its centre, looking along +Z; groups: white, iris, its dark rim, pupil.
Mesh make_eyeball(const Vector3d& centre, double radius, double iris_degrees);

struct TeethForm {
  double width = 2.35, depth = 3.9;  ///< of the arch: half its width, its length from front to back
  double front = 9.5;                ///< z of the foremost edge
  double edge = -6.75;               ///< height of the biting edge
  double height = 1.0;               ///< of the crowns, upwards; negative: downwards
  double gum = 0.7;                  ///< height of the gum over the crowns
  double thickness = 0.55;
  int teeth = 14;
  double pointed = 0;  ///< 0: blunt; 1: each tooth ends in a point
  double fang = 0;     ///< how much longer the canines are
};
/// A row of teeth in its gum; groups: teeth, gum.
Mesh make_teeth(const TeethForm& form);

struct TongueForm {
  Vector3d root = Vector3d(0, -8.3, 4.2), middle = Vector3d(0, -7.3, 6.6), tip = Vector3d(0, -7.55, 8.7);
  double width = 1.7, thickness = 0.65;
};
Mesh make_tongue(const TongueForm& form);

/// A strip of hair along a line on the skin; the line of the left side, both sides are made.
struct BrowForm {
  std::vector<Vector3d> line;  ///< points on the skin from the inner to the outer end
  double height = 0.7;         ///< at its thickest
  double thickness = 0.22;
};
Mesh make_brows(const BrowForm& form, const Sculpt& sculpt);
/// Lashes along the upper lids' edges. `anchors` receives the skin vertex that each vertex grows from.
Mesh make_lashes(const HeadMesh& head, const HeadForm& form, double length, std::vector<int>& anchors);

}  // namespace mien::sample
