// A character with another mesh: what agrees stays exactly as it was.
#include "mien/transfer/twin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "mien/transfer/carry_landmarks.h"
#include "transfer/rigged_human.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

using ::testing::IsEmpty;

/// Every face of every part cut into four by its edges' middles; vertices keep their numbers, new ones follow.
Character subdivided(Character character) {
  for (Part& part : character.parts) {
    const Triangles triangles = triangulate(part.mesh.faces);
    std::map<std::pair<int, int>, int> middle;
    std::vector<Eigen::RowVector3f> added;
    const int count = static_cast<int>(part.mesh.positions.rows());
    const auto between = [&](int a, int b) {
      const auto [entry, fresh] =
          middle.try_emplace(std::minmax(a, b), count + static_cast<int>(added.size()));
      if (fresh) added.push_back((part.mesh.positions.row(a) + part.mesh.positions.row(b)) / 2);
      return entry->second;
    };
    Faces faces;
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
      const int a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
      const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
      for (const std::array<int, 3>& face : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        faces.push_back(face);
    }
    Points positions(count + static_cast<int>(added.size()), 3);
    positions.topRows(count) = part.mesh.positions;
    for (std::size_t i = 0; i < added.size(); ++i) positions.row(count + static_cast<int>(i)) = added[i];
    part.mesh = {};
    part.mesh.positions = positions;
    part.mesh.faces = faces;
  }
  return character;
}

Character without_landmarks(Character character) {
  character.landmarks.clear();
  character.curves.clear();
  return character;
}

/// The human's triangles in another order, its vertices shuffled: where each came from is in `from`.
Character shuffled(Character character, std::vector<std::vector<int>>& from) {
  std::mt19937 random(5);
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    Part& part = character.parts[p];
    std::vector<int> order(static_cast<std::size_t>(part.mesh.positions.rows()));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<int> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    const Triangles triangles = triangulate(part.mesh.faces);
    Mesh mesh;
    mesh.positions = part.mesh.positions(order, Eigen::all);
    for (Eigen::Index t = triangles.rows(); t-- > 0;)
      mesh.faces.push_back(
          std::array{place[triangles(t, 1)], place[triangles(t, 2)], place[triangles(t, 0)]});
    part.mesh = mesh;
    if (p == 0)
      for (Landmark& landmark : character.landmarks) landmark.at.vertex = place[landmark.at.vertex];
    from.push_back(std::move(order));
  }
  character.curves.clear();
  return character;
}

/// The largest difference between a shape of `character` and the human's, at vertices that are the human's `from`.
double worst(const Character& character, std::size_t shape, const std::vector<std::vector<int>>& from) {
  double off = 0;
  for (std::size_t p = 0; p < from.size(); ++p) {
    const PointsD own = delta_of(made("human"), shape, static_cast<int>(p)),
                  got = delta_of(character, shape, static_cast<int>(p));
    for (std::size_t v = 0; v < from[p].size(); ++v)
      off = std::max(off, (got.row(static_cast<Eigen::Index>(v)) - own.row(from[p][v])).norm());
  }
  return off;
}

mien::Surface pooled(const Character& character) {
  const FaceSkin skin = skin_of(character);
  return skin.surface;
}

TEST(find_twin, other_faces_are_none) {
  const mien::Surface human = pooled(made("human")), cartoon = pooled(made("cartoon"));
  EXPECT_FALSE(find_twin(human, cartoon, {Similarity{}}));
  EXPECT_FALSE(find_twin(human, {}, {Similarity{}}));
  EXPECT_FALSE(carry_landmarks(made("human"), made("creature")));
}

TEST(find_twin, a_turned_and_grown_copy_is_found_from_a_rough_start) {
  const mien::Surface human = pooled(made("human"));
  const Similarity by = some_similarity(60);
  mien::Surface copy = human;
  copy.positions = by(human.positions).cast<float>().cast<double>();
  Similarity start = by;
  start.rotation = by.rotation * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX());
  start.scale *= 1.02;
  const auto twin = find_twin(human, copy, {Similarity{}, start});
  ASSERT_TRUE(twin);
  EXPECT_TRUE(twin->whole());
  EXPECT_NEAR(twin->placement.scale, 60, 1e-4);
  EXPECT_LT((twin->placement.rotation - by.rotation).norm(), 1e-5);
}

