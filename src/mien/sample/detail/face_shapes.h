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

/// All 52, in ARKit's order.
std::vector<FaceShape> make_face_shapes(const HeadMesh& head, const HeadForm& form,
                                        const FaceRegions& regions);

/// Where the lids' and the eye's shapes are made.
Field lid_field(const HeadMesh& head, const HeadForm& form, const FaceRegions& regions, double upper,
                double lower);
Field blink_field(const HeadMesh& head, const HeadForm& form, const FaceRegions& regions);

/// Skin displacement under a motion, in proportion to `weights`.
Field carried(const HeadMesh& head, const Weights& weights, const Motion& motion);

/// The jaw's hinge axis and how far it opens.
Motion jaw_opening(double degrees);

// Shapes of the lips that need more than pulls.
Field mouth_close(const HeadMesh& head, const FaceRegions& regions, const Field& jaw_open);
Field lips_gathered(const HeadMesh& head, const HeadForm& form, const FaceRegions& regions, double narrow,
                    double open, double forward);
Field lip_roll(const HeadMesh& head, const HeadForm& form, const FaceRegions& regions, bool upper);
Field lip_press(const HeadMesh& head, const FaceRegions& regions);

}  // namespace mien::sample
