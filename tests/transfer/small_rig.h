#pragma once
/// A skeleton small enough to know by heart, for the tests of what is carried with it.

#include <string>
#include <vector>

#include "mien/transfer/carry_clips.h"
#include "mien/transfer/rig_map.h"
#include "transfer/faces.h"

namespace mien::test {

inline Node node(const std::string& name, int parent, const Eigen::Vector3d& translation, double angle = 0) {
  Node n;
  n.name = name;
  n.parent = parent;
  n.rest.translation = translation;
  n.rest.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 1, 0).normalized());
  return n;
}

/// Scene > head > jaw > chin, bound as they rest; a face that holds the skin and a tooth that hangs below the jaw.
inline Character rig() {
  Character character;
  character.nodes = {node("Scene", -1, {0, 0, 0}),     node("head", 0, {0, 1, 0}, 0.4),
                     node("jaw", 1, {0, -0.5, 1}, -1), node("chin", 2, {0.2, 0, 2}, 0.3),
                     node("Face", 0, {0, 0, 0}),       node("Tooth", 2, {0, 0.1, 1})};
  Skin skin;
  skin.name = "bones";
  skin.joints = {1, 3};
  const auto model = model_matrices(character);
  for (const int joint : skin.joints) skin.inverse_bind.push_back(model[joint].inverse());
  character.skins = {skin, skin};
  character.skins[1].joints = {3, 2};
  character.skins[1].inverse_bind = {model[3].inverse(), model[2].inverse()};
  Part face;
  face.node = 4;
  face.skin = 0;
  Part tooth;
  tooth.node = 5;
  character.parts = {face, tooth};
  return character;
}

inline SpaceMap of_similarity(const Similarity& s) {
  return {[s](const Eigen::Vector3d& x) { return s(x); }, [s](const Eigen::Vector3d&) { return s.rotation; },
          [s](const Eigen::Vector3d&) { return s.scale; }};
}

/// The target's nodes as transfer makes them: `first` of its own, then the carried ones.
inline Character with_skeleton(const CarriedSkeleton& skeleton, int first) {
  Character target;
  for (int n = 0; n < first; ++n) target.nodes.push_back(node("own" + std::to_string(n), -1, {9, 9, 9}));
  target.nodes.insert(target.nodes.end(), skeleton.nodes.begin(), skeleton.nodes.end());
  target.skins.push_back(skeleton.skin);
  return target;
}
inline Channel channel(Channel::Property property, int node, std::vector<float> times,
                       std::vector<float> values) {
  Channel c;
  c.property = property;
  c.node = node;
  c.times = std::move(times);
  c.values = std::move(values);
  return c;
}

/// A similarity for everything; per-vertex rows stay as they are, and so do all nodes.
inline RigMap rig_map_of(const Character& source, const Similarity& s) {
  RigMap map;
  map.space = of_similarity(s);
  map.move = [s](const PointsD&, const PointsD& moves) { return s.of_vectors(moves); };
  map.rows = [](const WeightMatrix& rows) { return rows; };
  map.surface_point = [](const SurfacePoint& point) { return point; };
  for (std::size_t n = 0; n < source.nodes.size(); ++n) map.node_of.push_back(static_cast<int>(n));
  map.skin_joint = list_joints(source).skin_joint;
  return map;
}

/// One part: a row of `count` vertices along x, one unit apart.
inline Character row_of_vertices(int count) {
  Character character;
  character.parts.resize(1);
  character.parts[0].name = "row";
  character.parts[0].mesh.positions = Points::Zero(count, 3);
  for (int v = 0; v < count; ++v) character.parts[0].mesh.positions(v, 0) = static_cast<float>(v);
  return character;
}

}  // namespace mien::test
