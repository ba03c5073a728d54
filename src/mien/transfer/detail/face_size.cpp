#include "mien/transfer/detail/face_size.h"

#include <algorithm>

namespace mien::detail {

double face_size(const PointsD& landmarks, const PointsD& skin) {
  const auto diagonal = [](const PointsD& p) {
    return (p.colwise().maxCoeff() - p.colwise().minCoeff()).norm();
  };
  return std::clamp(diagonal(landmarks), 0.35 * diagonal(skin), diagonal(skin));
}

}  // namespace mien::detail
