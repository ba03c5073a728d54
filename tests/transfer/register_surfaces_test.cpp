#include "mien/transfer/register_surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "mien/geometry/surface_query.h"
#include "mien/transfer/thesis.h"
#include "transfer/faces.h"

namespace mien::test {
namespace {

using ::testing::HasSubstr;

/// A bumpy hill with landmarks on it.
struct Hill {
  mien::Surface surface;
  PointsD landmarks;
  explicit Hill(double height) {
    const auto g = grid(30);
    surface = {g.positions / 30, g.triangles};
    for (Eigen::Index v = 0; v < surface.positions.rows(); ++v) {
      const double x = surface.positions(v, 0), y = surface.positions(v, 1);
      surface.positions(v, 2) = height * std::sin(3 * x) * std::cos(2 * y + 0.3);
    }
    const std::vector<int> places{62, 88, 200, 480, 500, 850, 870, 910};
    landmarks = surface.positions(places, Eigen::all);
  }
};

double worst(const PointsD& a, const PointsD& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

Eigen::Vector3d normal(const PointsD& p, const Triangles& triangles, Eigen::Index t) {
  const Eigen::Vector3d a = p.row(triangles(t, 0)), b = p.row(triangles(t, 1)), c = p.row(triangles(t, 2));
  return (b - a).cross(c - a);
}

TEST(register_surfaces, invalid_input_is_named) {
  const Hill hill(0.3);
  const auto failure = [&](const mien::Surface& source, const mien::Surface& target, const PointsD& from,
                           const PointsD& to) {
    return invalid_input_of([&] { register_surfaces(source, target, from, to); });
  };
  EXPECT_EQ(failure(hill.surface, hill.surface, hill.landmarks, hill.landmarks.topRows(5)),
            "similarity: point sets of different sizes; as many points on both sides");
  EXPECT_EQ(failure(hill.surface, hill.surface, hill.landmarks.topRows(2), hill.landmarks.topRows(2)),
            "similarity: fewer than 3 point pairs; 3 or more");
  PointsD flat = hill.landmarks;
  flat.col(2).setZero();
  EXPECT_THAT(failure(hill.surface, hill.surface, flat, hill.landmarks), HasSubstr("plane"));
  const mien::Surface none{hill.surface.positions, Triangles(0, 3)};
  EXPECT_THAT(failure(none, hill.surface, hill.landmarks, hill.landmarks), HasSubstr("triangles"));
  EXPECT_THAT(failure(hill.surface, none, hill.landmarks, hill.landmarks), HasSubstr("triangles"));
  RegistrationOptions options;
  options.landmark_trust = Eigen::VectorXd::Ones(3);
  EXPECT_EQ(invalid_input_of([&] {
              register_surfaces(hill.surface, hill.surface, hill.landmarks, hill.landmarks, options);
            }),
            "landmark trust: has 3 numbers; one a landmark (8), or none");
}

/// Landmarks half a percent off, on surfaces that are the same: what holds them keeps their error, what does not loses it.
TEST(register_surfaces, landmarks_without_trust_are_the_start_alone) {
  const Hill hill(0.3);
  PointsD off = hill.landmarks;
  for (Eigen::Index i = 0; i < off.rows(); ++i)
    off.row(i) += Eigen::RowVector3d(i % 2 ? 0.008 : -0.008, 0, 0);
  RegistrationOptions start_alone;
  start_alone.landmark_trust = Eigen::VectorXd::Zero(off.rows());
  start_alone.landmarks_hold = false;
  const auto error = [&](const RegistrationOptions& options) {
    const Registration found = register_surfaces(hill.surface, hill.surface, hill.landmarks, off, options);
    return (found.guide - hill.surface.positions).rowwise().norm().mean();
  };
  EXPECT_LT(error(start_alone), 0.7 * error({}));
}

TEST(register_surfaces, equal_surfaces_are_left_where_they_are) {
  const Hill hill(0.3);
  const Registration r = register_surfaces(hill.surface, hill.surface, hill.landmarks, hill.landmarks);
  EXPECT_LT(worst(r.guide, hill.surface.positions), 1e-3 * r.unit);
  EXPECT_NEAR(r.similarity.scale, 1, 1e-9);
}

TEST(register_surfaces, the_guide_lies_on_the_target) {
  const Hill low(0.2), high(0.4);
  const Registration r = register_surfaces(low.surface, high.surface, low.landmarks, high.landmarks);
  // Vertices of the same place differ in height alone; the guide has to come up to them.
  const Eigen::VectorXd off = (r.guide.col(2) - high.surface.positions.col(2)).cwiseAbs();
  EXPECT_LT(off.mean(), 0.01 * r.unit);
}

TEST(register_surfaces, progress_can_cancel) {
  const Hill hill(0.3);
  RegistrationOptions options;
  int calls = 0;
  options.progress = [&](std::string_view, double) { return ++calls < 3; };
  try {
    register_surfaces(hill.surface, hill.surface, hill.landmarks, hill.landmarks, options);
    FAIL() << "did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::cancelled);
  }
  EXPECT_EQ(calls, 3);
}

/// Largest and mean distance of rows.
std::pair<double, double> apart(const PointsD& a, const PointsD& b) {
  const Eigen::VectorXd distance = (a - b).rowwise().norm();
  return {distance.maxCoeff(), distance.mean()};
}

TEST(register_surfaces, heads_commute_with_similarities_of_either_side) {
  const FaceSkin human = skin_of(made("human")), cartoon = skin_of(made("cartoon"));
  const PointsD from = landmark_positions(made("human")), to = landmark_positions(made("cartoon"));
  const Registration plain = register_surfaces(human.surface, cartoon.surface, from, to);
  // Powers of two change no digit. Others do, and rays for openness do not turn about the normals: a ray here and there
  // meets something else, which moves a few vertices.
  for (const Similarity& turn :
       {Similarity{64, Eigen::Matrix3d::Identity(), {0, 0, 0}}, some_similarity(60)}) {
    const bool rounded = !turn.rotation.isIdentity();
    const double worst_off = rounded ? 0.05 : 1e-9, mean_off = rounded ? 1e-3 : 1e-9;
    const Registration source = register_surfaces({turn(human.surface.positions), human.surface.triangles},
                                                  cartoon.surface, turn(from), to);
    const auto [source_worst, source_mean] = apart(source.guide, plain.guide);
    EXPECT_LT(source_worst, worst_off * plain.unit) << rounded;
    EXPECT_LT(source_mean, mean_off * plain.unit) << rounded;
    const Registration target = register_surfaces(
        human.surface, {turn(cartoon.surface.positions), cartoon.surface.triangles}, from, turn(to));
    EXPECT_NEAR(target.unit, turn.scale * plain.unit, 1e-9 * target.unit);
    const auto [target_worst, target_mean] = apart(target.guide, turn(plain.guide));
    EXPECT_LT(target_worst, worst_off * target.unit) << rounded;
    EXPECT_LT(target_mean, mean_off * target.unit) << rounded;
  }
}

TEST(register_surfaces, a_human_on_a_cartoon_hardly_turns_over_and_keeps_its_lips_apart) {
  const Character& source = made("human");
  const FaceSkin human = skin_of(source), cartoon = skin_of(made("cartoon"));
  const Registration r = register_surfaces(human.surface, cartoon.surface, landmark_positions(source),
                                           landmark_positions(made("cartoon")));
  ASSERT_TRUE(r.guide.allFinite());
  const PointsD aligned = r.similarity(human.surface.positions);
  const Triangles& triangles = human.surface.triangles;
  int skin_flips = 0, flips = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    if (normal(r.guide, triangles, t).dot(normal(aligned, triangles, t)) > 0) continue;
    ++flips;
    skin_flips += r.source_openness(triangles.row(t).transpose().eval(), 0).minCoeff() > 0.4;
  }
  // Against the source's own direction: a few at the lids' inner margins, in nostrils and behind the ears.
  EXPECT_LE(skin_flips, 8);
  EXPECT_LE(flips, triangles.rows() / 300);
  // Inner lips, left to right: the upper one stays above the lower one.
  for (const auto& [upper, lower] : std::vector<std::pair<int, int>>{{62, 68}, {63, 67}, {64, 66}}) {
    const int a = human.row_of[landmark_vertex(source, upper)];
    const int b = human.row_of[landmark_vertex(source, lower)];
    const Eigen::RowVector3d before = aligned.row(a) - aligned.row(b);
    EXPECT_GT((r.guide.row(a) - r.guide.row(b)).dot(before.normalized()), 0.3 * before.norm()) << upper;
  }
}

TEST(thesis_registration, lies_on_the_target) {
  const Hill low(0.2), high(0.4);
  const Registration r = thesis_registration(low.surface, high.surface, low.landmarks, high.landmarks);
  const SurfaceQuery target(high.surface.positions, high.surface.triangles);
  for (Eigen::Index v = 0; v < r.guide.rows(); ++v)
    EXPECT_LT(target.closest(r.guide.row(v).transpose()).distance, 1e-6);
}

}  // namespace
}  // namespace mien::test
