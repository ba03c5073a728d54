#pragma once
/// What an evaluator makes of a pose, and how far two results are apart.

#include <cmath>
#include <cstring>
#include <vector>

#include "mien/character/pose.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/evaluator.h"

namespace mien::test {

inline constexpr InstructionSet all_sets[] = {InstructionSet::plain, InstructionSet::avx2,
                                              InstructionSet::avx512};

inline std::vector<float> evaluated(Evaluator& evaluator, const Pose& pose) {
  std::vector<float> positions(3 * evaluator.vertex_count(), NAN);
  evaluator.evaluate(pose, positions);
  return positions;
}

inline std::vector<float> joined(const std::vector<Points>& parts) {
  std::vector<float> all;
  for (const Points& part : parts) all.insert(all.end(), part.data(), part.data() + part.size());
  return all;
}

inline double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double most = a.size() == b.size() ? 0 : 1e30;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
    most = std::max<double>(most, std::abs(a[i] - b[i]));
  return most;
}

inline bool same_bytes(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
}

/// The largest coordinate posed or of a node, one more for neutral ones, which are below one in random rigs.
inline double reach(const Character& character, const Pose& pose) {
  double most = 0;
  for (const float x : joined(evaluate(character, pose))) most = std::max<double>(most, std::abs(x));
  for (const Eigen::Matrix4d& matrix : model_matrices(character, pose))
    most = std::max(most, matrix.topRightCorner<3, 1>().cwiseAbs().maxCoeff());
  return most + 1;
}

inline std::vector<SurfacePoint> all_vertices(const Character& character) {
  std::vector<SurfacePoint> all;
  for (std::size_t p = 0; p < character.parts.size(); ++p)
    for (int v = 0; v < static_cast<int>(character.parts[p].mesh.vertex_count()); ++v)
      all.push_back({static_cast<int>(p), -1, v, {1, 0, 0}, {0, 1, 2}});
  return all;
}

}  // namespace mien::test
