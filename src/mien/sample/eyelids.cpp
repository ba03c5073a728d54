// The lids: their edges are drawn on the eyeball by angles, so that they lie on it and shut on it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mien/sample/detail/contours.h"
#include "mien/sample/detail/half_head.h"

namespace mien::sample {

Vector3d eye_direction(double azimuth, double elevation) {
  const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

namespace {

double corner_line(const EyeForm& eye, double t) {
  return eye.inner_tilt + t * (eye.outer_tilt - eye.inner_tilt);
}

/// 0 at the corners, 1 at the lid's highest point, which lies `early` (towards the nose) or late along it.
double arch(const EyeForm& eye, double t, double skew) {
  return std::pow(std::sin(std::numbers::pi * std::pow(t, skew)), eye.sharpness);
}

}  // namespace

Eigen::Vector2d lid_edge(const EyeForm& eye, bool upper, double t) {
  const double azimuth = eye.inner + (eye.outer - eye.inner) * (1 - std::cos(std::numbers::pi * t)) / 2;
  // The upper lid peaks towards the nose, the lower one towards the temple.
  const double height = upper ? eye.upper * arch(eye, t, 0.93) : eye.lower * arch(eye, t, 1.1);
  return {azimuth, corner_line(eye, t) + height};
}

Eigen::Vector2d lid_meeting(const EyeForm& eye, double t) {
  const Eigen::Vector2d upper = lid_edge(eye, true, t), lower = lid_edge(eye, false, t);
  const double down = -eye.close_at;
  return {upper.x(), (1 - down) * (corner_line(eye, t)) + down * lower.y()};
}

void add_eyelids(HalfHead& half, const HeadForm& form) {
  const EyeForm& eye = form.eye;
  const Loop border = border_of(half, form.grid.eye);
  const int count = static_cast<int>(border.size()), turn = count / 2;
  Vector2d uv_centre = Vector2d::Zero();
  for (int v : border) uv_centre += half.uvs[v] / count;
  const auto edge = [&](int a) {
    return a <= turn ? lid_edge(eye, true, double(a) / turn) : lid_edge(eye, false, double(count - a) / turn);
  };
  const Eigen::Vector2d middle((eye.inner + eye.outer) / 2, (eye.inner_tilt + eye.outer_tilt) / 2);

  half.eye.push_back(border);
  const int rings = form.grid.eye_rings;
  const int total = rings + 6;  // for the UVs: rings on the face, then those inside
  const auto push = [&](const std::vector<Vector3d>& points, HalfHead::Hold hold, int k) {
    Loop loop;
    for (int a = 0; a < count; ++a)
      loop.push_back(half.add(
          points[a], half.uvs[border[a]] + (uv_centre - half.uvs[border[a]]) * (0.92 * k / total), hold));
    half.bridge(half.eye.back(), loop, true);
    half.eye.push_back(loop);
  };

  // The loop just outside the edge holds its roundness; the ones between it and the border are free.
  std::vector<Vector3d> lid(count), ring(count);
  for (int a = 0; a < count; ++a) {
    const Eigen::Vector2d e = edge(a), out = middle + (e - middle).cwiseProduct(Eigen::Vector2d(1.05, 1.0));
    const double lift = a < turn ? 3.5 : a == turn || a == 0 ? 0 : -3.5;
    lid[a] = eye.centre + (eye.radius + eye.lid_thickness) * eye_direction(out.x(), out.y() + lift);
  }
  for (int k = 1; k < rings; ++k) {
    const double t = std::pow(double(k) / (rings - 1), 0.8);
    for (int a = 0; a < count; ++a) ring[a] = (1 - t) * half.points[border[a]] + t * lid[a];
    push(ring, k + 1 < rings ? HalfHead::Hold::free : HalfHead::Hold::surface, k);
  }
  const auto at = [&](double radius, double spread, double extra) {
    for (int a = 0; a < count; ++a) {
      Eigen::Vector2d e = edge(a);
      e = middle + (e - middle) * spread;
      ring[a] = eye.centre + (eye.radius + radius) * eye_direction(e.x(), e.y() + (a == 0 || a == turn ? 0
                                                                                   : a < turn          ? extra
                                                                                              : -extra));
    }
  };
  at(eye.lid_thickness, 1, 0);
  half.lid_edge = static_cast<int>(half.eye.size());
  push(ring, HalfHead::Hold::fixed, rings);
  at(0.03 * eye.radius, 0.995, 0);
  push(ring, HalfHead::Hold::fixed, rings + 1);
  // The socket behind the lids, between them and the eyeball.
  const double behind[4] = {6, 20, 40, 60};
  for (int k = 0; k < 4; ++k) {
    at(0.04 * eye.radius, 1 + 0.1 * k, behind[k]);
    push(ring, HalfHead::Hold::fixed, rings + 2 + k);
  }
}

}  // namespace mien::sample
