#include "mien/extract/draw_wires.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "mien/character/landmark_points.h"
#include "mien/core/error.h"
#include "mien/deform/bind_wires.h"
#include "mien/extract/detail/draw_wire.h"
#include "mien/geometry/bspline.h"

namespace mien {
namespace {

/// Ways along edges zigzag by half an edge; a few rounds of averaging between the picked points take that out.
constexpr int smoothing_rounds = 5;
constexpr int fit_samples = 64;

PointsD smooth_way(const PointsD& way, const std::vector<char>& picked) {
  PointsD smooth = way;
  for (int round = 0; round < smoothing_rounds; ++round) {
    const PointsD before = smooth;
    for (Eigen::Index i = 1; i + 1 < way.rows(); ++i)
      if (!picked[i])
        smooth.row(i) = 0.25 * before.row(i - 1) + 0.5 * before.row(i) + 0.25 * before.row(i + 1);
  }
  return smooth;
}

double length_of(const PointsD& points) {
  double length = 0;
  for (Eigen::Index i = 1; i < points.rows(); ++i) length += (points.row(i) - points.row(i - 1)).norm();
  return length;
}

/// The way through all points, in stretches so that the picked points keep their place.
PointsD way_through(const WireBinder& binder, const WireSketch& sketch) {
  std::vector<PointsD> stretches;
  std::vector<char> picked{1};
  Eigen::Index rows = 1;
  for (std::size_t i = 0; i + 1 < sketch.points.size(); ++i) {
    stretches.push_back(binder.trace(sketch.name, std::span(sketch.points).subspan(i, 2)));
    for (Eigen::Index row = 1; row < stretches.back().rows(); ++row)
      picked.push_back(row + 1 == stretches.back().rows());
    rows += stretches.back().rows() - 1;
  }
  PointsD way(rows, 3);
  way.row(0) = stretches.front().row(0);
  Eigen::Index row = 1;
  for (const PointsD& stretch : stretches) {
    way.middleRows(row, stretch.rows() - 1) = stretch.bottomRows(stretch.rows() - 1);
    row += stretch.rows() - 1;
  }
  return smooth_way(way, picked);
}

}  // namespace

Wire detail::draw_curve(const WireBinder& binder, const WireSketch& sketch) {
  const std::string place = "wire " + sketch.name;
  if (sketch.points.size() < 4)
    throw invalid_input(place, "has " + std::to_string(sketch.points.size()) + " points",
                        "a cubic needs four or more");
  if (sketch.controls < 4 || sketch.controls > 1000)
    throw invalid_input(place, "has " + std::to_string(sketch.controls) + " control points",
                        "a cubic needs four or more, at most 1000");
  if (!(sketch.range >= 0) || !std::isfinite(sketch.range))
    throw invalid_input(place, "has range " + std::to_string(sketch.range), "a finite length above 0");
  const PointsD way = way_through(binder, sketch);
  if (way.rows() < 2 || !(length_of(way) > 0))
    throw invalid_input(place, "has no length", "points that differ");
  SplineFitOptions options;
  options.controls = sketch.controls;
  Wire wire;
  wire.name = sketch.name;
  wire.feature = sketch.feature.empty() ? sketch.name : sketch.feature;
  wire.curve = fit_bspline(sample_through(way, fit_samples), options);
  wire.points = sketch.points;
  wire.ranges = {sketch.range > 0 ? sketch.range : length_of(way)};
  wire.turn_controls = sketch.turn_controls;
  wire.geodesic = sketch.geodesic;
  return wire;
}

Wire detail::draw_wire(const WireBinder& binder, const WireSketch& sketch) {
  Wire wire = draw_curve(binder, sketch);
  wire.bindings = binder.bind(wire);
  return wire;
}

namespace {

struct Preset {
  const char *name, *feature;
  std::vector<int> landmarks;
  /// Towards these landmarks, by `share` of the way along the surface; none: the landmarks themselves.
  std::vector<int> towards = {};
  double share = 0;
};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"brow_R", "brows", {18, 19, 20, 21, 22}},
      {"brow_L", "brows", {27, 26, 25, 24, 23}},
      {"lidUpper_R", "eyes", {37, 38, 39, 40}},
      {"lidUpper_L", "eyes", {46, 45, 44, 43}},
      {"lidLower_R", "eyes", {37, 42, 41, 40}},
      {"lidLower_L", "eyes", {46, 47, 48, 43}},
      {"noseBridge", "nose", {28, 29, 30, 31}},
      {"noseBase", "nose", {32, 33, 34, 35, 36}},
      {"lipUpperOuter", "mouth", {49, 50, 51, 52, 53, 54, 55}},
      {"lipLowerOuter", "mouth", {49, 60, 59, 58, 57, 56, 55}},
      {"lipUpperInner", "mouth", {61, 62, 63, 64, 65}},
      {"lipLowerInner", "mouth", {61, 68, 67, 66, 65}},
      {"jaw_R", "jaw", {1, 2, 3, 4, 5, 6, 7}},
      {"jaw_L", "jaw", {17, 16, 15, 14, 13, 12, 11}},
      {"chin", "jaw", {7, 8, 9, 10, 11}},
      {"lidFold_R", "eyes", {37, 38, 39, 40}, {18, 19, 21, 22}, 0.4},
      {"lidFold_L", "eyes", {46, 45, 44, 43}, {27, 26, 24, 23}, 0.4},
      {"fold_R", "cheeks", {32, 49, 7}},
      {"fold_L", "cheeks", {36, 55, 11}},
      {"cheek_R", "cheeks", {2, 32}},
      {"cheek_L", "cheeks", {16, 36}},
      {"mentum", "jaw", {58, 9}},
  };
  return all;
}

