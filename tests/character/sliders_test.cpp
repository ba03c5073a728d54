#include "mien/character/sliders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "error_of.h"
#include "mien/core/error.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

/// Shapes a (half smile), b (smile), c (frown), d (open), e (b and d together), f (b, c- and d).
Character rig(CorrectiveRule rule = CorrectiveRule::product) {
  Character character;
  for (const char* name : {"a", "b", "c", "d", "e"}) character.shapes.push_back({name, {}});
  character.sliders = {{"smile", -1, 1.5, 0, {{-1, 2}, {0.5, 0}, {1, 1}}}, {"open", 0, 1, 0, {{2, 3}}}};
  character.correctives = {{4, rule, {{0, 1}, {1, 2}}}};
  return character;
}

Eigen::VectorXd weights_at(const Character& character, double smile, double open) {
  return shape_weights(character, SliderValues(Eigen::Vector2d(smile, open))).values;
}

Eigen::VectorXd five(double a, double b, double c, double d, double e) {
  Eigen::VectorXd values(5);
  values << a, b, c, d, e;
  return values;
}

TEST(shape_weights, wrong_values_are_named) {
  const Character character = rig();
  EXPECT_EQ(error_of([&] { shape_weights(character, SliderValues(3u)); }),
            "slider values: are 3; the character has 2 sliders");
  EXPECT_EQ(error_of([&] { weights_at(character, 0, std::numeric_limits<double>::quiet_NaN()); }),
            "slider open: is not finite; give a finite number");
  Character broken = rig();
  broken.sliders[1].stops[0].shape = 9;
  EXPECT_THAT(error_of([&] { weights_at(broken, 0, 0); }),
              HasSubstr("slider open: names shape 9; there are 5"));
  broken = rig();
  broken.correctives[0].inputs[0].slider = 2;
  EXPECT_THAT(error_of([&] { weights_at(broken, 0, 0); }),
              HasSubstr("corrective: names slider 2; there are 2"));
  EXPECT_THAT(error_of([&] {
                apply_expression(character, {"o", {{7, 1}}}, SliderValues(2u));
              }),
              HasSubstr("expression o: names slider 7; there are 2"));
}

TEST(shape_weights, a_stop_shows_its_shape_in_full_and_zero_the_neutral) {
  const Character character = rig();
  EXPECT_EQ(weights_at(character, 0, 0), five(0, 0, 0, 0, 0));
  EXPECT_EQ(weights_at(character, 0.5, 0), five(1, 0, 0, 0, 0));
  EXPECT_EQ(weights_at(character, 1, 0), five(0, 1, 0, 0, 0));
  EXPECT_EQ(weights_at(character, -1, 0), five(0, 0, 1, 0, 0));
  EXPECT_EQ(weights_at(character, 0, 2), five(0, 0, 0, 1, 0));
}

TEST(shape_weights, are_linear_between_stops_and_go_on_beyond_them) {
  const Character character = rig();
  EXPECT_EQ(weights_at(character, 0.25, 0), five(0.5, 0, 0, 0, 0));
  EXPECT_EQ(weights_at(character, 0.75, 0), five(0.5, 0.5, 0, 0, 0));
  EXPECT_EQ(weights_at(character, 1.5, 0), five(-1, 2, 0, 0, 0));
  EXPECT_EQ(weights_at(character, -0.5, -1), five(0, 0, 0.5, -0.5, 0));
  EXPECT_EQ(weights_at(character, -2, 0), five(0, 0, 2, 0, 0));
}

TEST(shape_weights, a_corrective_is_full_when_all_inputs_are_and_silent_when_one_is_not_up) {
  for (const auto rule : {CorrectiveRule::product, CorrectiveRule::smallest, CorrectiveRule::smooth}) {
    const Character character = rig(rule);
    EXPECT_DOUBLE_EQ(weights_at(character, 1, 2)[4], 1);
    EXPECT_EQ(weights_at(character, 1, 0)[4], 0);
    EXPECT_EQ(weights_at(character, -1, 2)[4], 0);
    EXPECT_NEAR(weights_at(character, 0.3, 2)[4], 0.3, 1e-15);
  }
}

