#pragma once
/// What the tests of whole transfers share.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>

#include "mien/transfer/transfer.h"
#include "sample/made.h"

namespace mien::test {

/// The built-in source on the built-in target with all defaults, made once.
inline const TransferResult& transferred(const std::string& source, const std::string& target) {
  static std::map<std::pair<std::string, std::string>, TransferResult> cache;
  const auto known = cache.find({source, target});
  if (known != cache.end()) return known->second;
  return cache[{source, target}] = transfer(made(source), made(target));
}

/// One shape's displacements of one part, #V x 3.
inline PointsD delta_of(const Character& character, std::size_t shape, int part) {
  PointsD delta = PointsD::Zero(character.parts[part].mesh.positions.rows(), 3);
  for (const PartDelta& entry : character.shapes[shape].parts)
    if (entry.part == part)
      for (std::size_t i = 0; i < entry.vertices.size(); ++i)
        delta.row(entry.vertices[i]) = entry.deltas.row(static_cast<Eigen::Index>(i)).cast<double>();
  return delta;
}

inline int part_named(const Character& character, const std::string& name) {
  const int part = find_part(character, name);
  EXPECT_GE(part, 0) << name;
  return part;
}

/// Without joints, clips and what may hang on them.
inline Character without_joints(Character character) {
  character.skins.clear();
  character.clips.clear();
  character.objects.clear();
  character.constraints.clear();
  character.controls.clear();
  for (Part& part : character.parts) {
    part.skin = -1;
    part.skin_weights = {};
  }
  return character;
}

/// Root of the squared difference over the root of b's squares, over all parts.
inline double difference(const Character& a, std::size_t shape_a, const Character& b, std::size_t shape_b) {
  double off = 0, size = 0;
  for (std::size_t p = 0; p < b.parts.size(); ++p) {
    const PointsD wanted = delta_of(b, shape_b, static_cast<int>(p));
    off += (delta_of(a, shape_a, static_cast<int>(p)) - wanted).squaredNorm();
    size += wanted.squaredNorm();
  }
  return std::sqrt(off / std::max(size, 1e-300));
}

/// Names of a character's joints, sorted, each with its parent's name.
inline std::vector<std::string> joint_names(const Character& character) {
  std::vector<std::string> names;
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints) {
      const Node& node = character.nodes[joint];
      names.push_back(node.name + " < " + (node.parent < 0 ? "" : character.nodes[node.parent].name));
    }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace mien::test
