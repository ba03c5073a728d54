// What holds for every built-in character.

#include "mien/sample/sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "sample/made.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;

/// Edges without a face on their other side, from their first to their second vertex.
std::map<int, int> open_edges(const Mesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    for (std::size_t c = 0; c < face.size(); ++c)
      EXPECT_TRUE(edges.emplace(face[c], face[(c + 1) % face.size()]).second) << "face " << f;
  }
  std::map<int, int> open;
  for (const auto& [a, b] : edges)
    if (!edges.count({b, a})) open[a] = b;
  return open;
}

TEST(Sample, UnknownNameIsRefused) {
  try {
    make_sample("robot");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    EXPECT_STREQ(error.what(),
                 "sample robot: is not a built-in character; use one of human, cartoon, creature");
  }
}

TEST(Sample, FirstIsTheSourceThenTheTargets) {
  const auto list = sample_list();
  ASSERT_EQ(list.size(), 3u);
  EXPECT_FALSE(list[0].is_target);
  EXPECT_TRUE(list[1].is_target && list[2].is_target);
}

class EverySample : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, EverySample, ::testing::Values("human", "cartoon", "creature"),
                         [](const auto& at) { return std::string(at.param); });

TEST_P(EverySample, IsValid) {
  for (const Problem& problem : validate(made(GetParam())))
    ADD_FAILURE() << problem.place << ": " << problem.text;
}

TEST_P(EverySample, HasEyesTeethAndTongue) {
  for (const char* part : {"Face", "eyeLeft", "eyeRight", "teethUpper", "teethLower", "tongue"})
    EXPECT_GE(find_part(made(GetParam()), part), 0) << part;
}

TEST_P(EverySample, SkinIsOpenAtTheNeckAndBehindTheEyesAndOtherPartsAreClosed) {
  for (const Part& part : made(GetParam()).parts) {
    SCOPED_TRACE(part.name);
    std::map<int, int> open = open_edges(part.mesh);
    int loops = 0;
    for (; !open.empty(); ++loops)
      for (auto at = open.begin(); at != open.end();) {
        const int next = at->second;
        open.erase(at);
        at = open.find(next);
      }
    EXPECT_EQ(loops, part.name == "Face" ? 3 : 0);
  }
}

TEST_P(EverySample, FacesHaveArea) {
  const double scale = bounding_box(made(GetParam()).parts[0].mesh.positions).diagonal();
  for (const Part& part : made(GetParam()).parts)
    for (std::size_t f = 0; f < part.mesh.faces.size(); ++f) {
      const auto face = part.mesh.faces[f];
      const auto at = [&](std::size_t c) -> Vector3d {
        return part.mesh.positions.row(face[c]).transpose().cast<double>();
      };
      Vector3d area = Vector3d::Zero();
      for (std::size_t c = 2; c < face.size(); ++c) area += (at(c - 1) - at(0)).cross(at(c) - at(0));
      EXPECT_GT(area.norm(), 1e-9 * scale * scale) << part.name << " face " << f;
    }
}

TEST_P(EverySample, HasThe68LandmarksOnItsSkinAndCurvesBesideThem) {
  const Character& character = made(GetParam());
  std::set<int> vertices;
  ASSERT_EQ(character.landmarks.size(), 68u);
  for (int i = 1; i <= 68; ++i) vertices.insert(landmark_vertex(character, i));
  EXPECT_EQ(vertices.size(), 68u) << "two landmarks share a vertex";
  std::vector<std::string> names;
  for (const LandmarkCurve& curve : character.curves) {
    names.push_back(curve.name);
    for (const SurfacePoint& point : curve.points) EXPECT_EQ(vertices.count(point.vertex), 0u) << curve.name;
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("browLeft", "browRight", "lipUpper", "lipLower"));
}

TEST_P(EverySample, LandmarksAreWhereTheirNumbersSay) {
  const Character& character = made(GetParam());
  const auto at = [&](int number) -> Vector3d {
    return character.parts[0]
        .mesh.positions.row(landmark_vertex(character, number))
        .transpose()
        .cast<double>();
  };
  // Sideways from the middle of the nose, in the head's own frame: the creature is turned.
  const Vector3d to_left = (at(46) - at(37)).normalized();
  const auto x = [&](int number) { return (at(number) - at(28)).dot(to_left); };
  for (const auto& [right, left] :
       {std::pair{1, 17}, {5, 13}, {18, 27}, {32, 36}, {37, 46}, {40, 43}, {49, 55}, {61, 65}}) {
    EXPECT_LT(x(right), 0) << right;
    EXPECT_NEAR(x(right), -x(left), 1e-4 * std::abs(x(37))) << right << " and " << left;
  }
  for (const auto& [below, above] : {std::pair{9, 58}, {58, 52}, {52, 34}, {34, 28}, {42, 38}, {38, 20}})
    EXPECT_LT(at(below).y(), at(above).y()) << below << " and " << above;
}

TEST_P(EverySample, TwoCallsGiveEqualCharactersAtAnyThreadCount) {
  const Character& first = made(GetParam());
  set_thread_count(1);
  const Character second = make_sample(GetParam());
  set_thread_count(0);
  ASSERT_EQ(first.parts.size(), second.parts.size());
  for (std::size_t p = 0; p < first.parts.size(); ++p) {
    EXPECT_EQ(first.parts[p].mesh.positions, second.parts[p].mesh.positions);
    EXPECT_EQ(first.parts[p].mesh.normals, second.parts[p].mesh.normals);
    EXPECT_EQ(first.parts[p].mesh.faces, second.parts[p].mesh.faces);
    EXPECT_EQ(first.parts[p].mesh.uvs, second.parts[p].mesh.uvs);
    EXPECT_EQ(first.parts[p].skin_weights, second.parts[p].skin_weights);
  }
  for (std::size_t s = 0; s < first.shapes.size(); ++s)
    for (std::size_t d = 0; d < first.shapes[s].parts.size(); ++d)
      EXPECT_EQ(first.shapes[s].parts[d].deltas, second.shapes[s].parts[d].deltas);
}

TEST(Targets, HaveNoRigAndAnotherTopology) {
  const Mesh& human = made("human").parts[0].mesh;
  for (const char* name : {"cartoon", "creature"}) {
    const Character& target = made(name);
    EXPECT_TRUE(target.shapes.empty() && target.skins.empty() && target.clips.empty()) << name;
    EXPECT_NE(target.parts[0].mesh.vertex_count(), human.vertex_count()) << name;
    EXPECT_NE(target.parts[0].mesh.faces.size(), human.faces.size()) << name;
  }
  EXPECT_FALSE(made("cartoon").parts[0].mesh.uvs.empty());
  const Mesh& creature = made("creature").parts[0].mesh;
  EXPECT_TRUE(creature.uvs.empty());
  for (std::size_t f = 0; f < creature.faces.size(); ++f) EXPECT_EQ(creature.faces[f].size(), 3u);
  EXPECT_GT(bounding_box(made("cartoon").parts[0].mesh.positions).diagonal(),
            50 * bounding_box(human.positions).diagonal());
}

}  // namespace
}  // namespace mien::test
