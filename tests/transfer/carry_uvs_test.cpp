#include "mien/transfer/carry_uvs.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace mien::test {
namespace {

/// An open cylinder of radius 1 and height 2 around y, quads, normals outward.
struct Cylinder {
  int around = 0, up = 0;
  PointsD positions;
  Faces faces;
  Cylinder(int around_count, int up_count) : around(around_count), up(up_count) {
    positions.resize(around * (up + 1), 3);
    for (int y = 0; y <= up; ++y)
      for (int a = 0; a < around; ++a) {
        const double angle = 2 * std::numbers::pi * a / around;
        positions.row(y * around + a) << std::sin(angle), 2.0 * y / up, std::cos(angle);
      }
    for (int y = 0; y < up; ++y)
      for (int a = 0; a < around; ++a) {
        const int b = (a + 1) % around;
        faces.push_back({y * around + a, y * around + b, (y + 1) * around + b, (y + 1) * around + a});
      }
  }
  /// u runs once around from 0 to 1, v up; the seam lies at angle 0.
  std::vector<std::array<Eigen::Vector2d, 3>> uvs() const {
    std::vector<std::array<Eigen::Vector2d, 3>> list;
    for (int y = 0; y < up; ++y)
      for (int a = 0; a < around; ++a) {
        const auto uv = [&](int da, int dy) {
          return Eigen::Vector2d((a + da) / double(around), (y + dy) / double(up));
        };
        list.push_back({uv(0, 0), uv(1, 0), uv(1, 1)});
        list.push_back({uv(0, 0), uv(1, 1), uv(0, 1)});
      }
    return list;
  }
};

/// The widest face in u.
double widest(const UvSet& set, const Faces& faces) {
  double width = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    float low = 1e9f, high = -1e9f;
    for (std::size_t c = 0; c < faces[f].size(); ++c) {
      const float u = set.coordinates(set.corners[faces.offset(f) + c], 0);
      low = std::min(low, u);
      high = std::max(high, u);
    }
    width = std::max(width, double(high - low));
  }
  return width;
}

TEST(carry_uvs, no_faces_have_no_uvs) {
  const Cylinder c(12, 4);
  const Triangles triangles = triangulate(c.faces);
  const UvSet set = carry_uvs({triangles, c.uvs(), std::vector<char>(96, 1)}, c.positions, c.positions, {});
  EXPECT_EQ(set.coordinates.rows(), 0);
  EXPECT_TRUE(set.corners.empty());
}

TEST(carry_uvs, where_the_source_has_none_there_is_none) {
  const Cylinder c(12, 4);
  const Triangles triangles = triangulate(c.faces);
  std::vector<char> has(96, 1);
  std::fill(has.begin() + 48, has.end(), 0);  // the upper half
  const UvSet set = carry_uvs({triangles, c.uvs(), has}, c.positions, c.positions, c.faces);
  ASSERT_EQ(set.corners.size(), c.faces.corner_count());
  for (std::size_t f = 0; f < c.faces.size(); ++f)
    for (int k = 0; k < 4; ++k) EXPECT_EQ(set.corners[c.faces.offset(f) + k] >= 0, f < 24) << f;
}

TEST(carry_uvs, the_identity_gives_the_sources_own_seam_included) {
  const Cylinder c(24, 6);
  const Triangles triangles = triangulate(c.faces);
  const auto uvs = c.uvs();
  const UvSet set =
      carry_uvs({triangles, uvs, std::vector<char>(uvs.size(), 1)}, c.positions, c.positions, c.faces);
  ASSERT_EQ(set.corners.size(), c.faces.corner_count());
  EXPECT_EQ(set.coordinates.rows(), 25 * 7);  // one row a vertex, two on the seam
  for (std::size_t f = 0; f < c.faces.size(); ++f) {
    const Eigen::Vector2d expected[4] = {uvs[2 * f][0], uvs[2 * f][1], uvs[2 * f][2], uvs[2 * f + 1][2]};
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d got = set.coordinates.row(set.corners[c.faces.offset(f) + k]).cast<double>();
      EXPECT_LT((got - expected[k]).norm(), 1e-5) << f << " " << k;
    }
  }
}

TEST(carry_uvs, no_face_stretches_over_the_seam) {
  const Cylinder source(24, 6);
  const Triangles triangles = triangulate(source.faces);
  const auto uvs = source.uvs();
  for (const int around : {17, 40, 61}) {
    Cylinder target(around, 9);
    const double turn = 0.37 / around;  // no vertex on the seam
    target.positions *= Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()).toRotationMatrix().transpose();
    const UvSet set = carry_uvs({triangles, uvs, std::vector<char>(uvs.size(), 1)}, source.positions,
                                target.positions, target.faces);
    EXPECT_LT(widest(set, target.faces), 1.25 / around) << around;
    for (const int corner : set.corners) EXPECT_GE(corner, 0);
  }
}

}  // namespace
}  // namespace mien::test
