// Landmarks found on the built-in heads, which know where theirs are; and what is no head.
#include "mien/transfer/find_landmarks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <numbers>

#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/transfer/detail/correction.h"
#include "mien/transfer/detail/relief.h"
#include "transfer/faces.h"

namespace mien::test {
namespace {

/// The character's first part alone, moved; its landmarks with it.
Character skin_moved(const Character& character, const Similarity& by) {
  Character moved;
  moved.parts.push_back(character.parts[0]);
  Part& part = moved.parts[0];
  part.node = part.skin = -1;
  part.skin_weights = {};
  part.mesh.normals.resize(0, 3);
  part.mesh.positions = by(PointsD(part.mesh.positions.cast<double>())).cast<float>();
  for (const Landmark& landmark : character.landmarks)
    if (landmark.at.part == 0) moved.landmarks.push_back(landmark);
  return moved;
}

Character without_landmarks(Character character) {
  character.landmarks.clear();
  character.curves.clear();
  return character;
}

/// Mean distance from the character's own landmarks, of the face's size, over names that hold `from` or a higher number.
double mean_error(const FoundLandmarks& found, const Character& truth, int from = 1) {
  double sum = 0;
  int count = 0;
  for (const LandmarkPoint& own : landmark_points(truth))
    for (const FoundLandmark& one : found.landmarks)
      if (one.landmark.name == own.name && std::stoi(own.name.substr(5)) >= from) {
        sum += (one.position - own.position).norm() / found.unit;
        ++count;
      }
  return sum / count;
}

/// A body of revolution about y with radius(v) at height(v), v from 0 (below) to 1.
void revolve(Character& character, const std::function<double(double)>& radius,
             const std::function<double(double)>& height) {
  constexpr int around = 32, up = 24;
  Part part;
  part.name = "body";
  part.mesh.positions.resize(around * (up + 1), 3);
  for (int j = 0; j <= up; ++j)
    for (int i = 0; i < around; ++i) {
      const double v = 0.01 + 0.98 * j / up, angle = -2 * std::numbers::pi * i / around;
      part.mesh.positions.row(j * around + i) << static_cast<float>(radius(v) * std::cos(angle)),
          static_cast<float>(height(v)), static_cast<float>(radius(v) * std::sin(angle));
    }
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around;
      part.mesh.faces.push_back(
          {j * around + i, j * around + next, (j + 1) * around + next, (j + 1) * around + i});
    }
  character.parts.push_back(part);
}

Character egg() {
  Character character;
  revolve(
      character,
      [](double v) {
        return 0.75 * std::sin(std::numbers::pi * v) * (1 + 0.15 * std::cos(std::numbers::pi * v));
      },
      [](double v) { return -std::cos(std::numbers::pi * v); });
  return character;
}

/// Belly, spout and knob; the spout is bent forward.
Character teapot() {
  Character character;
  revolve(
      character, [](double v) { return std::pow(std::sin(std::numbers::pi * v), 0.6); },
      [](double v) { return -0.75 * std::cos(std::numbers::pi * v); });
  revolve(
      character, [](double v) { return 0.25 - 0.14 * v; }, [](double v) { return v; });
  Points& spout = character.parts[1].mesh.positions;
  for (Eigen::Index v = 0; v < spout.rows(); ++v) {
    const float along = spout(v, 1);
    spout.row(v) << spout(v, 0), -0.2f + 0.9f * along * along + spout(v, 2), 0.85f + 0.9f * along;
  }
  return character;
}

TEST(FindLandmarks, InvalidInputs) {
  const Character& human = made("human");
  EXPECT_NE(invalid_input_of([&] {
              find_landmarks(human, without_landmarks(human));
            }).find("the head to be like has 0; 4 or more on its skin"),
            std::string::npos);
  EXPECT_NE(invalid_input_of([&] { find_landmarks(Character{}, human); }).find("target: has no faces"),
            std::string::npos);
  FindLandmarksOptions twice;
  twice.given = {human.landmarks[0], human.landmarks[0]};
  EXPECT_NE(invalid_input_of([&] { find_landmarks(human, human, twice); }).find("is there twice"),
            std::string::npos);
}

TEST(FindLandmarks, AnEggAndATeapotAreRefused) {
  for (const Character& none : {egg(), teapot()}) {
    const FoundLandmarks found = find_landmarks(none, made("human"));
    EXPECT_EQ(found.verdict, Verdict::refuse) << found.score << " " << found.likeness;
    EXPECT_LT(found.likeness, 0.45);
    EXPECT_TRUE(found.landmarks.empty());
    EXPECT_NE(found.reason.find("relief"), std::string::npos) << found.reason;
  }
}

TEST(FindLandmarks, OnItsSideAndInAnyUnit) {
  for (const double scale : {0.01, 100.0}) {
    Similarity by = some_similarity(scale);
    by.rotation = Eigen::AngleAxisd(1.7, Eigen::Vector3d(0.2, 0.1, 1).normalized()).toRotationMatrix();
    const Character turned = skin_moved(made("human"), by);
    const FoundLandmarks found = find_landmarks(without_landmarks(turned), made("human"));
    EXPECT_EQ(found.verdict, Verdict::accept);
    EXPECT_LT(mean_error(found, turned), 0.003);
    EXPECT_LT((found.facing * by.rotation - Eigen::Matrix3d::Identity()).norm(), 0.02);
    for (const FoundLandmark& one : found.landmarks) EXPECT_GT(one.confidence, 0.9) << one.landmark.name;
  }
}

TEST(FindLandmarks, AnotherFaceFromNoneAndFromFive) {
  const Character& cartoon = made("cartoon");
  const FoundLandmarks none = find_landmarks(without_landmarks(cartoon), made("human"));
  EXPECT_NE(none.verdict, Verdict::refuse);
  EXPECT_LT(mean_error(none, cartoon, 18), 0.045);
  EXPECT_EQ(none.curves.size(), cartoon.curves.size());
  FindLandmarksOptions five;
  for (const Landmark& landmark : cartoon.landmarks)
    for (const int number : {37, 46, 31, 49, 55})
      if (landmark.name == "ibug_" + std::to_string(number)) five.given.push_back(landmark);
  const FoundLandmarks some = find_landmarks(without_landmarks(cartoon), made("human"), five);
  EXPECT_LT(mean_error(some, cartoon, 18), mean_error(none, cartoon, 18));
  for (const FoundLandmark& one : some.landmarks)
    for (const Landmark& given : five.given)
      if (given.name == one.landmark.name) {
        EXPECT_TRUE(one.given);
        EXPECT_EQ(one.landmark.at.vertex, given.at.vertex);
        EXPECT_EQ(one.confidence, 1);
      }
}

TEST(FindLandmarks, TrustInTheArrangementKeepsIt) {
  const Character cartoon = without_landmarks(made("cartoon"));
  PointsD own(68, 3);
  for (const LandmarkPoint& point : landmark_points(made("human")))
    own.row(std::stoi(point.name.substr(5)) - 1) = point.position.transpose();
  std::vector<double> bent;
  for (const double trust : {0.003, 1.0}) {
    FindLandmarksOptions options;
    options.arrangement_trust = trust;
    PointsD places(68, 3);
    for (const FoundLandmark& one : find_landmarks(cartoon, made("human"), options).landmarks)
      places.row(std::stoi(one.landmark.name.substr(5)) - 1) = one.position.transpose();
    bent.push_back((fit_similarity(own, places)(own) - places).norm());
  }
  EXPECT_LT(bent[1], bent[0]);
}

TEST(FindLandmarks, AMisplacedPointIsNamed) {
  const Character& human = made("human");
  FindLandmarksOptions options;
  SurfacePoint chin;
  for (const Landmark& landmark : human.landmarks)
    if (landmark.name == "ibug_9") chin = landmark.at;
  for (const Landmark& landmark : human.landmarks)
    for (const int number : {37, 46, 31, 49, 55, 58})
      if (landmark.name == "ibug_" + std::to_string(number))
        options.given.push_back({landmark.name, number == 58 ? chin : landmark.at});
  const FoundLandmarks found = find_landmarks(without_landmarks(human), human, options);
  ASSERT_EQ(found.doubtful.size(), 1u);
  EXPECT_EQ(found.doubtful[0].name, "ibug_58");
  EXPECT_EQ(found.doubtful[0].looks_like, "ibug_9");
  EXPECT_GT(found.doubtful[0].distance, 0.1);
}

TEST(FindLandmarks, OneSideSpeaksForTheOther) {
  PointsD points(3, 3);
  points << 0.3, 0.1, 0, -0.3, 0.1, 0, 0, -0.2, 0.1;
  const std::vector<int> mirror{1, 0, 2};
  const std::vector<detail::Residual> left{{0, points.row(0), {0.02, -0.01, 0.005}}};
  const auto both = detail::with_mirror_images(left, points, mirror);
  ASSERT_EQ(both.size(), 2u);
  const PointsD field = detail::correction(both, points);
  EXPECT_NEAR(field(0, 0), -field(1, 0), 1e-12);
  EXPECT_NEAR(field(0, 1), field(1, 1), 1e-12);
  EXPECT_NEAR(field(2, 0), 0, 1e-12);
  EXPECT_GT(field(0, 0), 0.017);
  const std::vector<detail::Residual> given{left[0], {1, points.row(1), {0, 0, 0}}};
  EXPECT_EQ(detail::with_mirror_images(given, points, mirror).size(), 2u);
  EXPECT_EQ(detail::correction({}, points), PointsD(PointsD::Zero(3, 3)));
}

TEST(FindLandmarks, ReliefOfAPlaneAndCorrelation) {
  const auto flat = grid(8);
  const mien::Surface plane{flat.positions, flat.triangles};
  EXPECT_LT(detail::relief(plane, vertex_normals(plane.positions, plane.triangles), 2).cwiseAbs().maxCoeff(),
            1e-12);
  const Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(5, 0, 1), ones = Eigen::VectorXd::Ones(5);
  EXPECT_NEAR(detail::correlation(a, 3 * a + ones, ones), 1, 1e-12);
  EXPECT_NEAR(detail::correlation(a, -a, ones), -1, 1e-12);
  EXPECT_EQ(detail::correlation(a, ones, ones), 0);
}

TEST(FindLandmarks, RealHeadsFromNone) {
  const std::filesystem::path data = MIEN_SHARED_DATA;
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no " << data;
  const std::vector<std::pair<const char*, const char*>> heads{
      {"facecap/facecap.glb", "landmarks/facecap.json"},
      {"mediapipe/canonical_face_model.obj", "landmarks/mediapipe.json"}};
  for (const auto& [mesh, marks] : heads) {
    Character head = load(data / mesh);
    const FoundLandmarks found = find_landmarks(head, made("human"));
    head.landmarks = read_landmarks(data / marks, head).landmarks;
    std::erase_if(head.landmarks, [](const Landmark& one) { return !one.name.starts_with("ibug_"); });
    EXPECT_EQ(found.verdict, Verdict::accept) << mesh;
    EXPECT_LT(mean_error(found, head, 18), 0.02) << mesh;
  }
}

}  // namespace
}  // namespace mien::test
