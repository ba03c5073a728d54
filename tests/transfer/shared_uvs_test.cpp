// Faces of one base mesh: their UVs say which place is which.
#include "mien/transfer/shared_uvs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mien/transfer/carry_landmarks.h"
#include "transfer/rigged_human.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

using ::testing::HasSubstr;

/// A bumpy sheet of `across` x `across` quads over the unit square, the square its UVs.
struct Sheet {
  PointsD positions;
  UvLayout layout;
};
Sheet sheet(int across, double bump, bool other_diagonal) {
  Sheet result;
  const int row = across + 1;
  result.positions.resize(row * row, 3);
  for (int y = 0; y <= across; ++y)
    for (int x = 0; x <= across; ++x)
      result.positions.row(y * row + x) << double(x) / across, double(y) / across,
          bump * std::sin(5.0 * x / across);
  const auto uv = [&](int v) -> Eigen::Vector2d { return Eigen::Vector2d(v % row, v / row) / across; };
  result.layout.triangles.resize(2 * across * across, 3);
  Eigen::Index t = 0;
  for (int y = 0; y < across; ++y)
    for (int x = 0; x < across; ++x) {
      const int a = y * row + x, b = a + 1, c = b + row, d = a + row;
      if (other_diagonal) {
        result.layout.triangles.row(t++) << a, b, d;
        result.layout.triangles.row(t++) << b, c, d;
      } else {
        result.layout.triangles.row(t++) << a, b, c;
        result.layout.triangles.row(t++) << a, c, d;
      }
    }
  for (t = 0; t < result.layout.triangles.rows(); ++t) {
    result.layout.uvs.emplace_back();
    for (int k = 0; k < 3; ++k)
      result.layout.uvs.back()[static_cast<std::size_t>(k)] = uv(result.layout.triangles(t, k));
    result.layout.has_uv.push_back(1);
  }
  return result;
}

