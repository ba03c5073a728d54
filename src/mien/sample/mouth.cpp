// The lips, barely apart, and the bag behind them.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mien/sample/detail/contours.h"
#include "mien/sample/detail/half_head.h"

namespace mien::sample {

Vector3d lip_line_at(const MouthForm& mouth, double t) {
  const double across = std::sin(t * std::numbers::pi / 2);
  return {mouth.width * across, mouth.line + (mouth.corner - mouth.line) * across * across,
          mouth.front + (mouth.corner_front - mouth.front) * across * across};
}

Vector3d lip_border_at(const MouthForm& mouth, bool upper, double t) {
  Vector3d p = lip_line_at(mouth, t);
  const double across = p.x() / mouth.width;
  // The lip's height over the line, falling to nothing at the corner.
  const double fall = upper ? 1 - std::pow(across, 1.6) : 1 - std::pow(across, 2.2);
  p.y() += ((upper ? mouth.upper_border : mouth.lower_border) - mouth.line) * fall;
  // Beyond the end of the line the border runs around the corner.
  p.x() += 0.09 * mouth.width * std::pow(across, 8);
  // The bow: two peaks beside the middle.
  if (upper) p.y() -= mouth.bow * std::exp(-std::pow(across / 0.13, 2));
  return p;
}

namespace {

/// Where the flesh is deepest between the lips, close to the drawn line.
Vector3d lip_crease(const HeadForm& form, double t) {
  const Vector3d line = lip_line_at(form.mouth, t);
  Vector3d best = line;
  double least = 1e300;
  for (int k = -10; k <= 10; ++k) {
    const double dy = 0.025 * (1 - t * t) * k;
    const Vector3d p = form.sculpt.cast({line.x(), line.y() + dy, line.z() - 2}, Vector3d::UnitZ(), 6);
    const double cost = p.z() + 1.5 * dy * dy;
    if (cost < least) {
      least = cost;
      best = p;
    }
  }
  return best;
}

}  // namespace

void add_mouth(HalfHead& half, const HeadForm& form) {
  const MouthForm& mouth = form.mouth;
  const Loop border = border_of(half, form.grid.mouth);
  const int count = static_cast<int>(border.size()), last = count - 1, turn = last / 2;
  const Vector2d uv_centre = (half.uvs[border.front()] + half.uvs[border.back()]) / 2;
  const int rings = form.grid.mouth_rings, inner_rings = 10, total = rings + inner_rings;
  const auto along = [&](int a) { return a <= turn ? double(a) / turn : double(last - a) / turn; };

  std::vector<Vector3d> line(turn + 1);
  for (int a = 0; a <= turn; ++a) line[a] = lip_crease(form, double(a) / turn);
  for (int round = 0; round < 4; ++round) {
    const std::vector<Vector3d> before = line;
    for (int a = 0; a < turn; ++a)
      line[a].tail<2>() = (before[a ? a - 1 : 1] + 2 * before[a] + before[a + 1]).tail<2>() / 4;
  }
  for (Vector3d& p : line)
    p.z() = std::min(p.z(), form.sculpt.cast({p.x(), p.y(), p.z() - 2}, Vector3d::UnitZ(), 6).z() - 0.03);

  half.mouth.push_back(border);
  std::vector<Vector3d> ring(count);
  const auto push = [&](HalfHead::Hold hold) {
    const double t = 0.95 * half.mouth.size() / total;
    Loop loop;
    for (int a = 0; a < count; ++a)
      loop.push_back(half.add(ring[a], half.uvs[border[a]] + (uv_centre - half.uvs[border[a]]) * t, hold,
                              a == 0 || a == last));
    half.bridge(half.mouth.back(), loop, false);
    half.mouth.push_back(loop);
  };

  for (int k = 1; k <= rings; ++k) {
    const double t = std::pow(double(k) / rings, 0.85);
    for (int a = 0; a < count; ++a)
      ring[a] = (1 - t) * half.points[border[a]] +
                t * (lip_border_at(mouth, a <= turn, along(a)) + Vector3d(0, 0, 0.3));
    if (k == rings)
      for (Vector3d& p : ring) p = form.sculpt.cast(p - Vector3d(0, 0, 2), Vector3d::UnitZ(), 6);
    push(k < rings ? HalfHead::Hold::free : HalfHead::Hold::fixed);
  }
  half.lip_border = rings;
  // The red of the lips: two loops between border and line, then the line itself. Towards the corners the loops run
  // too close together to be laid on the flesh one by one.
  const auto between = [&](double t) {
    for (int a = 0; a < count; ++a) {
      const Vector3d &at = line[a <= turn ? a : last - a], edge = half.points[half.mouth[half.lip_border][a]];
      const Vector3d straight = edge + t * (at - edge);
      const double narrow = std::clamp((along(a) - 0.7) / 0.25, 0.0, 1.0);
      ring[a] = form.sculpt.cast(straight - Vector3d(0, 0, 2), Vector3d::UnitZ(), 6);
      ring[a] += narrow * (straight - ring[a]);
    }
  };
  between(0.33);
  push(HalfHead::Hold::fixed);
  between(0.72);
  push(HalfHead::Hold::fixed);
  const auto line_ring = [&](double back, double gap) {
    for (int a = 0; a < count; ++a) {
      const double open = std::sin(std::min(1.0, (1 - along(a)) * 3) * std::numbers::pi / 2);
      ring[a] = line[a <= turn ? a : last - a];
      ring[a].x() *= 1 - 0.02 * back;
      ring[a].y() += (a == turn ? 0 : a < turn ? 0.5 : -0.5) * gap * open;
      ring[a].z() -= back;
    }
  };
  // Where one lip hangs over the other, the line lies behind both.
  const Loop& inmost = half.mouth.back();
  for (int a = 0; a <= turn; ++a) {
    const double shallow = std::min(half.points[inmost[a]].z(), half.points[inmost[last - a]].z());
    line[a].z() = std::min(line[a].z(), shallow - 0.12 * (1 - double(a) / turn));
  }
  line_ring(0.0, mouth.gap);
  half.lip_contact = static_cast<int>(half.mouth.size());
  push(HalfHead::Hold::fixed);
  line_ring(0.35, mouth.gap);
  push(HalfHead::Hold::fixed);
  // The inner side of the lips, then the bag: ovals that run back to the throat.
  struct Oval {
    double back, half_width, half_height;
  };
  const Oval ovals[] = {{0.75, 0.98, 0.35}, {1.0, 1.0, 0.75},  {0.45, 1.0, 1.0},
                        {0.66, 0.95, 1.0},  {0.85, 0.85, 0.8}, {1.0, 0.6, 0.5}};
  for (int k = 0; k < 6; ++k) {
    const Oval& oval = ovals[k];
    for (int a = 0; a < count; ++a) {
      const double angle = std::numbers::pi / 2 - std::numbers::pi * a / last;
      const Vector3d& lips = line[a <= turn ? a : last - a];
      const double c = std::cos(angle), s = std::sin(angle);
      const double round = std::pow(std::abs(c), 0.8);
      // The first two follow the lips; the others are upright ovals.
      const double z =
          k < 2 ? lips.z() - oval.back
                : mouth.front - 1.2 - oval.back * (mouth.bag_depth - 1.2) - (k == 2 ? 0.8 : 0.3) * c * c;
      ring[a] = {mouth.bag_width * oval.half_width * round,
                 mouth.line + mouth.bag_height * oval.half_height * s, z};
      if (k == 0) ring[a].x() = lips.x() * 0.97;
      // The bag stays under the skin.
      const double under = form.sculpt.distance(ring[a]) + (k ? 0.3 : 0.2);
      if (under > 0) ring[a] -= under * form.sculpt.normal(ring[a]);
      if (a == 0 || a == last) ring[a].x() = 0;
    }
    push(HalfHead::Hold::fixed);
  }
  // The back wall: rows of cells across, from the upper to the lower half of the last oval.
  const Loop& back = half.mouth.back();
  for (int a = 0; a < turn; ++a) {
    const int b = last - a;
    if (a + 1 < turn)
      half.quads.push_back({back[a], back[b], back[b - 1], back[a + 1]});
    else
      half.quads.push_back({back[a], back[b], back[turn], -1});
    half.cap.push_back(0);
  }
}

}  // namespace mien::sample
