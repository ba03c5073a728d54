#include "mien/picture/matrix_plot.h"

#include <gtest/gtest.h>

#include "mien/core/error.h"

namespace mien {
namespace {

TEST(MatrixPlot, colours_its_cells) {
  Eigen::MatrixXd values(2, 2);
  values << 0, 1, 1, 0;
  MatrixPlotOptions options;
  options.cell = 4;
  const Picture picture = matrix_plot({"a", "b"}, values, options);
  EXPECT_EQ(picture.width, 28);
  const auto at = [&](int x, int y) {
    return picture.rgba[4 * (static_cast<std::size_t>(y) * picture.width + x)];
  };
  const Color low = map_color(ColorMap::heat, 0), high = map_color(ColorMap::heat, 1);
  EXPECT_NEAR(at(12, 12), 255 * low.r, 1);
  EXPECT_NEAR(at(16, 12), 255 * high.r, 1);
  EXPECT_THROW(matrix_plot({"a"}, values), Error);
  EXPECT_THROW(matrix_plot({}, Eigen::MatrixXd(0, 0)), Error);
}

}  // namespace
}  // namespace mien
