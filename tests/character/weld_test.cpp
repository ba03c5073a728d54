#include "mien/character/weld.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mien/core/error.h"

namespace mien {
namespace {

void add_vertex(Mesh& mesh, float x, float y, float z) {
  mesh.positions.conservativeResize(mesh.positions.rows() + 1, 3);
  mesh.positions.row(mesh.positions.rows() - 1) << x, y, z;
}

/// A unit cube at (x, 0, 0) whose six faces have four vertices of their own, as a UV atlas splits them.
void add_split_cube(Mesh& mesh, float x) {
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& quad : quads) {
    const int first = static_cast<int>(mesh.positions.rows());
    for (const int c : quad) add_vertex(mesh, x + (c & 1), (c >> 1) & 1, (c >> 2) & 1);
    mesh.faces.push_back({first, first + 1, first + 2, first + 3});
  }
}

/// A sphere as a grid of columns with its first column repeated and one pole vertex a column.
Mesh split_sphere(int rows, int columns) {
  Mesh mesh;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const double polar = M_PI * r / rows, around = 2 * M_PI * (c % columns) / columns;
      const bool pole = r == 0 || r == rows;
      add_vertex(mesh, pole ? 0 : std::sin(polar) * std::cos(around), std::cos(polar),
                 pole ? 0 : std::sin(polar) * std::sin(around));
    }
  const int width = columns + 1;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int a = r * width + c, b = a + 1, below_a = a + width, below_b = b + width;
      if (r > 0) mesh.faces.push_back({a, b, below_b});
      if (r < rows - 1) mesh.faces.push_back({a, below_b, below_a});
    }
  return mesh;
}

int open_edge_count(const Faces& faces) {
  std::map<std::pair<int, int>, int> edges;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t c = 0; c < faces[f].size(); ++c)
      ++edges[{faces[f][c], faces[f][(c + 1) % faces[f].size()]}];
  int open = 0;
  for (const auto& [edge, count] : edges) open += !edges.contains({edge.second, edge.first});
  return open;
}

TEST(weld_seams, names_a_corner_out_of_range) {
  Mesh mesh;
  add_vertex(mesh, 0, 0, 0);
  mesh.faces.push_back({0, 0, 7});
  try {
    weld_seams(mesh);
    FAIL() << "should have thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "face: names vertex 7; there are 1 vertices");
  }
}

TEST(weld_seams, an_empty_mesh_has_no_vertices) {
  EXPECT_EQ(weld_seams(Mesh{}).size(), 0u);
}

TEST(weld_seams, a_split_cube_becomes_closed) {
  Mesh mesh;
  add_split_cube(mesh, 0);
  const Weld weld = weld_seams(mesh);
  EXPECT_EQ(weld.size(), 8u);
  EXPECT_EQ(open_edge_count(weld_faces(mesh.faces, weld)), 0);
}

TEST(weld_seams, a_split_sphere_becomes_closed) {
  const Mesh mesh = split_sphere(8, 12);
  const Weld weld = weld_seams(mesh);
  EXPECT_EQ(weld.size(), 7u * 12 + 2 + 2);  // one pole copy at each end has no face and stays itself
  EXPECT_EQ(open_edge_count(weld_faces(mesh.faces, weld)), 0);
}

TEST(weld_seams, numbers_ascend_by_first_appearance) {
  Mesh mesh;
  add_split_cube(mesh, 0);
  const Weld weld = weld_seams(mesh);
  int seen = 0;
  for (std::size_t v = 0; v < weld.of.size(); ++v) {
    EXPECT_LE(weld.of[v], seen);
    EXPECT_EQ(mesh.positions.row(v), mesh.positions.row(weld.representative[weld.of[v]]));
    if (weld.of[v] == seen) {
      EXPECT_EQ(weld.representative[seen++], static_cast<int>(v));
    }
  }
}

TEST(weld_seams, two_closed_cubes_that_touch_stay_apart) {
  Mesh mesh;
  for (const float x : {0.f, 1.f}) {
    const int first = static_cast<int>(mesh.positions.rows());
    for (int c = 0; c < 8; ++c) add_vertex(mesh, x + (c & 1), (c >> 1) & 1, (c >> 2) & 1);
    const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : quads)
      mesh.faces.push_back({first + q[0], first + q[1], first + q[2], first + q[3]});
  }
  EXPECT_EQ(weld_seams(mesh).size(), 16u);
}

TEST(weld_seams, two_split_cubes_that_touch_are_never_joined) {
  Mesh mesh;
  add_split_cube(mesh, 0);
  add_split_cube(mesh, 1);
  const Weld weld = weld_seams(mesh);
  for (int a = 0; a < 24; ++a)
    for (int b = 24; b < 48; ++b) EXPECT_NE(weld.of[a], weld.of[b]);
}

/// A tube along x with a rim of two coincident lips: closed everywhere else, so that nothing is open.
TEST(weld_seams, touching_lips_of_a_closed_surface_stay) {
  Mesh mesh = split_sphere(8, 12);
  const Weld closed = weld_seams(mesh);
  Mesh face;
  for (const int v : closed.representative)
    add_vertex(face, mesh.positions(v, 0), mesh.positions(v, 1), mesh.positions(v, 2));
  face.faces = weld_faces(mesh.faces, closed);
  face.positions.row(20) = face.positions.row(40);  // two places of one surface meet
  face.positions.row(21) = face.positions.row(41);
  EXPECT_EQ(weld_seams(face).size(), face.vertex_count());
}

/// Two strips whose near edges coincide in the neutral: a seam, unless a shape opens it.
TEST(weld_seams, copies_that_a_shape_moves_apart_stay_apart) {
  Character character;
  Part part;
  for (const float y : {0.f, 1.f, 0.f, -1.f})
    for (const float x : {0.f, 1.f}) add_vertex(part.mesh, x, y, 0);
  part.mesh.faces.push_back({0, 1, 3, 2});
  part.mesh.faces.push_back({6, 7, 5, 4});
  character.parts.push_back(part);
  EXPECT_EQ(weld_seams(character, 0).size(), 6u);
  Shape open;
  open.name = "jawOpen";
  PartDelta delta;
  delta.vertices = {5};
  delta.deltas = Points::Constant(1, 3, -0.5f);
  open.parts.push_back(delta);
  character.shapes.push_back(open);
  EXPECT_EQ(weld_seams(character, 0).size(), 7u);
}

}  // namespace
}  // namespace mien