TEST(shape_weights, the_rules_are_product_least_and_between_them) {
  EXPECT_DOUBLE_EQ(weights_at(rig(CorrectiveRule::product), 0.5, 1.2)[4], 0.3);
  EXPECT_DOUBLE_EQ(weights_at(rig(CorrectiveRule::smallest), 0.5, 1.2)[4], 0.5);
  const double smooth = weights_at(rig(CorrectiveRule::smooth), 0.5, 1.2)[4];
  EXPECT_DOUBLE_EQ(smooth, 1 / std::sqrt(1 / 0.25 + 1 / 0.36 - 1));
  EXPECT_GT(smooth, 0.3);
  EXPECT_LT(smooth, 0.5);
  EXPECT_DOUBLE_EQ(weights_at(rig(CorrectiveRule::product), 1.5, 4)[4], 3);
  EXPECT_DOUBLE_EQ(weights_at(rig(CorrectiveRule::smallest), 1.5, 4)[4], 1.5);
  EXPECT_DOUBLE_EQ(weights_at(rig(CorrectiveRule::smooth), 1.5, 3)[4], 1.5);
}

TEST(shape_weight_slopes, agree_with_central_differences) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1.4, 1.9);
  for (const auto rule : {CorrectiveRule::product, CorrectiveRule::smallest, CorrectiveRule::smooth}) {
    const Character character = rig(rule);
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Vector2d at(value(random), 2 * value(random));
      const Eigen::MatrixXd slopes = shape_weight_slopes(character, SliderValues(at));
      const double step = 1e-6;
      for (int s = 0; s < 2; ++s) {
        const Eigen::Vector2d along = Eigen::Vector2d::Unit(s) * step;
        const Eigen::VectorXd difference = (shape_weights(character, SliderValues(at + along)).values -
                                            shape_weights(character, SliderValues(at - along)).values) /
                                           (2 * step);
        EXPECT_LT((difference - slopes.col(s)).cwiseAbs().maxCoeff(), 1e-5) << at.transpose();
      }
    }
  }
}

TEST(shape_weight_slopes, look_to_the_firing_side_at_rest) {
  for (const auto rule : {CorrectiveRule::product, CorrectiveRule::smallest, CorrectiveRule::smooth}) {
    const Eigen::MatrixXd slopes = shape_weight_slopes(rig(rule), SliderValues(Eigen::Vector2d(0, 2)));
    EXPECT_DOUBLE_EQ(slopes(4, 0), 1);
    EXPECT_EQ(slopes(4, 1), 0);
    EXPECT_EQ(slopes(0, 0), 2) << "the slope upwards: towards the stop at one half";
  }
}

TEST(expressions, take_their_sliders_along_and_leave_the_others) {
  const Character character = rig();
  const SliderValues start(Eigen::Vector2d(0.2, 0.4));
  const Expression grin{"grin", {{0, 1}}};
  EXPECT_EQ(apply_expression(character, grin, start).values, Eigen::Vector2d(1, 0.4));
  EXPECT_EQ(apply_expression(character, grin, start, 0).values, start.values);
  EXPECT_DOUBLE_EQ(apply_expression(character, grin, start, 0.5).values[0], 0.6);
}

TEST(complete_sliders, every_shape_that_nothing_drives_gets_one_of_its_name) {
  Character character = rig();
  character.shapes.push_back({"blink", {}});
  character.shapes.push_back({"open", {}});
  complete_sliders(character);
  ASSERT_EQ(character.sliders.size(), 4u);
  EXPECT_EQ(character.sliders[2], (Slider{"blink", 0, 1, 0, {{1, 5}}}));
  EXPECT_EQ(character.sliders[3].name, "open_shape");
  complete_sliders(character);
  EXPECT_EQ(character.sliders.size(), 4u);
}

TEST(rest_pose, is_what_the_sliders_at_rest_show) {
  Character character = rig();
  character.sliders[0].rest = 0.75;
  EXPECT_EQ(rest_pose(character).shape_weights.values, five(0.5, 0.5, 0, 0, 0));
}

}  // namespace
}  // namespace mien
