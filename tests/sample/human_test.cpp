// The rig of the built-in human.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "sample/made.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;

double gap(int a, int b, const std::map<std::string, double>& weights) {
  const Character& human = made("human");
  const PointsD positions = shaped(human, 0, weights);
  return (positions.row(landmark_vertex(human, a)) - positions.row(landmark_vertex(human, b))).norm();
}

/// For each vertex of a symmetric mesh the one at -x, -1 where there is none.
std::vector<int> mirror_of(const Mesh& mesh) {
  using Key = std::array<long, 3>;
  const auto key = [&](Eigen::Index v, float sign) {
    return Key{std::lround(sign * mesh.positions(v, 0) * 1e6f), std::lround(mesh.positions(v, 1) * 1e6f),
               std::lround(mesh.positions(v, 2) * 1e6f)};
  };
  std::map<Key, int> at;
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) at[key(v, 1)] = static_cast<int>(v);
  std::vector<int> mirror;
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    const auto twin = at.find(key(v, -1));
    mirror.push_back(twin == at.end() ? -1 : twin->second);
  }
  return mirror;
}

TEST(Human, IsAsLargeAsAHeadAndLooksAhead) {
  const Character& human = made("human");
  const Mesh& skin = human.parts[0].mesh;
  EXPECT_NEAR(bounding_box(skin.positions).high.y() - skin.positions(landmark_vertex(human, 9), 1), 0.235,
              0.015);
  EXPECT_GT(skin.positions(landmark_vertex(human, 31), 2), 0.1f);
  EXPECT_GE(skin.vertex_count(), 3000u);
  EXPECT_LE(skin.vertex_count(), 8000u);
}

TEST(Human, HasTheShapesOfArkit) {
  std::vector<std::string> expected = {"browInnerUp", "cheekPuff",      "jawForward",      "jawLeft",
                                       "jawOpen",     "jawRight",       "mouthClose",      "mouthFunnel",
                                       "mouthLeft",   "mouthPucker",    "mouthRight",      "mouthRollLower",
                                       "tongueOut",   "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper"};
  for (const std::string name :
       {"browDown", "browOuterUp", "cheekSquint", "eyeBlink", "eyeLookDown", "eyeLookIn", "eyeLookOut",
        "eyeLookUp", "eyeSquint", "eyeWide", "mouthDimple", "mouthFrown", "mouthLowerDown", "mouthPress",
        "mouthSmile", "mouthStretch", "mouthUpperUp", "noseSneer"}) {
    expected.push_back(name + "Left");
    expected.push_back(name + "Right");
  }
  std::vector<std::string> got;
  for (const Shape& shape : made("human").shapes) got.push_back(shape.name);
  EXPECT_EQ(got.size(), 52u);
  EXPECT_THAT(got, ::testing::UnorderedElementsAreArray(expected));
}

TEST(Human, PairedShapesMirrorEachOther) {
  const Character& human = made("human");
  const std::vector<int> mirror = mirror_of(human.parts[0].mesh);
  for (int twin : mirror) ASSERT_GE(twin, 0);
  const PointsD neutral = shaped(human, 0, {});
  for (const Shape& shape : human.shapes) {
    const std::size_t at = shape.name.find("Left");
    if (at == std::string::npos) continue;
    const PointsD left = shaped(human, 0, {{shape.name, 1}}) - neutral;
    const PointsD right = shaped(human, 0, {{shape.name.substr(0, at) + "Right", 1}}) - neutral;
    EXPECT_GT(left.rowwise().norm().maxCoeff(), 2e-4) << shape.name;
    double worst = 0;
    for (Eigen::Index v = 0; v < left.rows(); ++v) {
      const Eigen::RowVector3d flipped(-right(mirror[v], 0), right(mirror[v], 1), right(mirror[v], 2));
      worst = std::max(worst, (left.row(v) - flipped).norm());
    }
    // Deltas below a micrometre are left out.
    EXPECT_LT(worst, 2e-6) << shape.name;
  }
}

TEST(Human, BlinkShutsTheEye) {
  for (const auto& [upper, lower, shape] : {std::tuple{38, 42, "eyeBlinkRight"},
                                            {39, 41, "eyeBlinkRight"},
                                            {44, 48, "eyeBlinkLeft"},
                                            {45, 47, "eyeBlinkLeft"}}) {
    const double open = gap(upper, lower, {});
    EXPECT_GT(open, 0.006) << upper;
    EXPECT_LT(gap(upper, lower, {{shape, 1}}), 0.02 * open) << upper;
    EXPECT_GT(gap(upper, lower, {{shape, 0.5}}), 0.3 * open) << upper;
  }
}

