// Vertices are taken in blocks: within a block only the shapes that move it are multiplied, as one small dense product.
#include "mien/pose/detail/gram.h"

#include <algorithm>
#include <vector>

#include "mien/core/parallel.h"
#include "mien/evaluate/point_evaluator.h"
#include "mien/pose/detail/dense_kernels.h"

namespace mien::detail {
namespace {

constexpr int block_rows = 3 * 256;
constexpr std::size_t chunk_vertices = 4096;

/// Adds rows' rows for `rows` (few x #S).
void add_block(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::MatrixXd& sum) {
  std::vector<Eigen::Index> active;
  for (Eigen::Index s = 0; s < rows.cols(); ++s)
    if (!rows.col(s).isZero(0)) active.push_back(s);
  const int count = static_cast<int>(active.size());
  const int stride = static_cast<int>((rows.rows() + 7) / 8 * 8);
  std::vector<double> packed(static_cast<std::size_t>(count) * stride, 0.0),
      lower(static_cast<std::size_t>(count) * count);
  for (int i = 0; i < count; ++i)
    std::copy_n(rows.col(active[i]).data(), rows.rows(),
                packed.data() + static_cast<std::size_t>(i) * stride);
  dense_kernels().multiply_by_transpose(packed.data(), count, stride, lower.data(), count);
  for (int c = 0; c < count; ++c)
    for (int r = c; r < count; ++r)
      sum(active[r], active[c]) += lower[static_cast<std::size_t>(c) * count + r];
}

}  // namespace

Eigen::MatrixXd shape_products(const Character& character, const Pose& pose) {
  std::vector<SurfacePoint> vertices;
  for (std::size_t p = 0; p < character.parts.size(); ++p)
    for (std::size_t v = 0; v < character.parts[p].mesh.vertex_count(); ++v) {
      SurfacePoint point;
      point.part = static_cast<int>(p);
      point.vertex = static_cast<int>(v);
      vertices.push_back(point);
    }
  const auto shapes = static_cast<Eigen::Index>(character.shapes.size());
  const std::size_t chunks = (vertices.size() + chunk_vertices - 1) / chunk_vertices;
  std::vector<Eigen::MatrixXd> sums(chunks, Eigen::MatrixXd::Zero(shapes, shapes));
  parallel_for(chunks, 1, [&](std::size_t begin, std::size_t end) {
    Eigen::MatrixXd rows;
    for (std::size_t c = begin; c < end; ++c) {
      const auto from = vertices.begin() + static_cast<std::ptrdiff_t>(c * chunk_vertices);
      const auto to =
          vertices.begin() + static_cast<std::ptrdiff_t>(std::min(vertices.size(), (c + 1) * chunk_vertices));
      PointEvaluator(character, {from, to}).shape_rows(pose, rows);
      for (Eigen::Index r = 0; r < rows.rows(); r += block_rows)
        add_block(rows.middleRows(r, std::min<Eigen::Index>(block_rows, rows.rows() - r)), sums[c]);
    }
  });
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(shapes, shapes);
  for (const Eigen::MatrixXd& sum : sums) products += sum;
  products.triangularView<Eigen::StrictlyUpper>() = products.transpose();
  return products;
}

}  // namespace mien::detail
