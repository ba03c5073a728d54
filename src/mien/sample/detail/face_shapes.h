#pragma once
/// The 52 ARKit shapes of a built-in head, as displacements of its skin, eyeballs, teeth and tongue.

#include <map>
#include <string>

#include "mien/sample/detail/face_regions.h"

namespace mien::sample {

/// A small rigid motion, taken along in full by a part inside the head: p -> centre + R(axis, degrees)(p -
/// centre) + move.
struct Motion {
  Vector3d centre = Vector3d::Zero();
  Vector3d axis = Vector3d::UnitX();
  double degrees = 0;
  Vector3d move = Vector3d::Zero();
  Vector3d apply(const Vector3d& p) const;
  bool still() const { return degrees == 0 && move.isZero(); }
};

struct FaceShape {
  std::string name;
  Field skin;
  Motion eye_left, eye_right, lower_teeth, tongue;
  bool tongue_out = false;
};

/// What shapes are made from.
struct Face {
  const HeadMesh& head;
  const HeadForm& form;
  const FaceRegions& regions;
};

/// All 52, in ARKit's order.
std::vector<FaceShape> make_face_shapes(const Face& face);

/// Skin displacement under a motion, in proportion to `weights`.
Field carried(const HeadMesh& head, const Weights& weights, const Motion& motion);

/// The jaw opened by so many degrees about its hinge.
Motion jaw_opening(double degrees);

/// The left eye's lids raised by so many degrees in their middle.
Field lid_field(const Face& face, double upper, double lower);
/// The left eye shut.
Field blink_field(const Face& face);

/// The correction that brings the lips together while the jaw is open.
Field mouth_close(const Face& face, const Field& jaw_open);

struct Gathering {
  double narrow = 0;   ///< share of the width that the mouth loses
  double open = 0;     ///< how far each lip leaves the line between them
  double forward = 0;  ///< how far the lips come out
};
Field lips_gathered(const Face& face, const Gathering& gathering);
/// One lip turned in over the teeth.
Field lip_roll(const Face& face, bool upper);
/// The left half of the lips pressed together.
Field lip_press(const Face& face);

}  // namespace mien::sample
