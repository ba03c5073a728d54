// Nostril and ear: loops laid out by angle around a centre.

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mien/sample/detail/half_head.h"

namespace mien::sample {

namespace {

/// Quads (and a triangle at each end) across a closed loop, whose first vertex and the one opposite are the
/// ends.
void close_loop(HalfHead& half, const Loop& loop) {
  const int count = static_cast<int>(loop.size());
  for (int a = 0; a + 1 < count / 2; ++a) {
    const int b = count - 1 - a;
    half.quads.push_back({loop[a], loop[b], loop[b - 1], loop[a + 1]});
    half.cap.push_back(0);
  }
}

void push_loop(HalfHead& half, std::vector<Loop>& loops, const std::vector<Vector3d>& points,
               HalfHead::Hold hold, double inward) {
  const Loop& border = loops.front();
  Vector2d uv_centre = Vector2d::Zero();
  for (int v : border) uv_centre += half.uvs[v] / border.size();
  Loop loop;
  for (std::size_t a = 0; a < border.size(); ++a)
    loop.push_back(
        half.add(points[a], half.uvs[border[a]] + inward * (uv_centre - half.uvs[border[a]]), hold));
  half.bridge(loops.back(), loop, true);
  loops.push_back(loop);
}

}  // namespace

void add_nostril(HalfHead& half, const HeadForm& form) {
  const NostrilForm& nostril = form.nostril;
  half.nostril.push_back(border_of(half, form.grid.nostril));
  const int count = static_cast<int>(half.nostril[0].size());
  const Vector3d inward = nostril.inward.normalized();
  // In the opening's plane: `ahead` along its long axis, `outer` towards the wing.
  const double turn = nostril.turn * std::numbers::pi / 180;
  Vector3d ahead(-std::sin(turn), 0, std::cos(turn));
  ahead = (ahead - ahead.dot(inward) * inward).normalized();
  const Vector3d outer = ahead.cross(-inward);
  std::vector<Vector3d> ring(count), rim(count);
  Vector3d middle = Vector3d::Zero();
  const auto at = [&](double size) {
    for (int a = 0; a < count; ++a) {
      // The border starts at the septum and goes over the tip's side to the wing.
      const double angle = std::numbers::pi - 2 * std::numbers::pi * a / count;
      ring[a] = nostril.centre +
                size * (std::cos(angle) * nostril.width * outer + std::sin(angle) * nostril.length * ahead);
      ring[a] = form.sculpt.project(ring[a], 8);
    }
  };
  at(1.3);
  push_loop(half, half.nostril, ring, HalfHead::Hold::surface, 0.3);
  at(1.0);
  push_loop(half, half.nostril, ring, HalfHead::Hold::surface, 0.45);
  rim = ring;
  for (const Vector3d& p : rim) middle += p / count;
  const auto inside = [&](double size, double deep) {
    for (int a = 0; a < count; ++a)
      ring[a] = middle + size * (rim[a] - middle) + deep * nostril.depth * inward;
  };
  inside(0.92, 0.3);
  push_loop(half, half.nostril, ring, HalfHead::Hold::fixed, 0.6);
  inside(0.6, 1.0);
  push_loop(half, half.nostril, ring, HalfHead::Hold::fixed, 0.8);
  close_loop(half, half.nostril.back());
}

void add_ear(HalfHead& half, const HeadForm& form) {
  const EarForm& ear = form.ear;
  half.ear.push_back(border_of(half, form.grid.ear));
  const int count = static_cast<int>(half.ear[0].size());
  const double degree = std::numbers::pi / 180;
  // The ear's own axes: up along it, back across it, out away from the head.
  const Vector3d up(0, std::cos(ear.tilt * degree), -std::sin(ear.tilt * degree));
  const Vector3d straight_back(0, -std::sin(ear.tilt * degree), -std::cos(ear.tilt * degree));
  const Vector3d back =
      std::cos(ear.flare * degree) * straight_back + std::sin(ear.flare * degree) * Vector3d::UnitX();
  const Vector3d out = up.cross(-back).normalized();
  std::vector<Vector3d> ring(count);

  // A loop of the ear: the outline shrunk by `size` about a point `down` below its centre, `out_by` from the
  // plane.
  const auto outline = [&](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    // Wide above, narrow at the lobe; the front edge is nearly straight.
    const double width = (c > 0 ? ear.back * (0.82 + 0.2 * s - 0.06 * s * s) : ear.ahead * (0.8 + 0.2 * s));
    const double height = s > 0 ? ear.up : ear.down;
    double b = width * c, u = height * s;
    const double tip = std::exp(-std::pow((angle - std::numbers::pi / 3) / 0.45, 2));
    u += ear.point * tip;
    b += 0.8 * ear.point * tip;
    return Vector2d(b, u);
  };
  struct Level {
    double size, lift, shift_back, shift_up, front_lift;
  };
  const auto level = [&](const Level& l) {
    for (int a = 0; a < count; ++a) {
      const double angle = std::numbers::pi - 2 * std::numbers::pi * a / count;
      const Vector2d p = l.size * outline(angle) + Vector2d(l.shift_back, l.shift_up);
      const double front = std::max(0.0, -std::cos(angle));
      // Ahead the rim runs into the cheek.
      const double sunk = l.size > 0.75 ? 0.65 * front * front : 0;
      const double lift = (l.lift + l.front_lift * front * front) * (1 - sunk);
      // The tragus: a flap in front of the canal.
      const double tragus = std::exp(-std::pow((angle - 1.02 * std::numbers::pi) / 0.35, 2)) +
                            std::exp(-std::pow((angle + 0.98 * std::numbers::pi) / 0.35, 2));
      ring[a] = ear.centre + p.x() * back + p.y() * up + lift * out;
      ring[a] += tragus * (l.size > 0.55 && l.size < 0.9 ? 0.25 : 0.0) * (out + 0.6 * back);
    }
  };
  for (int a = 0; a < count; ++a) {
    const double angle = std::numbers::pi - 2 * std::numbers::pi * a / count;
    ring[a] = ear.centre + ear.root_height * std::sin(angle) * up +
              ear.root_width * std::cos(angle) * straight_back;
  }
  push_loop(half, half.ear, ring, HalfHead::Hold::surface, 0.15);
  const double s = ear.stand, r = ear.rim;
  const Level levels[] = {
      {0.80, 0.45 * s, 0.15, 0, 0.3 * s}, {0.96, s - 0.5 * r, 0, 0, 0},        {1.00, s, 0, 0, 0},
      {0.97, s + 0.5 * r, 0, 0, 0},       {0.88, s + 0.45 * r, 0, 0, 0},       {0.80, s - 0.1 * r, 0, 0, 0.2},
      {0.68, s - 0.1 * r, 0, 0, 0.2},     {0.56, s + 0.25 * r, 0, -0.05, 0.0}, {0.44, s - 0.2, 0, -0.1, 0},
      {0.32, s - 0.75, -0.05, -0.2, 0},   {0.14, s - 0.9, -0.2, -0.2, 0}};
  double inward = 0.2;
  for (const Level& l : levels) {
    level(l);
    push_loop(half, half.ear, ring, HalfHead::Hold::fixed, inward += 0.065);
  }
  close_loop(half, half.ear.back());
}

}  // namespace mien::sample