const SurfacePoint& landmark(const Character& character, int number) {
  const std::string name = "ibug_" + std::to_string(number);
  const auto found = std::find_if(character.landmarks.begin(), character.landmarks.end(),
                                  [&](const Landmark& landmark) { return landmark.name == name; });
  if (found == character.landmarks.end())
    throw invalid_input("landmark " + name, "is missing", "the 68 iBUG landmarks, or curves of your own");
  return found->at;
}

/// Fewer landmarks than a cubic needs: vertices halfway along the surface come between them.
std::vector<SurfacePoint> filled(const WireBinder& binder, std::vector<SurfacePoint> points) {
  while (points.size() < 4) {
    std::vector<SurfacePoint> denser;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i > 0) denser.push_back(binder.between(points[i - 1], points[i], 0.5));
      denser.push_back(points[i]);
    }
    points = std::move(denser);
  }
  return points;
}

}  // namespace

std::vector<Wire> draw_wires(const Character& character, std::span<const WireSketch> sketches) {
  const WireBinder binder(character);
  std::vector<Wire> wires;
  std::set<std::string> names;
  for (const WireSketch& sketch : sketches) {
    if (!names.insert(sketch.name).second)
      throw invalid_input("wire " + sketch.name, "is there twice", "names of their own");
    wires.push_back(detail::draw_wire(binder, sketch));
  }
  return wires;
}

std::vector<WireSketch> face_wire_sketches(const Character& character, int count) {
  if (count != 15 && count != 22)
    throw invalid_input("wires", "are to number " + std::to_string(count), "15 or 22");
  const WireBinder binder(character);
  std::vector<WireSketch> sketches;
  for (int i = 0; i < count; ++i) {
    const Preset& preset = presets()[i];
    WireSketch sketch;
    sketch.name = preset.name;
    sketch.feature = preset.feature;
    for (const int number : preset.landmarks) sketch.points.push_back(landmark(character, number));
    for (std::size_t p = 0; p < preset.towards.size(); ++p)
      sketch.points[p] =
          binder.between(sketch.points[p], landmark(character, preset.towards[p]), preset.share);
    sketch.points = filled(binder, std::move(sketch.points));
    if (sketch.feature == "eyes")  // lids fold close by: half as far as others
      sketch.range = length_of(binder.trace(sketch.name, sketch.points)) / 2;
    sketches.push_back(std::move(sketch));
  }
  return sketches;
}

}  // namespace mien
