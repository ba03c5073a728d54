#include "mien/picture/detail/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "mien/picture/detail/canvas.h"

namespace mien::detail {
namespace {

constexpr float hidden_slack =
    0.004f;  // scene units: a point this far under the surface still counts as on it

Eigen::Vector3f in_scene(const RayScene& scene, const Eigen::Vector3d& position) {
  return ((position - scene.centre) / scene.size).cast<float>();
}

/// Whether a point lies before the lens.
bool lens_sees(const Lens& lens, const Eigen::Vector3f& point) {
  const Eigen::Vector3f way = point - lens.eye;
  return way.dot(lens.back) < 0 && std::isfinite(way.norm());
}

bool visible(const RayScene& scene, const Lens& lens, const Eigen::Vector3f& point) {
  const Eigen::Vector3f way = point - lens.eye;
  const float distance = way.norm();
  if (!lens_sees(lens, point)) return false;
  RTCRay ray{};
  ray.org_x = lens.eye.x();
  ray.org_y = lens.eye.y();
  ray.org_z = lens.eye.z();
  ray.dir_x = way.x() / distance;
  ray.dir_y = way.y() / distance;
  ray.dir_z = way.z() / distance;
  ray.tfar = distance - hidden_slack;
  ray.mask = ~0u;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene.solid(), &context, &ray);
  return ray.tfar >= 0;
}

void draw_line(const RayScene& scene, const Lens& lens, const Polyline& line, Canvas& canvas) {
  const double width = std::max(1.2, lens.height / 350.0);
  std::vector<Eigen::Vector2d> run;
  const auto flush = [&] {
    canvas.line(run, width, line.color);
    run.clear();
  };
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const Eigen::Vector3f a = in_scene(scene, line.points[i]), b = in_scene(scene, line.points[i + 1]);
    const float pixels = (lens.project(a) - lens.project(b)).head<2>().norm();
    const int steps = std::isfinite(pixels) ? std::clamp(static_cast<int>(pixels / 2), 1, 4096) : 1;
    for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
      const Eigen::Vector3f p = a + (b - a) * (static_cast<float>(k) / static_cast<float>(steps));
      if (line.hidden ? lens_sees(lens, p) : visible(scene, lens, p))
        run.push_back(lens.project(p).head<2>().cast<double>());
      else
        flush();
    }
  }
  flush();
}

/// A label's box in pixels.
struct Label {
  double left = 0, top = 0, right = 0, bottom = 0;
  bool overlaps(const Label& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

/// Writes the label beside its dot, in the first of four places that is free; without one it is left out.
void draw_label(const std::string& label, Eigen::Vector2d at, double radius, std::vector<Label>& taken,
                Canvas& canvas) {
  const TextStyle style{.size = std::clamp(radius * 3.2, 8.0, 14.0)};
  const double width = canvas.text_width(label, style), gap = 1.5 * radius;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(gap, -0.3 * style.size), Eigen::Vector2d(gap, style.size),
        Eigen::Vector2d(-gap - width, -0.3 * style.size), Eigen::Vector2d(-gap - width, style.size)}) {
    const Eigen::Vector2d start = at + corner;
    const Label box{start.x(), start.y() - 0.8 * style.size, start.x() + width, start.y() + 0.2 * style.size};
    if (std::any_of(taken.begin(), taken.end(), [&](const Label& other) { return box.overlaps(other); }))
      continue;
    taken.push_back(box);
    canvas.text_on_picture(label, start, style);
    return;
  }
}

void draw_markers(const RayScene& scene, const Lens& lens, const std::vector<Marker>& markers,
                  Canvas& canvas) {
  const double radius = std::max(2.0, lens.height / 260.0);
  std::vector<std::pair<const Marker*, Eigen::Vector2d>> shown;
  std::vector<Label> taken;
  for (const Marker& marker : markers) {
    const Eigen::Vector3f point = in_scene(scene, marker.position);
    if (!visible(scene, lens, point)) continue;
    const Eigen::Vector2d at = lens.project(point).head<2>().cast<double>();
    shown.emplace_back(&marker, at);
    taken.push_back({at.x() - radius, at.y() - radius, at.x() + radius, at.y() + radius});
    canvas.dot(at, radius, marker.color);
  }
  for (const auto& [marker, at] : shown)
    if (!marker->label.empty()) draw_label(marker->label, at, radius, taken, canvas);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void draw_legend(const VertexMap& map, const Picture& picture, Canvas& canvas) {
  const double text = std::clamp(picture.height / 40.0, 8.0, 16.0);
  const double width = picture.width * 0.5, height = text * 0.8;
  const double left = text, top = picture.height - 2.6 * text;
  const int steps = std::max(2, static_cast<int>(width));
  for (int k = 0; k < steps; ++k)
    canvas.fill(left + width * k / steps, top, width / steps + 0.6, height,
                map_color(map.colors, static_cast<double>(k) / (steps - 1)));
  canvas.outline(left, top, width, height, {0.4f, 0.4f, 0.4f});
  const TextStyle style{.size = text * 0.9, .align = Align::centre};
  for (int k = 0; k <= 2; ++k) {
    TextStyle at = style;
    at.align = k == 0 ? Align::left : k == 1 ? Align::centre : Align::right;
    canvas.text_on_picture(number(map.low + (map.high - map.low) * k / 2),
                           {left + width * k / 2, top + height + text}, at);
  }
  if (!map.title.empty()) canvas.text_on_picture(map.title, {left, top - 0.4 * text}, {.size = text * 0.95});
}

}  // namespace

void draw_overlay(const RayScene& scene, const Lens& lens, const RenderOptions& options, Picture& picture) {
  const bool legend = options.map && options.map->legend;
  if (options.markers.empty() && options.polylines.empty() && !legend) return;
  Canvas canvas(picture);
  for (const Polyline& line : options.polylines) draw_line(scene, lens, line, canvas);
  draw_markers(scene, lens, options.markers, canvas);
  if (legend) draw_legend(*options.map, picture, canvas);
  canvas.finish();
}

}  // namespace mien::detail
