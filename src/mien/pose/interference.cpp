#include "mien/pose/interference.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/point_evaluator.h"
#include "mien/pose/detail/gram.h"
#include "mien/pose/detail/pin_checks.h"

namespace mien {
namespace {

std::vector<SurfacePoint> all_vertices(const Character& character) {
  std::vector<SurfacePoint> vertices;
  for (std::size_t p = 0; p < character.parts.size(); ++p)
    for (std::size_t v = 0; v < character.parts[p].mesh.vertex_count(); ++v) {
      SurfacePoint point;
      point.part = static_cast<int>(p);
      point.vertex = static_cast<int>(v);
      vertices.push_back(point);
    }
  return vertices;
}

/// #V x #sliders: how far each slider's unit moves each vertex.
Eigen::MatrixXf motions(const Character& character, const Eigen::MatrixXd& slopes, std::size_t vertices) {
  std::vector<std::size_t> first(character.parts.size(), 0);
  for (std::size_t p = 1; p < first.size(); ++p)
    first[p] = first[p - 1] + character.parts[p - 1].mesh.vertex_count();
  Eigen::MatrixXf lengths(static_cast<Eigen::Index>(vertices), slopes.cols());
  parallel_for(static_cast<std::size_t>(slopes.cols()), 1, [&](std::size_t begin, std::size_t end) {
    PointsD sum;
    for (std::size_t s = begin; s < end; ++s) {
      sum.setZero(static_cast<Eigen::Index>(vertices), 3);
      for (std::size_t k = 0; k < character.shapes.size(); ++k) {
        const double slope = slopes(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(s));
        if (slope == 0) continue;
        for (const PartDelta& delta : character.shapes[k].parts)
          for (std::size_t i = 0; i < delta.vertices.size(); ++i)
            sum.row(static_cast<Eigen::Index>(first[delta.part]) + delta.vertices[i]) +=
                slope * delta.deltas.row(static_cast<Eigen::Index>(i)).cast<double>();
      }
      lengths.col(static_cast<Eigen::Index>(s)) = sum.rowwise().norm().cast<float>();
    }
  });
  return lengths;
}

/// a_ij / sqrt(diagonal_i diagonal_j), 0 where a slider moves nothing.
Eigen::MatrixXd normalised(const Eigen::MatrixXd& a, const Eigen::VectorXd& diagonal) {
  Eigen::MatrixXd b = a;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      const double size = std::sqrt(diagonal[i] * diagonal[j]);
      b(i, j) = size > 0 ? a(i, j) / size : 0;
    }
  return b;
}

void check_rule(const Character& character, const RegionRule& rule) {
  const std::string place = "rule " + rule.name;
  if (rule.region.empty()) throw invalid_input(place, "has no region", "one or more points");
  for (const SurfacePoint& point : rule.region) detail::check_surface_point(character, point, place);
  for (const int slider : rule.sliders)
    if (slider < 0 || slider >= static_cast<int>(character.sliders.size()))
      throw invalid_input(place, "names slider " + std::to_string(slider), "one that the character has");
  if (!(rule.at_most >= 0)) throw invalid_input(place, "has a bound that is negative", "0 or more");
}

/// Keeps the worst break of each kind.
struct Worst {
  std::map<int, RuleBreak> by_slider;
  void add(const RuleBreak& found) {
    const auto [at, is_new] = by_slider.try_emplace(found.slider, found);
    if (!is_new && found.by > at->second.by) at->second = found;
  }
};

void check_frame(const Character& character, const RegionRule& rule, PointEvaluator& points,
                 const RigPose& pose, RuleBreak found, double smallest, Worst& worst) {
  PointsD rest, here, without;
  points.positions(rest_pose(character), rest);
  points.positions(pose_of(character, pose), here);
  for (found.point = 0; found.point < here.rows(); ++found.point) {
    found.by = (here.row(found.point) - rest.row(found.point)).norm();
    if (found.by > rule.at_most + smallest) worst.add(found);
  }
  for (int s = 0; s < static_cast<int>(character.sliders.size()); ++s) {
    const bool may = std::find(rule.sliders.begin(), rule.sliders.end(), s) != rule.sliders.end();
    if (may || pose.sliders.values[s] == character.sliders[s].rest) continue;
    RigPose other = pose;
    other.sliders.values[s] = character.sliders[s].rest;
    points.positions(pose_of(character, other), without);
    found.slider = s;
    for (found.point = 0; found.point < here.rows(); ++found.point) {
      found.by = (here.row(found.point) - without.row(found.point)).norm();
      if (found.by > smallest) worst.add(found);
    }
  }
}

}  // namespace

Interference interference(const Character& character, double least) {
  if (character.sliders.empty())
    throw invalid_input("character", "has no sliders", "shapes, each with its slider");
  const std::vector<SurfacePoint> vertices = all_vertices(character);
  const SliderValues rest = rest_sliders(character);
  const Eigen::MatrixXd slopes = shape_weight_slopes(character, rest);
  const Eigen::MatrixXf lengths = motions(character, slopes, vertices.size());
  const Eigen::MatrixXd together = (lengths.transpose() * lengths).cast<double>();
  const Eigen::MatrixXd products =
      slopes.transpose() * detail::shape_products(character, rest_pose(character)) * slopes;
  Interference result{
      normalised(together, together.diagonal()), normalised(products, products.diagonal()), {}};
  for (int a = 0; a < together.rows(); ++a)
    for (int b = a + 1; b < together.rows(); ++b)
      if (result.overlap(a, b) > least) {
        Eigen::Index most = 0;
        lengths.col(a).cwiseProduct(lengths.col(b)).maxCoeff(&most);
        result.pairs.push_back(
            {a, b, result.overlap(a, b), result.alignment(a, b), vertices[static_cast<std::size_t>(most)]});
      }
  std::stable_sort(result.pairs.begin(), result.pairs.end(),
                   [](const InterferingPair& x, const InterferingPair& y) { return x.overlap > y.overlap; });
  return result;
}

std::vector<RuleBreak> check_region_rules(const Character& character, const Clip& clip,
                                          const std::vector<RegionRule>& rules, double fps) {
  if (!(fps > 0) || !std::isfinite(fps)) throw invalid_input("frames a second", "are not above 0", "30, say");
  double size = 0;
  for (const Part& part : character.parts)
    size = std::max(size, bounding_box(part.mesh.positions).diagonal());
  std::vector<RuleBreak> breaks;
  const int frames = static_cast<int>(std::floor(clip.duration() * fps + 1e-6));
  for (std::size_t r = 0; r < rules.size(); ++r) {
    check_rule(character, rules[r]);
    PointEvaluator points(character, rules[r].region);
    Worst worst;
    for (int f = 0; f <= frames; ++f) {
      RuleBreak found;
      found.rule = static_cast<int>(r);
      found.seconds = f / fps;
      check_frame(character, rules[r], points, sample_rig(character, clip, f / fps), found, 1e-4 * size,
                  worst);
    }
    for (const auto& [slider, found] : worst.by_slider) breaks.push_back(found);
  }
  return breaks;
}

}  // namespace mien
