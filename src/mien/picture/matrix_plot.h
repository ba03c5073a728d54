#pragma once
/// A matrix as coloured cells with named rows and columns.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mien/picture/color_map.h"
#include "mien/picture/picture.h"

namespace mien {

struct MatrixPlotOptions {
  std::string title;
  ColorMap colors = ColorMap::heat;
  double low = 0, high = 1;  ///< the values at the two ends of the colours
  int cell = 14;             ///< pixels; names are left out below 8
};

///   names   #n, of rows and columns; values #n x #n
///   throws  invalid_input: no rows, another number of names, a side above `max_picture_side`
Picture matrix_plot(const std::vector<std::string>& names, const Eigen::MatrixXd& values,
                    const MatrixPlotOptions& options = {});

}  // namespace mien