TEST(twin, its_own_face_gives_everything_back) {
  const Character& human = rigged_human();
  const TransferResult result = transfer(human, bare(human));
  const Character& character = result.character;
  EXPECT_THAT(validate(character), IsEmpty());
  for (std::size_t s = 0; s < human.shapes.size(); ++s)
    EXPECT_LT(difference(character, s, human, s), 1e-6) << human.shapes[s].name;
  ASSERT_EQ(character.objects.size(), human.objects.size());
  for (std::size_t o = 0; o < human.objects.size(); ++o) {
    const InfluenceObject &a = character.objects[o], &b = human.objects[o];
    EXPECT_LT((a.controls - b.controls).norm(), 1e-9);
    ASSERT_EQ(a.bindings.size(), b.bindings.size()) << a.name;
    for (std::size_t i = 0; i < a.bindings.size(); ++i) {
      EXPECT_EQ(a.bindings[i].vertices.size(), b.bindings[i].vertices.size()) << a.name;
      EXPECT_EQ(a.bindings[i].controls.size(), b.bindings[i].controls.size()) << a.name;
    }
  }
  EXPECT_LT((character.wires[0].curve.controls - human.wires[0].curve.controls).norm(), 1e-9);
  EXPECT_NEAR(character.wires[0].ranges[0], human.wires[0].ranges[0], 1e-9);
  EXPECT_LT((character.shapes[0].objects[0].controls - human.shapes[0].objects[0].controls).norm(), 1e-9);
  EXPECT_LT((character.shapes[0].wires[0].controls - human.shapes[0].wires[0].controls).norm(), 1e-9);
  EXPECT_EQ(character.constraints[0].translation[1].high, human.constraints[0].translation[1].high);
  for (std::size_t c = 0; c < human.clips.back().channels.size(); ++c)
    for (std::size_t i = 0; i < human.clips.back().channels[c].values.size(); ++i)
      EXPECT_NEAR(character.clips.back().channels[c].values[i], human.clips.back().channels[c].values[i],
                  1e-6);
}

TEST(twin, a_subdivided_mesh_has_the_old_vertices_motion_and_the_mean_between_them) {
  const Character& human = made("human");
  Character mesh = bare(subdivided(human));
  const TransferResult result = transfer(human, mesh);
  EXPECT_THAT(validate(result.character), IsEmpty());
  std::vector<std::vector<int>> same;
  for (const Part& part : human.parts) {
    same.emplace_back();
    for (int v = 0; v < part.mesh.positions.rows(); ++v) same.back().push_back(v);
  }
  for (std::size_t s = 0; s < human.shapes.size(); ++s)
    EXPECT_LT(worst(result.character, s, same), 1e-6 * result.report.unit) << human.shapes[s].name;
}

TEST(twin, shuffled_vertices_and_triangles_change_nothing) {
  std::vector<std::vector<int>> from;
  const Character mesh = bare(shuffled(made("human"), from));
  const TransferResult result = transfer(made("human"), mesh);
  for (std::size_t s = 0; s < made("human").shapes.size(); ++s)
    EXPECT_LT(worst(result.character, s, from), 1e-6 * result.report.unit);
}

TEST(twin, landmarks_need_not_be_given) {
  const auto marks = carry_landmarks(made("human"), without_landmarks(subdivided(made("human"))));
  ASSERT_TRUE(marks);
  Character marked = bare(subdivided(made("human")));
  marked.landmarks = marks->landmarks;
  const PointsD off = landmark_positions(marked) - landmark_positions(made("human"));
  EXPECT_LT(off.rowwise().norm().maxCoeff(), 1e-7);
}

TEST(twin, a_changed_nose_leaves_the_rest_of_the_face_as_it_was) {
  const Character& human = made("human");
  Character mesh = bare(human);
  const Eigen::RowVector3f tip = landmark_place(human, 31).cast<float>();
  const float reach = static_cast<float>((landmark_place(human, 40) - landmark_place(human, 43)).norm());
  std::vector<std::vector<int>> same;
  for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
    same.emplace_back();
    Points& positions = mesh.parts[p].mesh.positions;
    for (Eigen::Index v = 0; v < positions.rows(); ++v) {
      const float away = (positions.row(v) - tip).norm() / reach;
      if (p == 0 && away < 1) positions(v, 2) += 0.4f * reach * (1 - away) * (1 - away);
    }
  }
  const TransferResult result = transfer(human, mesh);
  EXPECT_THAT(validate(result.character), IsEmpty());
  const double unit = result.report.unit;
  for (std::size_t s = 0; s < human.shapes.size(); ++s) {
    const PointsD own = delta_of(human, s, 0), got = delta_of(result.character, s, 0);
    for (Eigen::Index v = 0; v < own.rows(); ++v) {
      const float away = (human.parts[0].mesh.positions.row(v) - tip).norm() / reach;
      const double off = (own.row(v) - got.row(v)).norm();
      // On the changed nose motion is estimated, and hardly any other.
      EXPECT_LT(off, (away > 1.1 ? 1e-6 : 0.02) * unit) << human.shapes[s].name << " " << v;
    }
  }
}

}  // namespace
}  // namespace mien::test
