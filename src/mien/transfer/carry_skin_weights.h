#pragma once
/// Skin weights carried along the correspondence.

#include <Eigen/Sparse>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// Skin weights as a matrix, #V x #J, rows sum to one (or to zero where a vertex has none).
using WeightMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Limits every row to its `max_influences` largest (0: no limit), drops shares below `least`, divides by the sum.
/// Equal shares: the lower joint stays. A row that loses everything keeps its largest.
WeightMatrix limit_influences(const WeightMatrix& weights, int max_influences, double least = 5e-4);

/// Rows of a matrix in a part's vertex order: `row_of[v]` is the row of vertex v, -1 for none.
SkinWeights to_skin_weights(const WeightMatrix& weights, const std::vector<int>& row_of);

}  // namespace mien
