#pragma once
/// Small random characters that use everything an evaluator must handle.

#include <algorithm>
#include <random>
#include <string>

#include "mien/character/character.h"
#include "mien/character/pose.h"
#include "mien/character/sliders.h"
#include "mien/geometry/bspline.h"

namespace mien::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / static_cast<double>(engine_.max()));
  }
  int index(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  Eigen::Vector3d vector(double size) {
    return {number(-size, size), number(-size, size), number(-size, size)};
  }
  Eigen::Quaterniond rotation(double most) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(number(-most, most), vector(1).normalized()));
  }

 private:
  std::mt19937 engine_;
};

inline Part random_part(Random& random, int vertices) {
  Part part;
  part.name = "part";
  part.mesh.positions.resize(vertices, 3);
  for (int v = 0; v < vertices; ++v) part.mesh.positions.row(v) = random.vector(1).cast<float>();
  for (int v = 0; v + 2 < vertices; v += 2) part.mesh.faces.push_back({v, v + 1, v + 2});
  return part;
}

inline SkinWeights random_skin_weights(Random& random, int vertices, int joints) {
  SkinWeights weights{{0}, {}, {}};
  for (int v = 0; v < vertices; ++v) {
    const int influences = 1 + random.index(std::min(joints, 9));
    float total = 0;
    for (int i = 0; i < influences; ++i) {
      weights.joints.push_back(i);
      weights.weights.push_back(static_cast<float>(random.number(0.1, 1)));
      total += weights.weights.back();
    }
    for (int i = 0; i < influences; ++i) weights.weights.end()[-1 - i] /= total;
    weights.offsets.push_back(static_cast<int>(weights.joints.size()));
  }
  return weights;
}

inline PartDelta random_delta(Random& random, int part, int vertices) {
  PartDelta delta{part, {}, {}, {}, {}};
  for (int v = 0; v < vertices; ++v)
    if (random.index(3) == 0) delta.vertices.push_back(v);
  delta.deltas.resize(static_cast<Eigen::Index>(delta.vertices.size()), 3);
  for (Eigen::Index r = 0; r < delta.deltas.rows(); ++r)
    delta.deltas.row(r) = random.vector(0.3).cast<float>();
  return delta;
}

/// A tree of 6 joints with uneven scales; a skinned part, one held by a node, one in model space; 5 shapes over all
/// of them. Odd seeds skin by dual quaternions. Vertex counts vary with the seed and are no multiples of a block.
inline Character random_rig(unsigned seed) {
  Random random(seed + 17);
  Character character;
  for (int n = 0; n < 7; ++n) {
    Node node;
    node.name = "node" + std::to_string(n);
    node.parent = n == 0 ? -1 : random.index(n);
    node.rest = {random.vector(0.5), random.rotation(1), Eigen::Vector3d::Ones() + random.vector(0.2)};
    character.nodes.push_back(node);
  }
  const auto model = model_matrices(character);
  Skin skin{"skin", {}, {}, true, -1, {}};
  for (int n = 0; n < 6; ++n) {
    skin.joints.push_back(n);
    skin.inverse_bind.push_back(model[n].inverse());
  }
  if (seed % 2 == 1) skin.method = SkinningMethod::dual_quaternion;
  character.skins.push_back(skin);
  for (int p = 0; p < 3; ++p) {
    const int vertices = 5 + random.index(60);
    character.parts.push_back(random_part(random, vertices));
    if (p == 0) {
      character.parts[p].skin = 0;
      character.parts[p].skin_weights = random_skin_weights(random, vertices, 6);
    }
  }
  character.parts[1].node = 6;
  for (int s = 0; s < 5; ++s) {
    Shape shape{"shape" + std::to_string(s), {}};
    for (int p = 0; p < 3; ++p)
      if (s == 0 || random.index(3) > 0)
        shape.parts.push_back(
            random_delta(random, p, static_cast<int>(character.parts[p].mesh.vertex_count())));
    character.shapes.push_back(shape);
  }
  complete_sliders(character);
  return character;
}

inline Pose random_pose(const Character& character, unsigned seed) {
  Random random(seed + 1000);
  Pose pose = rest_pose(character);
  for (Eigen::Index s = 0; s < pose.shape_weights.values.size(); ++s)
    pose.shape_weights.values[s] = random.index(3) == 0 ? 0 : random.number(-0.5, 1.5);
  for (Transform& local : pose.locals) {
    local.translation += random.vector(0.2);
    local.rotation = local.rotation * random.rotation(1.5);
    local.scale += random.vector(0.1);
  }
  return pose;
}

/// A wire without bindings.
inline Wire random_wire(Random& random, int index, int controls) {
  Wire wire;
  wire.name = "wire" + std::to_string(index);
  wire.curve.controls.resize(controls, 3);
  for (int c = 0; c < controls; ++c) wire.curve.controls.row(c) = random.vector(1);
  wire.curve.knots = clamped_knots(controls);
  wire.ranges = {0.5};
  return wire;
}

/// The random rig with three wires over all of its parts; the second does not turn.
inline Character wired_rig(unsigned seed) {
  Character character = random_rig(seed);
  Random random(seed + 5000);
  for (int w = 0; w < 3; ++w) {
    Wire wire = random_wire(random, w, 4 + w);
    if (w == 1) wire.turn_controls = 0;
    for (int p = 0; p < static_cast<int>(character.parts.size()); ++p) {
      WireBinding binding{p, {}, {}, {}};
      for (int v = 0; v < static_cast<int>(character.parts[p].mesh.vertex_count()); ++v)
        if (random.index(5) < 2) {
          binding.vertices.push_back(v);
          binding.falloff.push_back(static_cast<float>(random.number(0.1, 1)));
          binding.parameters.push_back(static_cast<float>(random.number(0, 1)));
        }
      wire.bindings.push_back(binding);
    }
    character.wires.push_back(wire);
  }
  return character;
}

