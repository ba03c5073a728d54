#include "mien/pose/detail/slider_map.h"

#include <gtest/gtest.h>

#include "pose/small_face.h"

namespace mien {
namespace {

TEST(SliderMap, says_what_shape_weights_and_their_slopes_say) {
  Character face = test::small_face(9);
  test::add_correctives(face, 20);
  face.sliders[3].stops = {{-1, 3}, {0.3, 4}, {1, 5}};
  detail::SliderMap map(face);
  EXPECT_FALSE(map.linear());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.5, 1.5);
  for (int trial = 0; trial < 200; ++trial) {
    SliderValues sliders(face.sliders.size());
    for (double& value : sliders.values)
      value = trial % 4 == 0 ? std::round(uniform(random)) : uniform(random);
    Eigen::VectorXd weights(static_cast<Eigen::Index>(face.shapes.size()));
    map.weights(sliders.values, weights);
    EXPECT_LT((weights - shape_weights(face, sliders).values).cwiseAbs().maxCoeff(), 1e-14);
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(weights.size(), sliders.values.size());
    for (const auto& slope : map.slopes(sliders.values)) slopes(slope.shape, slope.slider) += slope.value;
    EXPECT_LT((slopes - shape_weight_slopes(face, sliders)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(SliderMap, plain_sliders_are_linear) {
  EXPECT_TRUE(detail::SliderMap(test::small_face(5)).linear());
}

}  // namespace
}  // namespace mien
