// Shapes of the lips that follow their loops.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mien/sample/detail/contours.h"
#include "mien/sample/detail/face_shapes.h"

namespace mien::sample {

Vector3d Motion::apply(const Vector3d& p) const {
  return centre + Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis) * (p - centre) + move;
}

Motion jaw_opening(double degrees) {
  Motion motion;
  motion.centre = Vector3d(0, -2.4, 0.6);
  motion.degrees = degrees;
  motion.move = Vector3d(0, -0.12, 0.25) * (degrees / 20);
  return motion;
}

Field carried(const HeadMesh& head, const Weights& weights, const Motion& motion) {
  Field field(head.points.size());
  for (std::size_t v = 0; v < field.size(); ++v)
    field[v] = weights[v] > 1e-6 ? Vector3d(weights[v] * (motion.apply(head.points[v]) - head.points[v]))
                                 : Vector3d::Zero();
  return field;
}

Field mouth_close(const Face& face, const Field& jaw_open) {
  const auto& [head, form, regions] = face;
  // The lips meet a third of the way down; below and above them the correction fades out.
  Field field(head.points.size(), Vector3d::Zero());
  const int last = static_cast<int>(head.half.mouth[0].size()) - 1;
  const auto close = [&](int v, int partner, int slot) {
    if (slot * 2 == last) return;
    const bool upper = slot * 2 < last;
    const Vector3d opening =
        upper ? Vector3d(jaw_open[partner] - jaw_open[v]) : Vector3d(jaw_open[v] - jaw_open[partner]);
    // Both lips go to one place: it leaves the teeth behind it alone.
    const Vector3d meeting(0.35 * opening.x(), 0.33 * opening.y(), 0.1 * opening.z());
    field[v] = regions.lips[v] * (upper ? meeting : Vector3d(meeting - opening));
  };
  for (const Loop& loop : head.half.mouth)
    for (int a = 0; a <= last; ++a) {
      close(loop[a], loop[last - a], a);
      close(head.mirror[loop[a]], head.mirror[loop[last - a]], a);
    }
  return field;
}

Field lips_gathered(const Face& face, const Gathering& gathering) {
  const auto& [head, form, regions] = face;
  const auto& [narrow, open, forward] = gathering;
  const MouthForm& mouth = form.mouth;
  Field field(head.points.size(), Vector3d::Zero());
  const Vector3d centre(0, mouth.line, mouth.front - 0.8);
  for (std::size_t v = 0; v < field.size(); ++v) {
    const Vector3d& p = head.points[v];
    const double around = soft(p, centre, {5.6, 4.0, 4.6});
    const double w = std::max(around, 0.0) * (0.45 + 0.55 * regions.lips[v]);
    if (w <= 0) continue;
    const double across = std::min(1.0, std::abs(p.x()) / mouth.width);
    const double side = regions.lower[v] > 0.5 ? -1 : 1;
    const double lip = std::abs(2 * regions.lower[v] - 1);
    field[v] =
        w * Vector3d(-narrow * p.x() * (0.55 + 0.45 * across), side * lip * open * (1 - across * across),
                     forward * (0.6 + 0.4 * (1 - across)) + 0.9 * forward * across * across);
  }
  return field;
}

Field lip_roll(const Face& face, bool upper) {
  const auto& [head, form, regions] = face;
  Field field(head.points.size(), Vector3d::Zero());
  const int border = head.half.lip_border, contact = head.half.lip_contact;
  const int last = static_cast<int>(head.half.mouth[0].size()) - 1;
  for (std::size_t v = 0; v < field.size(); ++v) {
    const LoopPlace place = regions.mouth[v];
    if (place.ring < 1 || (place.slot * 2 < last) != upper || place.slot * 2 == last) continue;
    const double t = upper ? place.slot / (0.5 * last) : (last - place.slot) / (0.5 * last);
    const double along = std::cos(std::pow(t, 2.0) * std::numbers::pi / 2);
    const double amount = along * std::clamp(double(place.ring) / border, 0.0, 1.0);
    // From the border on, the lip turns in behind the line where it met the other.
    const double in = std::clamp(double(place.ring - border + 1) / (contact - border + 1), 0.0, 1.0);
    const double height =
        upper ? form.mouth.upper_border - form.mouth.line : form.mouth.line - form.mouth.lower_border;
    const double toward = (upper ? -1 : 1) * height * (0.45 * amount * amount * (1 - 0.75 * in));
    const double behind = place.ring > contact + 3 ? 0.3 : 1;
    field[v] = behind * Vector3d(0, toward, -0.55 * amount * amount * (0.35 + 0.65 * in));
  }
  return field;
}

Field lip_press(const Face& face) {
  const auto& [head, form, regions] = face;
  Field field(head.points.size(), Vector3d::Zero());
  const int border = head.half.lip_border, contact = head.half.lip_contact;
  const int last = static_cast<int>(head.half.mouth[0].size()) - 1;
  for (std::size_t v = 0; v < field.size(); ++v) {
    const LoopPlace place = regions.mouth[v];
    if (place.ring < 1 || place.ring > contact + 1 || place.slot * 2 == last) continue;
    const double t = place.slot * 2 < last ? place.slot / (0.5 * last) : (last - place.slot) / (0.5 * last);
    const Loop& meeting = head.half.mouth[contact];
    const double middle =
        (head.points[meeting[place.slot]].y() + head.points[meeting[last - place.slot]].y()) / 2;
    const double out = std::clamp(double(place.ring) / border, 0.0, 1.0);
    // Left and right halves add up to a press of the whole mouth.
    const double x = head.points[v].x() / 1.2;
    const double left = std::clamp(0.5 + 0.5 * x, 0.0, 1.0);
    const double press = place.ring >= contact ? 1.0 : 0.34 * out;
    field[v] = left * Vector3d(0.06 * out * t, press * (middle - head.points[v].y()), -0.12 * out);
  }
  return field;
}

}  // namespace mien::sample
