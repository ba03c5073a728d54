// Lids turn about the eye's centre, so that they slide on the eyeball; the loops around the eye follow less
// the farther out they are.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mien/sample/detail/contours.h"
#include "mien/sample/detail/face_shapes.h"

namespace mien::sample {

namespace {

/// Displacement of the left eye's loops when each place of the lids' edges rises by `raise(upper, t)`
/// degrees.
template <typename Raise>
Field turn_lids(const Face& face, Raise raise) {
  const auto& [head, form, regions] = face;
  Field field(head.points.size(), Vector3d::Zero());
  const int count = static_cast<int>(head.half.eye[0].size()), turn = count / 2, edge = head.half.lid_edge;
  for (std::size_t v = 0; v < head.points.size(); ++v) {
    const LoopPlace place = regions.left_eye[v];
    if (place.ring < 1 || place.slot % turn == 0) continue;
    const bool upper = place.slot < turn;
    const double t = double(upper ? place.slot : count - place.slot) / turn;
    const double out = std::clamp(double(place.ring) / edge, 0.0, 1.0);
    const double behind = std::max(0, place.ring - edge - 2);
    const double share = behind > 0 ? 1 / (1 + 0.6 * behind) : std::pow(out, 1.7);
    const Vector3d from = head.points[v] - form.eye.centre;
    const double radius = from.norm();
    const double elevation = std::asin(std::clamp(from.y() / radius, -1.0, 1.0)) * 180 / std::numbers::pi;
    const double azimuth = std::atan2(from.x(), from.z()) * 180 / std::numbers::pi;
    // A lid is as thick on the way as at rest: what lies close to the eyeball stays as far from it.
    field[v] = radius * eye_direction(azimuth, elevation + share * raise(upper, t)) - from;
  }
  return field;
}

}  // namespace

Field lid_field(const Face& face, double upper, double lower) {
  return turn_lids(face, [&](bool is_upper, double t) {
    return (is_upper ? upper : lower) * std::pow(std::sin(std::numbers::pi * t), 0.7);
  });
}

Field blink_field(const Face& face) {
  return turn_lids(face, [&](bool upper, double t) {
    return lid_meeting(face.form.eye, t).y() - lid_edge(face.form.eye, upper, t).y();
  });
}

}  // namespace mien::sample
