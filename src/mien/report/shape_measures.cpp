#include "mien/report/shape_measures.h"

#include <algorithm>
#include <cmath>

#include "mien/core/error.h"

namespace mien {
namespace {

Eigen::RowVector3d normal_of(const Points& positions, const Triangles& triangles, Eigen::Index t) {
  const Eigen::RowVector3d a = positions.row(triangles(t, 0)).cast<double>();
  const Eigen::RowVector3d b = positions.row(triangles(t, 1)).cast<double>();
  const Eigen::RowVector3d c = positions.row(triangles(t, 2)).cast<double>();
  return (b - a).cross(c - a);
}

double length_of(const Points& positions, const std::pair<int, int>& edge) {
  return (positions.row(edge.first) - positions.row(edge.second)).cast<double>().norm();
}

std::vector<std::pair<int, int>> edges_of(const Triangles& triangles) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(static_cast<std::size_t>(3 * triangles.rows()));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(t, k), b = triangles(t, (k + 1) % 3);
      edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

ShapeMeasure::ShapeMeasure(const Character& character, const std::vector<Points>& rest, double unit)
    : least_(1e-3 * unit) {
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    PartMeasure part;
    part.triangles = triangulate(character.parts[p].mesh.faces);
    part.normals.resize(part.triangles.rows(), 3);
    for (Eigen::Index t = 0; t < part.triangles.rows(); ++t)
      part.normals.row(t) = normal_of(rest[p], part.triangles, t);
    part.edges = edges_of(part.triangles);
    for (const auto& edge : part.edges) part.lengths.push_back(std::max(length_of(rest[p], edge), least_));
    parts_.push_back(std::move(part));
  }
}

void ShapeMeasure::count_folds(const std::vector<Points>& posed, std::vector<Eigen::VectorXf>& counts) const {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const PartMeasure& part = parts_[p];
    std::vector<char> folded(static_cast<std::size_t>(posed[p].rows()), 0);
    for (Eigen::Index t = 0; t < part.triangles.rows(); ++t)
      if (normal_of(posed[p], part.triangles, t).dot(part.normals.row(t)) < 0)
        for (int k = 0; k < 3; ++k) folded[static_cast<std::size_t>(part.triangles(t, k))] = 1;
    for (std::size_t v = 0; v < folded.size(); ++v) counts[p][static_cast<Eigen::Index>(v)] += folded[v];
  }
}

double ShapeMeasure::worst_stretch(const std::vector<Points>& posed) const {
  double worst = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for (std::size_t e = 0; e < parts_[p].edges.size(); ++e)
      worst =
          std::max(worst, std::max(length_of(posed[p], parts_[p].edges[e]), least_) / parts_[p].lengths[e]);
  return worst;
}

std::vector<char> ShapeMeasure::torn_edges(const std::vector<Points>& posed,
                                           const std::vector<Points>& reference) const {
  std::vector<char> torn;
  torn.reserve(edge_count());
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for (const auto& edge : parts_[p].edges)
      torn.push_back(length_of(posed[p], edge) > 2 * std::max(length_of(reference[p], edge), least_));
  return torn;
}

std::size_t ShapeMeasure::edge_count() const {
  std::size_t count = 0;
  for (const PartMeasure& part : parts_) count += part.edges.size();
  return count;
}

Displacement displacement(const std::vector<Points>& posed, const std::vector<Points>& rest) {
  if (posed.size() != rest.size())
    throw invalid_input("displacement", "is asked between other parts", "the same parts");
  double squared = 0, largest = 0;
  Eigen::Index count = 0;
  for (std::size_t p = 0; p < posed.size(); ++p) {
    if (posed[p].rows() != rest[p].rows())
      throw invalid_input("displacement of part " + std::to_string(p), "is asked between other vertices",
                          "the same vertices");
    for (Eigen::Index v = 0; v < posed[p].rows(); ++v) {
      const double s = (posed[p].row(v) - rest[p].row(v)).cast<double>().squaredNorm();
      squared += s;
      largest = std::max(largest, s);
    }
    count += posed[p].rows();
  }
  return {count ? std::sqrt(squared / static_cast<double>(count)) : 0, std::sqrt(largest)};
}

}  // namespace mien
