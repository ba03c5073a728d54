#include "mien/io/detail/rows_json.h"

namespace mien::detail {

Json rows_json(const PointsD& rows) {
  Json json = Json::array();
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    for (int k = 0; k < 3; ++k) json.push_back(rows(r, k));
  return json;
}

PointsD rows_of(const std::vector<double>& numbers) {
  PointsD rows(static_cast<Eigen::Index>(numbers.size() / 3), 3);
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    for (int k = 0; k < 3; ++k) rows(r, k) = numbers[static_cast<std::size_t>(3 * r + k)];
  return rows;
}

}  // namespace mien::detail
