#pragma once
/// A polygon mesh as its file has it: vertices in file order, n-gons kept as n-gons, UVs with their seams.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace mien {

/// #V x 3, one row a vertex, in the file's own unit. Stored as float, as files have it; solvers work in
/// double.
using Points = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// #V x 2.
using Points2 = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
/// #V x 4.
using Points4 = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;
/// #V x 3 in double: what solvers take and give.
using PointsD = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// #T x 3 vertex numbers, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Polygons of any size, one after the other. `faces[f]` is the span of face f's corner vertices,
/// counter-clockwise seen from outside.
class Faces {
 public:
  std::size_t size() const { return offsets_.size() - 1; }
  bool empty() const { return size() == 0; }
  std::span<const int> operator[](std::size_t f) const {
    return {corners_.data() + offsets_[f], corners_.data() + offsets_[f + 1]};
  }
  /// Number of the first corner of face f among all corners; `offset(size())` is the number of corners.
  int offset(std::size_t f) const { return offsets_[f]; }
  std::size_t corner_count() const { return corners_.size(); }
  const std::vector<int>& corners() const { return corners_; }
  std::vector<int>& corners() { return corners_; }
  void push_back(std::span<const int> face);
  void push_back(std::initializer_list<int> face) {
    push_back(std::span<const int>(face.begin(), face.size()));
  }
  void reserve(std::size_t faces, std::size_t corners);
  bool operator==(const Faces&) const = default;

 private:
  std::vector<int> offsets_{0};
  std::vector<int> corners_;
};

/// One UV set. Without `corners` there is one coordinate a vertex (as in glTF, where a seam splits the
/// vertex). With `corners`, `corners[c]` is the row of `coordinates` that face corner c uses (as in OBJ: a
/// vertex on a seam has several); -1 marks a corner without a UV. v points up (0 at the image's lower edge),
/// as in OBJ; readers of glTF flip it and writers flip it back.
struct UvSet {
  Points2 coordinates;
  std::vector<int> corners;
  /// Matrices of different sizes differ; Eigen alone compares none but equal sizes.
  bool operator==(const UvSet& other) const {
    return corners == other.corners && coordinates.rows() == other.coordinates.rows() &&
           coordinates == other.coordinates;
  }
};

/// A run of faces with one name and one material: an OBJ group, a glTF primitive.
struct FaceGroup {
  std::string name;
  int material = -1;                     ///< index into Appearance::materials; -1: none
  int face_begin = 0, face_end = 0;      ///< [begin, end)
  int vertex_begin = 0, vertex_end = 0;  ///< the vertex range that the faces index (groups may share one)
  bool operator==(const FaceGroup&) const = default;
};

/// A per-vertex attribute that mien only carries: glTF's `_NAME`.
struct VertexAttribute {
  std::string name;           ///< with its underscore
  int width = 1;              ///< numbers a vertex: 1 to 4 (SCALAR, VEC2 ...), 9 or 16 are not glTF's
  int component_type = 5126;  ///< glTF's number of the stored type
  bool normalized = false;    ///< whole numbers that stand for [0, 1] or [-1, 1]
  std::vector<float> values;  ///< #V x width, as stored (whole numbers unscaled)
  bool operator==(const VertexAttribute&) const = default;
};

/// Points or line segments beside the faces, which mien only carries.
struct LooseElements {
  bool lines = false;  ///< pairs of vertices; false: points
  int material = -1;   ///< index into Appearance::materials; -1: none
  std::vector<int> vertices;
  bool operator==(const LooseElements&) const = default;
};

struct Mesh {
  Points positions;  ///< #V
  Faces faces;
  Points normals;                 ///< #V, unit length, or no rows
  Points4 tangents;               ///< #V, xyz unit and w = +-1 (glTF's meaning), or no rows
  std::vector<UvSet> uvs;         ///< UV sets, in order
  std::vector<Points4> colors;    ///< per vertex RGBA in [0, 1], or none
  std::vector<FaceGroup> groups;  ///< in face order, covering all faces; empty: one nameless group
  std::vector<VertexAttribute> attributes;
  std::vector<LooseElements> loose;

  std::size_t vertex_count() const { return static_cast<std::size_t>(positions.rows()); }
};

/// Each n-gon as the fan from its first corner: (0,1,2), (0,2,3), ... n - 2 triangles a face, in face order.
Triangles triangulate(const Faces& faces);

/// The face that each row of `triangulate(faces)` came from.
std::vector<int> face_of_triangle(const Faces& faces);

/// Area-weighted vertex normals, unit length; (0, 0, 0) at a vertex with no face of positive area.
Points vertex_normals(const Points& positions, const Triangles& triangles);

/// Axis-aligned box around points.
struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  double diagonal() const { return (high - low).norm(); }
  Eigen::Vector3d centre() const { return (low + high) / 2; }
};
/// The box of no points is a point at the origin.
Box bounding_box(const Points& positions);
Box bounding_box(const PointsD& positions);

}  // namespace mien