inline PointsD random_rows(Random& random, int rows, double size) {
  PointsD moves(rows, 3);
  for (int r = 0; r < rows; ++r) moves.row(r) = random.vector(size);
  return moves;
}

/// A random pose in which two wires move, one of them twice.
inline Pose wired_pose(const Character& character, unsigned seed) {
  Pose pose = random_pose(character, seed);
  Random random(seed + 7000);
  for (const int w : {0, 2, 0}) {
    const Wire& wire = character.wires[w];
    pose.wires.push_back({w, random_rows(random, wire.curve.control_count(), 0.3), random.number(-0.5, 0.5),
                          random_rows(random, wire.turn_controls, 0.4)});
  }
  return pose;
}

/// The random rig with a constraint of every kind; each node looks at nodes before it.
inline Character constrained_rig(unsigned seed) {
  Character character = random_rig(seed);
  const auto add = [&](Constraint::Kind kind, int node, std::vector<ConstraintSource> sources) {
    Constraint constraint;
    constraint.name = "constraint" + std::to_string(character.constraints.size());
    constraint.kind = kind;
    constraint.node = node;
    constraint.sources = std::move(sources);
    character.constraints.push_back(constraint);
    return &character.constraints.back();
  };
  add(Constraint::Kind::scale, 1, {{0, 1}});
  Constraint* limit = add(Constraint::Kind::limit, 2, {});
  limit->rotation[0] = {-0.3, 0.3};
  limit->translation[1] = {-0.05, 0.05};
  add(Constraint::Kind::point, 3, {{1, 1}})->influence = 0.6;
  add(Constraint::Kind::orient, 4, {{2, 1}, {3, 2}})->relative = seed % 3 > 0;
  add(Constraint::Kind::parent, 5, {{1, 1}, {3, 0.5}})->influence = 0.8;
  add(Constraint::Kind::aim, 6, {{2, 1}});
  return character;
}

/// An object without control points' skin or bindings.
inline InfluenceObject random_object(Random& random, std::string name, InfluenceForm form, int controls) {
  InfluenceObject object;
  object.name = std::move(name);
  object.form = std::move(form);
  object.controls = random_rows(random, controls, 1);
  return object;
}

/// Binds an object to some vertices of every part.
inline void bind_anyhow(Random& random, const Character& character, bool is_frame, InfluenceObject& object) {
  for (int p = 0; p < static_cast<int>(character.parts.size()); ++p) {
    InfluenceBinding binding;
    binding.part = p;
    if (!is_frame) binding.offsets.push_back(0);
    for (int v = 0; v < static_cast<int>(character.parts[p].mesh.vertex_count()); ++v) {
      if (random.index(5) > 1) continue;
      binding.vertices.push_back(v);
      binding.weights.push_back(static_cast<float>(random.number(0.1, 1)));
      if (is_frame) continue;
      const float share = static_cast<float>(random.number(0, 1));
      const int first = random.index(static_cast<int>(object.controls.rows()) - 1);
      binding.controls.insert(binding.controls.end(), {first, first + 1});
      binding.coefficients.insert(binding.coefficients.end(), {share, 1 - share});
      binding.offsets.push_back(static_cast<int>(binding.controls.size()));
    }
    object.bindings.push_back(binding);
  }
}

/// The wired rig with influence objects: a curve on joints, a wrap and a cluster on nodes, a locator in model space; two shapes move
/// the first two and the cluster.
inline Character objects_rig(unsigned seed) {
  Character character = wired_rig(seed);
  Random random(seed + 9000);
  InfluenceObject curve = random_object(random, "curve", NurbsCurve{1, {0, 0, 0.5, 1, 1}, {}}, 3);
  curve.carrier = 1;
  curve.skin = 0;
  curve.skin_weights = random_skin_weights(random, 3, 6);
  WrapMesh mesh;
  mesh.faces.push_back({0, 1, 2, 3});
  InfluenceObject wrap = random_object(random, "wrap", mesh, 4);
  wrap.carrier = 0;
  wrap.node = 2;
  InfluenceObject cluster = random_object(random, "cluster", Cluster{}, 1);
  cluster.carrier = 1;
  cluster.node = 4;
  InfluenceObject locator = random_object(random, "locator", Locator{}, 1);
  locator.node = 5;
  for (InfluenceObject* object : {&curve, &wrap, &cluster, &locator}) {
    bind_anyhow(random, character, object == &cluster || object == &locator, *object);
    character.objects.push_back(*object);
  }
  character.shapes[0].objects = {{0, random_rows(random, 3, 0.3)}, {2, random_rows(random, 1, 0.3)}};
  character.shapes[3].objects = {{1, random_rows(random, 4, 0.3)}};
  return character;
}

/// A random pose in which shapes, joints, wires and an animator move objects.
inline Pose objects_pose(const Character& character, unsigned seed) {
  Pose pose = wired_pose(character, seed);
  Random random(seed + 11000);
  for (const int o : {1, 3, 1})
    pose.objects.push_back(
        {o, random_rows(random, static_cast<int>(character.objects[o].controls.rows()), 0.2)});
  return pose;
}

}  // namespace mien::test