TEST(Human, LidsStayOutsideTheEyeball) {
  const Character& human = made("human");
  const PointsD ball = shaped(human, find_part(human, "eyeLeft"), {});
  const Vector3d centre = (ball.colwise().maxCoeff() + ball.colwise().minCoeff()).transpose() / 2;
  const double radius = (ball.row(0).transpose() - centre).norm();
  using Weights = std::map<std::string, double>;
  for (const Weights& pose : {Weights{}, Weights{{"eyeBlinkLeft", 1}}, Weights{{"eyeBlinkLeft", 0.5}},
                              Weights{{"eyeSquintLeft", 1}}, Weights{{"eyeWideLeft", 1}}}) {
    const PointsD skin = shaped(human, 0, pose);
    for (int number : {44, 45, 47, 48})
      EXPECT_GT((skin.row(landmark_vertex(human, number)).transpose() - centre).norm(), radius) << number;
  }
}

TEST(Human, JawOpensTheMouthAndMouthCloseClosesIt) {
  EXPECT_LT(gap(63, 67, {}), 0.002);
  const double open = gap(63, 67, {{"jawOpen", 1}});
  EXPECT_GT(open, 0.025);
  for (const auto& [upper, lower] : {std::pair{63, 67}, {62, 68}, {64, 66}})
    EXPECT_LT(gap(upper, lower, {{"jawOpen", 1}, {"mouthClose", 1}}), 0.05 * open);
}

TEST(Human, InnerPartsFollowTheirShapes) {
  const Character& human = made("human");
  const auto moves = [&](const char* shape, const char* name) {
    const int part = find_part(human, name);
    return (shaped(human, part, {{shape, 1}}) - shaped(human, part, {})).rowwise().norm().maxCoeff();
  };
  EXPECT_GT(moves("jawOpen", "teethLower"), 0.01);
  EXPECT_GT(moves("jawOpen", "tongue"), 0.01);
  EXPECT_EQ(moves("jawOpen", "teethUpper"), 0);
  EXPECT_GT(moves("tongueOut", "tongue"), 0.02);
  EXPECT_EQ(moves("eyeLookInLeft", "eyeRight"), 0);
  EXPECT_GT(moves("eyeBlinkLeft", "lashes"), 0.004);
  EXPECT_GT(moves("browInnerUp", "brows"), 0.003);
}

TEST(Human, GazeTurnsTheEyeballTheNamedWay) {
  const Character& human = made("human");
  const int left = find_part(human, "eyeLeft");
  // Vertex 0 is the middle of the pupil.
  const auto pupil = [&](const char* shape) -> Eigen::RowVector3d {
    return shaped(human, left, {{shape, 1}}).row(0) - shaped(human, left, {}).row(0);
  };
  EXPECT_LT(pupil("eyeLookInLeft").x(), -0.004);
  EXPECT_GT(pupil("eyeLookOutLeft").x(), 0.004);
  EXPECT_GT(pupil("eyeLookUpLeft").y(), 0.004);
  EXPECT_LT(pupil("eyeLookDownLeft").y(), -0.004);
}

TEST(Human, IsBoundToItsJoints) {
  const Character& human = made("human");
  ASSERT_EQ(human.skins.size(), 1u);
  EXPECT_GE(human.skins[0].joints.size(), 20u);
  for (const Part& part : human.parts)
    EXPECT_EQ(part.skin_weights.offsets.size(), part.mesh.vertex_count() + 1) << part.name;
  const auto only_joint = [&](const char* name) -> std::string {
    const SkinWeights& weights = human.parts[find_part(human, name)].skin_weights;
    const std::set<int> joints(weights.joints.begin(), weights.joints.end());
    return joints.size() == 1 ? human.nodes[human.skins[0].joints[*joints.begin()]].name : "several";
  };
  EXPECT_EQ(only_joint("teethLower"), "jaw");
  EXPECT_EQ(only_joint("teethUpper"), "head");
  EXPECT_EQ(only_joint("eyeLeft"), "eyeLeft_joint");
  EXPECT_EQ(only_joint("Face"), "several");
}

TEST(Human, InverseBindsUndoTheRestPose) {
  const Character& human = made("human");
  const auto matrices = model_matrices(human);
  for (std::size_t j = 0; j < human.skins[0].joints.size(); ++j) {
    const Eigen::Matrix4d product = matrices[human.skins[0].joints[j]] * human.skins[0].inverse_bind[j];
    EXPECT_TRUE(product.isIdentity(1e-9)) << j;
  }
}

TEST(Human, TalksWithShapesAndJoints) {
  const Character& human = made("human");
  ASSERT_EQ(human.clips.size(), 1u);
  const Clip& talk = human.clips[0];
  EXPECT_EQ(talk.name, "talk");
  EXPECT_NEAR(talk.duration(), 4, 1e-6);
  bool jaw_turns = false, shapes_move = false;
  for (const Channel& channel : talk.channels) {
    jaw_turns |= channel.property == Channel::Property::rotation && human.nodes[channel.node].name == "jaw";
    shapes_move |= channel.property == Channel::Property::shape_weight;
    // The clip can be played over and over: it ends as it begins.
    const std::size_t width = channel.width(), end = channel.values.size() - width;
    for (std::size_t k = 0; k < width; ++k) EXPECT_FLOAT_EQ(channel.values[k], channel.values[end + k]);
  }
  EXPECT_TRUE(jaw_turns && shapes_move);
}

}  // namespace
}  // namespace mien::test
