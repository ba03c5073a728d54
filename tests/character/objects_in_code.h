#pragma once
/// A small character whose influence objects can be checked by hand.

#include "mien/character/character.h"
#include "mien/character/sliders.h"

namespace mien::test {

/// Nodes root, head and lip, a child of head; one skin of the last two, bound as they rest; part 0 of four vertices that follow the
/// head; shape and slider "raise". No object yet.
inline Character head_and_lip() {
  Character character;
  const char* const names[3] = {"root", "head", "lip"};
  for (int n = 0; n < 3; ++n) {
    Node node;
    node.name = names[n];
    node.parent = n - 1;
    node.rest.translation = Eigen::Vector3d(0.5 * n, 1 + n, 0.25);
    node.rest.rotation =
        Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * n, Eigen::Vector3d(1, 2, 3).normalized()));
    character.nodes.push_back(node);
  }
  const auto rest = model_matrices(character);
  Skin skin;
  skin.name = "skin";
  skin.joints = {1, 2};
  skin.inverse_bind = {rest[1].inverse(), rest[2].inverse()};
  character.skins.push_back(skin);
  Part part;
  part.name = "Face";
  part.mesh.positions.resize(4, 3);
  part.mesh.positions << 0, 0, 0, 1, 0, 0, 2, 0, 0.5f, 3, 1, 0;
  part.mesh.faces.push_back({0, 1, 2});
  part.mesh.faces.push_back({1, 3, 2});
  part.skin = 0;
  part.skin_weights = {{0, 1, 2, 3, 4}, {0, 0, 0, 0}, {1, 1, 1, 1}};
  character.parts.push_back(part);
  character.shapes.push_back({"raise", {}});
  complete_sliders(character);
  return character;
}

/// A straight line of two control points above vertices 0 to 2: vertex 0 lies under its start, 1 under its middle, at half weight,
/// 2 under its end.
inline InfluenceObject line() {
  InfluenceObject object;
  object.name = "line";
  object.form = NurbsCurve{1, {0, 0, 1, 1}, {}};
  object.carrier = 1;
  object.controls.resize(2, 3);
  object.controls << 0, 0, 1, 2, 0, 1;
  object.bindings.push_back({0, {0, 1, 2}, {1, 0.5f, 1}, {0, 1, 3, 4}, {0, 0, 1, 1}, {1, 0.5f, 0.5f, 1}});
  return object;
}

/// A frame that moves vertices 1 and 3, the latter by a quarter.
inline InfluenceObject frame(InfluenceForm form) {
  InfluenceObject object;
  object.name = "frame";
  object.form = std::move(form);
  object.carrier = 1;
  object.node = 2;
  object.controls.resize(1, 3);
  object.controls << 2, 1, 0;
  object.bindings.push_back({0, {1, 3}, {1, 0.25f}, {}, {}, {}});
  return object;
}

}  // namespace mien::test
