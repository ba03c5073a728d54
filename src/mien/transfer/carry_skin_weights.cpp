#include "mien/transfer/carry_skin_weights.h"

#include <algorithm>

namespace mien {

WeightMatrix limit_influences(const WeightMatrix& weights, int max_influences, double least) {
  std::vector<Eigen::Triplet<double>> kept;
  kept.reserve(static_cast<std::size_t>(weights.nonZeros()));
  std::vector<std::pair<double, int>> row;
  for (Eigen::Index v = 0; v < weights.outerSize(); ++v) {
    row.clear();
    for (WeightMatrix::InnerIterator entry(weights, v); entry; ++entry)
      if (entry.value() > 0) row.emplace_back(-entry.value(), static_cast<int>(entry.col()));
    if (row.empty()) continue;
    std::sort(row.begin(), row.end());
    std::size_t count = 1;
    double sum = -row[0].first;
    while (count < row.size() && -row[count].first >= least &&
           (max_influences <= 0 || count < static_cast<std::size_t>(max_influences)))
      sum -= row[count++].first;
    for (std::size_t k = 0; k < count; ++k)
      kept.emplace_back(static_cast<int>(v), row[k].second, -row[k].first / sum);
  }
  WeightMatrix result(weights.rows(), weights.cols());
  result.setFromTriplets(kept.begin(), kept.end());
  return result;
}

SkinWeights to_skin_weights(const WeightMatrix& weights, const std::vector<int>& row_of) {
  SkinWeights result;
  result.offsets.push_back(0);
  for (const int row : row_of) {
    if (row >= 0)
      for (WeightMatrix::InnerIterator entry(weights, row); entry; ++entry) {
        result.joints.push_back(static_cast<int>(entry.col()));
        result.weights.push_back(static_cast<float>(entry.value()));
      }
    result.offsets.push_back(static_cast<int>(result.joints.size()));
  }
  return result;
}

}  // namespace mien
