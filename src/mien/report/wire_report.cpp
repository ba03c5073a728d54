#include "mien/report/wire_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mien/character/landmark_points.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/extract/edit_wires.h"
#include "mien/report/detail/html.h"
#include "mien/report/detail/portrait.h"

namespace mien {
namespace {

constexpr int picture_side = 300;
constexpr double map_top = 1;  ///< per cent of the box at the dark end of the error maps

const Color feature_colors[] = {{0.12f, 0.42f, 0.75f}, {0.85f, 0.25f, 0.1f}, {0.1f, 0.55f, 0.25f},
                                {0.55f, 0.2f, 0.65f},  {0.8f, 0.55f, 0.05f}, {0.1f, 0.55f, 0.6f},
                                {0.75f, 0.2f, 0.45f}};

std::vector<Polyline> polylines(const Character& character) {
  const std::vector<std::string> features = wire_features(character);
  const auto lines = wire_lines(character);
  std::vector<Polyline> result;
  for (std::size_t w = 0; w < lines.size(); ++w) {
    const auto feature = static_cast<std::size_t>(
        std::find(features.begin(), features.end(), character.wires[w].feature) - features.begin());
    result.push_back({lines[w], feature_colors[feature % std::size(feature_colors)]});
  }
  return result;
}

std::string per_cent(double part, double whole, int digits = 1) {
  return whole > 0 ? fmt::format("{:.{}f} %", 100 * part / whole, digits) : "-";
}

std::vector<Points> posed(const Character& character) {
  return evaluate(character, rest_pose(character));
}

/// The vertices that a wire moves by a fifth or more of what it does.
std::vector<SurfacePoint> held_by(const Wire& wire) {
  std::vector<SurfacePoint> points;
  for (const WireBinding& binding : wire.bindings)
    for (std::size_t i = 0; i < binding.vertices.size(); ++i)
      if (binding.falloff[i] > 0.2f) {
        points.emplace_back().part = binding.part;
        points.back().vertex = binding.vertices[i];
      }
  return points;
}

class Page {
 public:
  explicit Page(const WireReportInput& input)
      : input_(input),
        rest_(posed(input.original)),
        portrait_(input.original, marks(), Eigen::Matrix3d::Identity()) {}

  std::string text() {
    return detail::document("Wires of " + input_.name, "<h1>Wires of " + detail::escaped(input_.name) +
                                                           "</h1>" + overview() + wires() + features() +
                                                           shapes());
  }

 private:
  /// What counts as the face.
  std::vector<LandmarkPoint> marks() const {
    std::vector<LandmarkPoint> marks;
    for (const Wire& wire : input_.result.character.wires)
      for (const SurfacePoint& at : held_by(wire)) {
        const auto part = static_cast<std::size_t>(at.part);
        const Mesh& mesh = input_.original.parts[part].mesh;
        marks.push_back({wire.name, position_of(mesh, rest_[part], at), at});
      }
    return marks;
  }

  std::string overview() const {
    const ExtractResult& r = input_.result;
    const WireCompression compression = wire_compression(input_.original, r);
    double kept = 0, control = 0;
    for (const WireFit& fit : r.shapes) {
      for (const PartDelta& delta : fit.residual) kept += static_cast<double>(delta.vertices.size());
      for (const WireMove& move : fit.moves)
        control = std::max(control, move.controls.rowwise().norm().maxCoeff());
    }
    const double shapes = std::max<double>(1, static_cast<double>(r.shapes.size()));
    return detail::table(
        {"what", "how much"},
        {{"wires, shapes", fmt::format("{}, {}", r.character.wires.size(), r.shapes.size())},
         {"the wires leave of the displacements that can be seen",
          per_cent(r.seen_error, r.seen_displacement)},
         {"largest error there, of the face's box", per_cent(r.seen_largest, r.box, 2)},
         {"the wires leave of all displacements", per_cent(r.error, r.displacement)},
         {"with the residuals that are kept", per_cent(r.kept_error, r.displacement)},
         {"largest error of the wires, of the face's box", per_cent(r.largest, r.box, 2)},
         {"vertices with a residual, a shape",
          per_cent(kept / shapes, static_cast<double>(r.skin_vertices), 2)},
         {"furthest control point, of the face's box", per_cent(control, r.box)},
         {"smaller than dense shapes; sparse shapes",
          fmt::format("{:.0f} : 1; {:.0f} : 1", compression.dense, compression.sparse)},
         {"with the residuals",
          fmt::format("{:.1f} : 1; {:.1f} : 1", compression.dense_kept, compression.sparse_kept)},
         {"seconds: ranges; system; shapes",
          fmt::format("{:.1f}; {:.3f}; {:.3f}", input_.range_seconds, r.setup_seconds, r.solve_seconds)}});
  }

  std::string wires() const {
    RenderOptions options = detail::sized(560, 560);
    options.polylines = polylines(input_.result.character);
    std::string markup = "<h2>The wires</h2><div class=\"three\">";
    RenderOptions whole = options;  // curves lie a little under the skin where it bulges
    for (Polyline& line : whole.polylines) line.hidden = true;
    markup += detail::figure(portrait_.face(portrait_.rest(), whole), "the wires on the neutral",
                             "reference curves");
    for (const View view : {View::three_quarter, View::left})
      markup += detail::figure(portrait_.head(portrait_.rest(), view, options), "the wires from the side",
                               std::string(name_of(view)));
    return markup + "</div>";
  }

