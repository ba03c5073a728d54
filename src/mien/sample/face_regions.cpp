#include "mien/sample/detail/face_regions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mien/sample/detail/smooth_step.h"

namespace mien::sample {

namespace {

/// Spreads values of the left half's vertices to their twins.
Weights to_both_sides(const HeadMesh& head, const Weights& half) {
  Weights whole(head.points.size());
  for (std::size_t v = 0; v < half.size(); ++v) whole[v] = whole[head.mirror[v]] = half[v];
  return whole;
}

}  // namespace

double soft(const Vector3d& p, const Vector3d& centre, const Vector3d& radii) {
  const double r2 = (p - centre).cwiseQuotient(radii).squaredNorm();
  return r2 < 1 ? (1 - r2) * (1 - r2) : 0;
}

Field mirrored(const HeadMesh& head, const Field& field) {
  Field out(field.size());
  for (std::size_t v = 0; v < field.size(); ++v) {
    const Vector3d& d = field[head.mirror[v]];
    out[v] = {-d.x(), d.y(), d.z()};
  }
  return out;
}

Weights diffuse(const HeadMesh& head, const std::function<std::optional<double>(int)>& seed, int rounds) {
  const std::size_t n = head.half.points.size();
  std::vector<std::vector<int>> around(n);
  for (const auto& quad : head.half.quads) {
    const int corners = quad[3] < 0 ? 3 : 4;
    for (int c = 0; c < corners; ++c) {
      around[quad[c]].push_back(quad[(c + 1) % corners]);
      around[quad[(c + 1) % corners]].push_back(quad[c]);
    }
  }
  Weights value(n, 0.0);
  std::vector<int> open;
  for (std::size_t v = 0; v < n; ++v) {
    if (const auto fixed = seed(static_cast<int>(v)))
      value[v] = *fixed;
    else
      open.push_back(static_cast<int>(v));
  }
  for (int round = 0; round < rounds; ++round)
    for (int v : open) {
      double sum = 0;
      for (int other : around[v]) sum += value[other];
      value[v] = sum / around[v].size();
    }
  return to_both_sides(head, value);
}

FaceRegions make_regions(const HeadMesh& head, const HeadForm& form) {
  FaceRegions regions;
  const std::size_t n = head.points.size();
  regions.left_eye.resize(n);
  regions.mouth.resize(n);
  for (std::size_t k = 0; k < head.half.eye.size(); ++k)
    for (std::size_t a = 0; a < head.half.eye[k].size(); ++a)
      regions.left_eye[head.half.eye[k][a]] = {static_cast<int>(k), static_cast<int>(a)};
  for (std::size_t k = 0; k < head.half.mouth.size(); ++k)
    for (std::size_t a = 0; a < head.half.mouth[k].size(); ++a)
      for (const int v : {head.half.mouth[k][a], head.mirror[head.half.mouth[k][a]]})
        regions.mouth[v] = {static_cast<int>(k), static_cast<int>(a)};

  const MouthForm& mouth = form.mouth;
  const int border = head.half.lip_border;
  const double last = static_cast<double>(head.half.mouth[0].size() - 1);
  const auto jaw_side = [&](int v, double on_lips) -> std::optional<double> {
    const Vector3d& p = head.points[v];
    if (regions.mouth[v].ring >= border) return on_lips;
    if (p.y() > mouth.line + 1.9 || p.y() < mouth.lower_border - 7.2 || p.z() < 0.5) return 0;
    if (p.y() < mouth.lower_border - 0.8 && p.z() > 6) return 1;
    return std::nullopt;
  };
  const auto along = [&](int v) { return regions.mouth[v].slot / last; };
  // By this cosine the opening mouth is an oval.
  regions.jaw =
      diffuse(head, [&](int v) { return jaw_side(v, 0.5 - 0.5 * std::cos(std::numbers::pi * along(v))); });
  regions.lower = diffuse(head, [&](int v) { return jaw_side(v, smooth_step(0.4, 0.6, along(v))); });
  regions.neck = diffuse(head, [&](int v) -> std::optional<double> {
    const Vector3d& p = head.points[v];
    if (p.y() < mouth.lower_border - 7.5) return 1;
    if (p.z() > 3.5 || p.y() > mouth.line + 3) return 0;
    return std::nullopt;
  });
  regions.lips = diffuse(head, [&](int v) -> std::optional<double> {
    const LoopPlace place = regions.mouth[v];
    if (place.ring >= border - 1) return 1;
    if (place.ring < 1) return 0;
    return std::nullopt;
  });
  return regions;
}

}  // namespace mien::sample
