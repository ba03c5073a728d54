#include "mien/geometry/mesh.h"

#include <Eigen/Geometry>

namespace mien {

void Faces::push_back(std::span<const int> face) {
  corners_.insert(corners_.end(), face.begin(), face.end());
  offsets_.push_back(static_cast<int>(corners_.size()));
}

void Faces::reserve(std::size_t faces, std::size_t corners) {
  offsets_.reserve(faces + 1);
  corners_.reserve(corners);
}

Triangles triangulate(const Faces& faces) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) count += faces[f].size() >= 3 ? faces[f].size() - 2 : 0;
  Triangles triangles(count, 3);
  Eigen::Index t = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces[f];
    for (std::size_t c = 2; c < face.size(); ++c) triangles.row(t++) << face[0], face[c - 1], face[c];
  }
  return triangles;
}

std::vector<int> face_of_triangle(const Faces& faces) {
  std::vector<int> of;
  of.reserve(faces.corner_count());
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t c = 2; c < faces[f].size(); ++c) of.push_back(static_cast<int>(f));
  return of;
}

Points vertex_normals(const Points& positions, const Triangles& triangles) {
  PointsD sum = PointsD::Zero(positions.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = positions.row(triangles(t, 0)).cast<double>();
    const Eigen::Vector3d b = positions.row(triangles(t, 1)).cast<double>();
    const Eigen::Vector3d c = positions.row(triangles(t, 2)).cast<double>();
    const Eigen::Vector3d twice_area = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) sum.row(triangles(t, k)) += twice_area;
  }
  Points normals = Points::Zero(positions.rows(), 3);
  for (Eigen::Index v = 0; v < sum.rows(); ++v) {
    const double length = sum.row(v).norm();
    if (length > 0) normals.row(v) = (sum.row(v) / length).cast<float>();
  }
  return normals;
}

namespace {

template <class Positions>
Box box_around(const Positions& positions) {
  Box box;
  if (positions.rows() == 0) return box;
  box.low = positions.colwise().minCoeff().transpose().template cast<double>();
  box.high = positions.colwise().maxCoeff().transpose().template cast<double>();
  return box;
}

}  // namespace

Box bounding_box(const Points& positions) {
  return box_around(positions);
}
Box bounding_box(const PointsD& positions) {
  return box_around(positions);
}

}  // namespace mien