  std::string features() const {
    std::vector<std::vector<std::string>> rows;
    for (const FeatureError& feature : input_.result.features)
      rows.push_back(
          {feature.feature.empty() ? "out of reach" : detail::escaped(feature.feature),
           per_cent(feature.error, feature.displacement),
           per_cent(feature.error * feature.error, input_.result.seen_error * input_.result.seen_error)});
    return "<h2>By feature, where it can be seen</h2>" +
           detail::table({"feature", "error, of its displacement", "share of the whole error"}, rows);
  }

  std::string shapes() const {
    std::string markup =
        "<h2>Shapes: original, by the wires alone, error (dark: 1 % of the box); numbers where it can be "
        "seen</h2>";
    for (std::size_t s = 0; s < input_.result.shapes.size(); ++s) {
      report_progress(input_.progress, "report",
                      static_cast<double>(s) / static_cast<double>(input_.result.shapes.size()));
      markup += shape(static_cast<int>(s));
    }
    return markup;
  }

  std::string shape(int s) const {
    const WireFit& fit = input_.result.shapes[s];
    Pose pose = rest_pose(input_.original);
    pose.shape_weights.values.setZero();
    pose.shape_weights.values[s] = 1;
    const std::vector<Points> wanted = evaluate(input_.original, pose),
                              rebuilt = posed(rebuilt_neutral(input_.original, input_.result, s));
    const RenderOptions plain = detail::sized(picture_side, picture_side);
    RenderOptions mapped = plain;
    mapped.map.emplace();
    mapped.map->high = map_top;
    mapped.map->legend = false;
    for (std::size_t p = 0; p < wanted.size(); ++p)
      mapped.map->values.push_back((wanted[p] - rebuilt[p]).rowwise().norm() *
                                   static_cast<float>(100 / std::max(input_.result.box, 1e-300)));
    const std::string name = detail::escaped(fit.shape);
    return "<div class=\"three\">" +
           detail::figure(portrait_.face(wanted, plain), fit.shape, "<b>" + name + "</b>") +
           detail::figure(portrait_.face(rebuilt, plain), fit.shape + " by its wires",
                          "by its wires: " + per_cent(fit.seen_error, fit.seen_displacement) + " off") +
           detail::figure(portrait_.face(rebuilt, mapped), fit.shape + ": error",
                          "largest: " + per_cent(fit.seen_largest, input_.result.box, 2) + " of the box") +
           "</div>";
  }

  const WireReportInput& input_;
  std::vector<Points> rest_;  // per part
  detail::Portrait portrait_;
};

}  // namespace

std::vector<std::vector<Eigen::Vector3d>> wire_lines(const Character& character) {
  constexpr int samples = 48;
  std::vector<std::vector<Eigen::Vector3d>> lines;
  for (const Wire& wire : character.wires) {
    lines.emplace_back();
    for (int i = 0; i <= samples; ++i)
      lines.back().push_back(
          point_at(wire.curve, wire.curve.low() + (wire.curve.high() - wire.curve.low()) * i / samples));
  }
  return lines;
}

Character rebuilt_neutral(const Character& original, const ExtractResult& result, int shape) {
  const WireFit& fit = result.shapes.at(static_cast<std::size_t>(shape));
  Character rebuilt = original;
  for (std::size_t p = 0; p < rebuilt.parts.size(); ++p) {
    Points& positions = rebuilt.parts[p].mesh.positions;
    for (const PartDelta& delta : original.shapes[shape].parts)
      if (delta.part == static_cast<int>(p))
        for (std::size_t i = 0; i < delta.vertices.size(); ++i)
          if (!result.is_skin(delta.part, delta.vertices[i]))
            positions.row(delta.vertices[i]) += delta.deltas.row(static_cast<Eigen::Index>(i));
    for (const PartDelta& delta : fit.rebuilt)
      if (delta.part == static_cast<int>(p))
        for (std::size_t i = 0; i < delta.vertices.size(); ++i)
          positions.row(delta.vertices[i]) += delta.deltas.row(static_cast<Eigen::Index>(i));
    rebuilt.parts[p].mesh.normals.resize(0, 3);
    rebuilt.parts[p].mesh.tangents.resize(0, 4);
  }
  return rebuilt;
}

WireCompression wire_compression(const Character& original, const ExtractResult& result) {
  double wires = 0, sparse = 0, kept = 0;
  for (const WireFit& fit : result.shapes) {
    for (const WireMove& move : fit.moves)
      wires += static_cast<double>(move.controls.size() + move.turns.size() + 1);
    for (const PartDelta& delta : fit.residual) kept += 4 * static_cast<double>(delta.vertices.size());
  }
  for (const Shape& shape : original.shapes)
    for (const PartDelta& delta : shape.parts)
      for (const int v : delta.vertices) sparse += result.is_skin(delta.part, v) ? 4 : 0;
  const double dense =
      3.0 * static_cast<double>(result.skin_vertices) * static_cast<double>(result.shapes.size());
  if (!(wires > 0)) return {};
  return {dense / wires, sparse / wires, dense / (wires + kept), sparse / (wires + kept)};
}

std::string make_wire_report(const WireReportInput& input) {
  if (input.original.shapes.size() != input.result.shapes.size())
    throw invalid_input("report", "is about another character", "the one that was extracted");
  return Page(input).text();
}

}  // namespace mien
