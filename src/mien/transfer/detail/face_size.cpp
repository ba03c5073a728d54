#include "mien/transfer/detail/face_size.h"

#include <algorithm>
#include <cmath>

namespace mien::detail {

double face_size(const PointsD& landmarks, const PointsD& skin) {
  const double skin_diagonal = bounding_box(skin).diagonal();
  const double spread =
      std::sqrt((landmarks.rowwise() - landmarks.colwise().mean()).rowwise().squaredNorm().mean());
  return std::clamp(3.6 * spread, 0.35 * skin_diagonal, skin_diagonal);
}

}  // namespace mien::detail
