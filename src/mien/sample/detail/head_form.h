#pragma once
/// Everything that tells one built-in head from another: its flesh, the openings in it and how finely it is
/// meshed.
///
/// Centimetres and degrees, the head looks along +Z, Y is up, the character's left is at +X. Paired features
/// are given for the left side.

#include <Eigen/Core>
#include <vector>

#include "mien/sample/detail/sculpt.h"

namespace mien::sample {

/// One opening between the lids, drawn on the eyeball by angles: azimuth (towards +X) and elevation seen from
/// the eye's centre.
struct EyeForm {
  Vector3d centre = Vector3d(3.15, 0, 7.0);
  double radius = 1.45;  ///< of the eyeball
  double lid_thickness = 0.13;
  double inner = -58, outer = 56;          ///< azimuth of the corners
  double inner_tilt = -5, outer_tilt = 3;  ///< elevation of the corners
  double upper = 26, lower = -19;  ///< elevation of the lids' edges, above the line between the corners
  double sharpness = 1.25;         ///< 1: an oval; more: pointed corners
  double close_at = -0.6;  ///< where the lids meet: 0 halfway along `upper`, -1 on the lower lid's edge
};

struct MouthForm {
  double width = 2.6;  ///< half the distance between the corners
  double line = -6.92,
         corner = -7.0;  ///< height of the line between the lips, at the middle and at the corners
  double upper_border = -6.02,
         bow = 0.12;  ///< height of the upper lip's border; how far the bow dips in the middle
  double lower_border = -7.95;
  double front = 10.6,
         corner_front = 9.3;  ///< z of the line between the lips, at the middle and at the corners
  double gap = 0.04;          ///< how far the lips are apart at rest
  double bag_width = 2.5, bag_height = 1.7, bag_depth = 5.2;  ///< of the cavity behind the lips
};

struct NostrilForm {
  Vector3d centre = Vector3d(0.62, -4.6, 10.68);
  Vector3d inward = Vector3d(0.1, 0.95, -0.1);  ///< from the opening into the nose
  double length = 0.42, width = 0.26;           ///< half axes of the opening
  double turn = 25;                             ///< of its long axis from straight ahead, towards the middle
  double depth = 0.8;
};

struct EarForm {
  Vector3d centre = Vector3d(6.9, -1.4, -0.8);           ///< of the root on the head
  double root_height = 2.1, root_width = 0.75;           ///< half axes of the root
  double tilt = 12;                                      ///< top backwards
  double flare = 24;                                     ///< of the ear's plane from the head's side
  double up = 3.0, down = 3.1, back = 2.5, ahead = 1.0;  ///< reach of the outline from the root's centre
  double point = 0;                                      ///< how far the tip is drawn out up and back
  double stand = 0.7;                                    ///< how far the rim stands off the head
  double rim = 0.3;                                      ///< thickness of the rim
};

/// A ring of cells around the head: how its rays leave the head's axis.
struct KeyRow {
  int steps;                 ///< cells between the row before and this one
  double axis_y, axis_z;     ///< where the rays start
  double front, side, back;  ///< their elevation, ahead, at the ears and behind
};
struct KeyColumn {
  int steps;
  double azimuth;  ///< 0 ahead, 180 behind
};
/// Cells of the half head's grid that an opening replaces: columns [i0, i1), rows [j0, j1).
struct Block {
  int i0, i1, j0, j1;
};

struct GridForm {
  std::vector<KeyRow> rows;        ///< from the base of the neck up
  std::vector<KeyColumn> columns;  ///< from the middle of the face to the middle of the back
  Block eye, mouth, nostril, ear;
  int crown_width = 9;  ///< cells across half the crown's cap
  int eye_rings = 6,
      mouth_rings = 5;  ///< rings of cells between the block's border and the lid's or lip's edge
  int relaxations = 30;
};

struct HeadForm {
  Sculpt sculpt;
  EyeForm eye;
  MouthForm mouth;
  NostrilForm nostril;
  EarForm ear;
  GridForm grid;
};

}  // namespace mien::sample
