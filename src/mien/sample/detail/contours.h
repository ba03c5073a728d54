#pragma once
/// The edges of lids and lips as curves.

#include "mien/sample/detail/head_form.h"

namespace mien::sample {

/// Unit direction from the eye's centre, by azimuth and elevation in degrees.
Vector3d eye_direction(double azimuth, double elevation);

/// A point of a lid's edge at t in [0, 1] from the inner to the outer corner: (azimuth, elevation).
Eigen::Vector2d lid_edge(const EyeForm& eye, bool upper, double t);
/// Where the lids meet when the eye is shut.
Eigen::Vector2d lid_meeting(const EyeForm& eye, double t);

/// The curves of the lips at t in [0, 1] from the middle to the left corner, in front view (x, y) with the z
/// of the line between the lips.
Vector3d lip_border_at(const MouthForm& mouth, bool upper, double t);
Vector3d lip_line_at(const MouthForm& mouth, double t);

}  // namespace mien::sample
