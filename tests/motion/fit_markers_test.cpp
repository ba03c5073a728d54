#include "mien/motion/fit_markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "error_of.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/point_evaluator.h"
#include "mien/sample/sample.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

const Character& human() {
  static const Character character = make_sample("human");
  return character;
}

/// What markers on the human's landmarks would record of `pose_at(frame)`, its head nodding, in another unit.
MarkerTake record(int frames, const std::function<SliderValues(int)>& pose_at) {
  MarkerTake take;
  std::vector<SurfacePoint> points;
  for (const Landmark& landmark : human().landmarks) {
    take.names.push_back(landmark.name);
    points.push_back(landmark.at);
  }
  PointEvaluator evaluator(human(), points);
  for (int f = 0; f < frames; ++f) {
    RigPose rig = rest_rig_pose(human());
    rig.sliders = pose_at(f);
    PointsD positions;
    evaluator.positions(rig, positions);
    const Eigen::AngleAxisd nod(0.02 * f, Eigen::Vector3d(1, 0.3, -0.2).normalized());
    const Eigen::Vector3d shift(0.01 * f, -0.02 * f, 5);
    positions = 250 * ((positions * nod.toRotationMatrix().transpose()).rowwise() + shift.transpose());
    take.positions.push_back(positions);
    take.seen.emplace_back(points.size(), 1);
    take.seconds.push_back(f / 60.0);
  }
  return take;
}

SliderValues talking(int frame) {
  SliderValues sliders = rest_sliders(human());
  sliders.values[find_slider(human(), "jawOpen")] = 0.3 * (1 - std::cos(0.2 * frame));
  sliders.values[find_slider(human(), "mouthSmileLeft")] = 0.025 * frame;
  return sliders;
}

TEST(fit_markers, bad_input_is_named) {
  const MarkerTake take = record(3, talking);
  FitMarkersOptions options;
  options.landmarks = {{"noseTip", "snout"}};
  MarkerTake named = take;
  named.names[0] = "noseTip";
  EXPECT_THAT(error_of([&] { fit_markers(named, human(), options); }),
              HasSubstr("landmark snout: does not exist"));
  MarkerTake strange = take;
  for (std::string& name : strange.names) name = "marker_" + name;
  EXPECT_THAT(error_of([&] { fit_markers(strange, human()); }),
              HasSubstr("markers: 0 have a landmark of their name"));
  options = {};
  options.neutral_at = 7;
  EXPECT_THAT(error_of([&] { fit_markers(take, human(), options); }), HasSubstr("neutral time: is 7"));
  MarkerTake hidden = take;
  hidden.seen[0][4] = 0;
  EXPECT_THAT(error_of([&] { fit_markers(hidden, human()); }), HasSubstr("is not seen at the neutral time"));
  hidden = take;
  hidden.seen[2].assign(hidden.names.size(), 0);
  EXPECT_THAT(error_of([&] { fit_markers(hidden, human()); }), HasSubstr("frame 2: shows 0 markers"));
  EXPECT_THAT(error_of([&] { fit_markers(MarkerTake{}, human()); }), HasSubstr("take: has no frames"));
}

TEST(fit_markers, a_recorded_performance_comes_back_without_the_heads_motion) {
  const int frames = 24;
  FitMarkersOptions options;
  options.rho = 1e-5;
  options.smooth = 0;
  const FitMarkersResult result = fit_markers(record(frames, talking), human(), options);
  EXPECT_NEAR(result.scale * 250, 1, 1e-6);
  EXPECT_LT(result.residual, 0.08);
  std::vector<SurfacePoint> points;
  for (const Landmark& landmark : human().landmarks) points.push_back(landmark.at);
  PointEvaluator evaluator(human(), points);
  double miss = 0, motion = 0;
  for (int f = 0; f < frames; ++f) {
    RigPose rig = rest_rig_pose(human());
    PointsD rest, wanted, got;
    evaluator.positions(rig, rest);
    rig.sliders = talking(f);
    evaluator.positions(rig, wanted);
    evaluator.positions(sample_rig(human(), result.clip, f / 60.0), got);
    miss += (got - wanted).squaredNorm();
    motion += (wanted - rest).squaredNorm();
  }
  EXPECT_LT(std::sqrt(miss / motion), 0.08);
}

TEST(fit_markers, gaps_are_bridged_or_left_out) {
  MarkerTake take = record(24, talking);
  const FitMarkersResult whole = fit_markers(take, human());
  for (int f = 5; f < 9; ++f) {
    take.seen[static_cast<std::size_t>(f)][20] = 0;
    take.positions[static_cast<std::size_t>(f)].row(20).setConstant(1e6);
  }
  for (std::size_t f = 10; f < 24; ++f) take.seen[f][3] = 0;
  const FitMarkersResult result = fit_markers(take, human());
  ASSERT_FALSE(result.clip.channels.empty());
  const SliderValues a = sample_rig(human(), whole.clip, 7 / 60.0).sliders;
  const SliderValues b = sample_rig(human(), result.clip, 7 / 60.0).sliders;
  EXPECT_LT((a.values - b.values).cwiseAbs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace mien
