#include "mien/motion/retarget_sliders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "error_of.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Character face(const std::vector<std::string>& shapes) {
  Character character;
  for (const std::string& name : shapes) character.shapes.push_back({name, {}});
  complete_sliders(character);
  return character;
}

SliderTake take_of(const std::vector<std::string>& names, const Eigen::MatrixXd& values) {
  SliderTake take{names, {}, values};
  for (Eigen::Index f = 0; f < values.rows(); ++f) take.seconds.push_back(static_cast<double>(f) / 30);
  return take;
}

double value_at(const Character& character, const Clip& clip, const char* slider, double seconds) {
  return sample_rig(character, clip, seconds).sliders.values[find_slider(character, slider)];
}

TEST(retarget, bad_input_is_named) {
  const Character character = face({"jawOpen"});
  const SliderTake take = take_of({"JawOpen"}, Eigen::MatrixXd::Constant(3, 1, 0.5));
  RetargetOptions options;
  options.links = {{"Mouth", "jawOpen", 1}};
  EXPECT_THAT(error_of([&] { retarget(take, character, options); }),
              HasSubstr("link from Mouth: names no stream"));
  options.links = {{"JawOpen", "mouth", 1}};
  EXPECT_THAT(error_of([&] { retarget(take, character, options); }),
              HasSubstr("slider mouth: does not exist"));
  options = {};
  options.neutral_at = 9;
  EXPECT_THAT(error_of([&] { retarget(take, character, options); }), HasSubstr("neutral time: is 9"));
  options = {};
  options.gains["brow"] = 1;
  EXPECT_THAT(error_of([&] { retarget(take, character, options); }),
              HasSubstr("slider brow: does not exist"));
  EXPECT_THAT(error_of([&] { retarget(take, face({"nose"})); }),
              HasSubstr("has no stream that drives a slider"));
  EXPECT_THAT(error_of([&] { retarget(SliderTake{}, character); }), HasSubstr("take: has no frames"));
  const SliderTake broken = take_of({"JawOpen"}, Eigen::MatrixXd::Constant(3, 1, std::nan("")));
  EXPECT_THAT(error_of([&] { retarget(broken, character); }), HasSubstr("not finite"));
}

TEST(retarget, streams_drive_the_sliders_that_do_the_same) {
  const Character character = face({"jawOpen", "mouthSmile_L", "browInnerUp_L", "browInnerUp_R", "wink"});
  Eigen::MatrixXd values(2, 4);
  values << 0, 0, 0, 0, 0.5, 0.4, 0.3, 0.9;
  RetargetOptions options;
  options.smooth = 0;
  const RetargetResult result = retarget(
      take_of({"JawOpen", "MouthSmileLeft", "BrowInnerUp", "TongueOut"}, values), character, options);
  EXPECT_EQ(result.clip.channels.size(), 4u);
  const double end = 1.0 / 30;
  EXPECT_FLOAT_EQ(static_cast<float>(value_at(character, result.clip, "jawOpen", end)), 0.5f);
  EXPECT_FLOAT_EQ(static_cast<float>(value_at(character, result.clip, "mouthSmile_L", end)), 0.4f);
  EXPECT_FLOAT_EQ(static_cast<float>(value_at(character, result.clip, "browInnerUp_R", end)), 0.3f);
  EXPECT_THAT(result.unmapped, ElementsAre("TongueOut"));
  EXPECT_THAT(result.still, ElementsAre("wink"));
}

TEST(retarget, a_slider_for_both_sides_takes_their_mean) {
  const Character character = face({"mouthSmile"});
  RetargetOptions options;
  options.smooth = 0;
  const SliderTake take = take_of({"mouthSmileLeft", "mouthSmileRight"}, Eigen::RowVector2d(0.2, 0.6));
  EXPECT_NEAR(value_at(character, retarget(take, character, options).clip, "mouthSmile", 0), 0.4, 1e-7);
}

TEST(retarget, values_stay_in_range_unless_told) {
  const Character character = face({"jawOpen"});
  const SliderTake take = take_of({"jawOpen"}, Eigen::Vector2d(1.3, -0.2));
  RetargetOptions options;
  options.smooth = 0;
  Clip clip = retarget(take, character, options).clip;
  EXPECT_EQ(clip.channels[0].values, (std::vector<float>{1, 0}));
  options.overdrive = true;
  options.gains["jawOpen"] = 2;
  clip = retarget(take, character, options).clip;
  EXPECT_EQ(clip.channels[0].values, (std::vector<float>{2.6f, -0.4f}));
}

TEST(retarget, calibration_makes_the_neutral_zero_and_keeps_the_full) {
  const Character character = face({"jawOpen"});
  const SliderTake take = take_of({"jawOpen"}, Eigen::Vector3d(0.2, 0.6, 1));
  RetargetOptions options;
  options.smooth = 0;
  options.neutral_at = 0;
  const std::vector<float> values = retarget(take, character, options).clip.channels[0].values;
  EXPECT_NEAR(values[0], 0, 1e-7);
  EXPECT_NEAR(values[1], 0.5, 1e-7);
  EXPECT_NEAR(values[2], 1, 1e-7);
}

TEST(retarget, a_head_joint_turns_about_the_models_axes) {
  Character character = face({"jawOpen"});
  Node root, head;
  root.name = "root";
  root.rest.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  head.name = "Head";
  head.parent = 0;
  head.rest.rotation = Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitX());
  character.nodes = {root, head};
  character.skins.resize(1);
  character.skins[0].joints = {1};
  const SliderTake take = take_of({"jawOpen", "HeadYaw"}, Eigen::RowVector2d(0, std::numbers::pi / 2));
  RetargetOptions options;
  const Clip clip = retarget(take, character, options).clip;
  const Eigen::Matrix4d rest = model_matrices(character)[1];
  const Eigen::Matrix4d turned = model_matrices(character, sample_clip(character, clip, 0))[1];
  const Eigen::Matrix3d turn = turned.topLeftCorner<3, 3>() * rest.topLeftCorner<3, 3>().transpose();
  EXPECT_LT((turn * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-6);
  options.joints = false;
  EXPECT_EQ(retarget(take, character, options).clip.channels.size(), 1u);
}

TEST(smooth_stream, calms_noise_and_keeps_blinks) {
  const int frames = 300;
  Eigen::VectorXd noisy(frames), clean(frames);
  std::vector<double> seconds;
  unsigned state = 1;
  for (int f = 0; f < frames; ++f) {
    seconds.push_back(f / 60.0);
    state = state * 1664525u + 1013904223u;
    const double noise = 0.01 * (static_cast<double>(state >> 8) / (1 << 24) - 0.5);
    clean[f] = f >= 150 && f < 159 ? 1 : 0.1;
    noisy[f] = clean[f] + noise;
  }
  const Eigen::VectorXd smooth = smooth_stream(noisy, seconds, 0.05, 0.1);
  EXPECT_GT(smooth.maxCoeff(), 0.99) << "the blink's peak";
  EXPECT_LT((smooth - clean).norm(), 0.6 * (noisy - clean).norm());
  EXPECT_EQ(smooth_stream(noisy, seconds, 0, 0.1), noisy);
  const Eigen::VectorXd reversed = smooth_stream(noisy.reverse(), seconds, 0.05, 0.1).reverse();
  EXPECT_LT((reversed - smooth).cwiseAbs().maxCoeff(), 1e-12) << "nothing lags";
}

}  // namespace
}  // namespace mien