PointsD mix(const std::vector<SourcePoint>& points, const Triangles& triangles, const PointsD& values) {
  PointsD result = PointsD::Zero(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    for (int k = 0; k < 3; ++k)
      result.row(static_cast<Eigen::Index>(v)) +=
          points[v].barycentric[k] * values.row(triangles(points[v].triangle, k));
  return result;
}

TEST(find_shared_uvs, same_vertices_are_found_through_other_triangles) {
  const Sheet flat = sheet(12, 0, false), bumpy = sheet(12, 0.3, true);
  const auto shared = find_shared_uvs(flat.layout, bumpy.layout, bumpy.positions, flat.positions, 0.3);
  ASSERT_TRUE(shared);
  EXPECT_LT((mix(shared->points, flat.layout.triangles, flat.positions) - flat.positions).norm(), 1e-12);
  EXPECT_LT((shared->guide - bumpy.positions).norm(), 1e-12);
  EXPECT_EQ(std::count(shared->known.begin(), shared->known.end(), 1), flat.positions.rows());
}

TEST(find_shared_uvs, a_coarser_level_lies_on_the_finer_one) {
  const Sheet fine = sheet(16, 0, false), coarse = sheet(8, 0.1, false);
  const auto down = find_shared_uvs(fine.layout, coarse.layout, coarse.positions, fine.positions, 0.3);
  const auto up = find_shared_uvs(coarse.layout, fine.layout, fine.positions, coarse.positions, 0.3);
  ASSERT_TRUE(down && up);
  for (Eigen::Index v = 0; v < coarse.positions.rows(); ++v) {
    const Eigen::RowVector2d own = coarse.positions.row(v).head<2>();
    EXPECT_LT((mix(down->points, fine.layout.triangles, fine.positions).row(v).head<2>() - own).norm(),
              1e-12);
  }
  EXPECT_LT((up->guide.leftCols<2>() - coarse.positions.leftCols<2>()).norm(), 1e-12);
}

TEST(find_shared_uvs, layouts_drawn_differently_are_not_shared) {
  const Sheet one = sheet(12, 0, false), other = sheet(13, 0, false);
  EXPECT_FALSE(find_shared_uvs(one.layout, other.layout, other.positions, one.positions, 1));
  Sheet smaller = one;
  for (auto& corners : smaller.layout.uvs)
    for (Eigen::Vector2d& uv : corners) uv *= 0.9;
  EXPECT_FALSE(find_shared_uvs(one.layout, smaller.layout, smaller.positions, one.positions, 1));
}

TEST(find_shared_uvs, halves_on_each_other_name_no_place) {
  Sheet mirrored = sheet(12, 0, false);
  for (auto& corners : mirrored.layout.uvs)
    for (Eigen::Vector2d& uv : corners) uv.x() = std::abs(uv.x() - 0.5);
  EXPECT_FALSE(find_shared_uvs(mirrored.layout, mirrored.layout, mirrored.positions, mirrored.positions, 1));
}

TEST(find_shared_uvs, what_is_far_from_where_it_is_expected_is_another_thing) {
  const Sheet one = sheet(12, 0, false);
  const PointsD elsewhere = one.positions.rowwise() + Eigen::RowVector3d(0, 0, 2);
  EXPECT_FALSE(find_shared_uvs(one.layout, one.layout, elsewhere, one.positions, 1.9));
  EXPECT_TRUE(find_shared_uvs(one.layout, one.layout, elsewhere, one.positions, 2.1));
}

TEST(find_shared_uvs, without_uvs_there_are_none) {
  Sheet one = sheet(4, 0, false);
  Sheet bare = one;
  std::fill(bare.layout.has_uv.begin(), bare.layout.has_uv.end(), 0);
  EXPECT_FALSE(find_shared_uvs(one.layout, bare.layout, bare.positions, one.positions, 1));
  EXPECT_FALSE(find_shared_uvs(bare.layout, one.layout, one.positions, bare.positions, 1));
}

TEST(find_shared_uvs, vertices_that_the_other_lacks_stay_where_they_are_expected) {
  const Sheet whole = sheet(24, 0, false);
  Sheet holed = whole;
  holed.layout.has_uv[0] = holed.layout.has_uv[1] = 0;  // the corner's quad
  const auto shared = find_shared_uvs(whole.layout, holed.layout, holed.positions, whole.positions, 1);
  ASSERT_TRUE(shared);
  EXPECT_FALSE(shared->known[0]);
  EXPECT_FALSE(shared->points[0].accepted);
  EXPECT_EQ(shared->points[0].triangle, -1);
  EXPECT_EQ(shared->guide.row(0), whole.positions.row(0));
}

/// The human with a longer, wider face, its vertices and faces in another order; `from`: where each was.
Character relative_of_the_human(std::vector<int>& from) {
  Character face = bare(made("human"));
  Mesh& mesh = face.parts[0].mesh;
  const int count = static_cast<int>(mesh.positions.rows());
  for (int v = 0; v < count; ++v) from.push_back(v);
  std::mt19937 random(3);
  std::shuffle(from.begin(), from.end(), random);
  std::vector<int> now(from.size());
  for (int v = 0; v < count; ++v) now[static_cast<std::size_t>(from[static_cast<std::size_t>(v)])] = v;
  Faces faces;
  UvSet uvs;
  uvs.coordinates = mesh.uvs[0].coordinates;
  for (std::size_t f = mesh.faces.size(); f-- > 0;) {
    std::vector<int> face_now;
    for (std::size_t c = 0; c < mesh.faces[f].size(); ++c) {
      const std::size_t turned = (c + 1) % mesh.faces[f].size();
      face_now.push_back(now[static_cast<std::size_t>(mesh.faces[f][turned])]);
      const std::size_t corner = static_cast<std::size_t>(mesh.faces.offset(f)) + turned;
      uvs.corners.push_back(mesh.uvs[0].corners.empty() ? mesh.faces[f][turned]
                                                        : mesh.uvs[0].corners[corner]);
    }
    faces.push_back(face_now);
  }
  Points positions = mesh.positions(from, Eigen::all);
  const float tall = positions.col(1).maxCoeff() - positions.col(1).minCoeff();
  positions.col(0) = positions.col(0).array() * (1 + 0.1f * (positions.col(1).array() / tall).sin());
  positions.col(1) *= 1.08f;
  mesh = {};
  mesh.positions = positions;
  mesh.faces = faces;
  mesh.uvs = {uvs};
  for (Landmark& landmark : face.landmarks)
    landmark.at.vertex = now[static_cast<std::size_t>(landmark.at.vertex)];
  face.curves.clear();
  return face;
}

TEST(shared_uvs, a_relative_gets_the_rig_vertex_by_vertex) {
  std::vector<int> from;
  const Character target = relative_of_the_human(from);
  const Character& human = made("human");
  const TransferResult result = transfer(human, target);
  EXPECT_EQ(result.report.correspondence, Correspondence::shared_uvs);
  EXPECT_THAT(validate(result.character), ::testing::IsEmpty());
  EXPECT_EQ(result.report.filled[0].maxCoeff(), 0);
  const SkinWeights &own = human.parts[0].skin_weights, &got = result.character.parts[0].skin_weights;
  const auto weights = [](const SkinWeights& all, int vertex) {
    std::map<int, float> list;
    for (int e = all.offsets[static_cast<std::size_t>(vertex)];
         e < all.offsets[static_cast<std::size_t>(vertex) + 1]; ++e)
      list[all.joints[static_cast<std::size_t>(e)]] = all.weights[static_cast<std::size_t>(e)];
    return list;
  };
  // The smallest weights are left out, and the mouth's ground is a speck in the image.
  std::size_t equal = 0;
  for (std::size_t v = 0; v < from.size(); ++v) {
    auto carried = weights(got, static_cast<int>(v));
    double off = 0;
    for (const auto& [joint, weight] : weights(own, from[v]))
      off = std::max(off, static_cast<double>(std::abs(carried[joint] - weight)));
    EXPECT_LT(off, 0.02) << v;
    equal += off < 1e-3;
  }
  EXPECT_GT(equal, from.size() * 99 / 100);
}

TEST(shared_uvs, a_relative_needs_no_landmarks) {
  std::vector<int> from;
  Character target = relative_of_the_human(from);
  const PointsD wanted = landmark_positions(target);
  target.landmarks.clear();
  EXPECT_FALSE(carry_landmarks(made("human"), target, false));
  EXPECT_FALSE(carry_landmarks(made("human"), bare(made("cartoon"))));
  const auto carried = carry_landmarks(made("human"), target);
  ASSERT_TRUE(carried);
  ASSERT_EQ(carried->landmarks.size(), made("human").landmarks.size());
  EXPECT_EQ(carried->curves.size(), made("human").curves.size());
  target.landmarks = carried->landmarks;
  const double size = bounding_box(target.parts[0].mesh.positions).diagonal();
  EXPECT_LT((landmark_positions(target) - wanted).rowwise().norm().maxCoeff(), 1e-4 * size);
}

TEST(shared_uvs, surfaces_can_be_asked_for) {
  std::vector<int> from;
  const Character target = relative_of_the_human(from);
  TransferOptions options;
  options.correspondence = Correspondence::surfaces;
  const TransferReport report = transfer(made("human"), target, options).report;
  EXPECT_EQ(report.correspondence, Correspondence::surfaces);
  // Its eyes and teeth are the human's, its face is not.
  EXPECT_THAT(report.deltas.reason, ::testing::Not(HasSubstr("own surface")));
}

TEST(shared_uvs, asked_for_where_there_are_none_they_are_missed) {
  TransferOptions options;
  options.correspondence = Correspondence::shared_uvs;
  const std::string text = invalid_input_of([&] { transfer(made("human"), bare(made("cartoon")), options); });
  EXPECT_THAT(text, HasSubstr("does not share the source's UV layout"));
}

}  // namespace
}  // namespace mien::test
