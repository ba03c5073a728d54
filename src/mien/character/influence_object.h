#pragma once
/// Influence objects: curves, surfaces, lattices, meshes, clusters and locators that move the skin with them. Data only; deform
/// binds and moves them.

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "mien/geometry/lattice.h"
#include "mien/geometry/mesh.h"
#include "mien/geometry/nurbs_curve.h"
#include "mien/geometry/nurbs_surface.h"

namespace mien {

/// Any number of (joint, skin weight) pairs a vertex; the skin weights of a vertex sum to one.
struct SkinWeights {
  std::vector<int> offsets;    ///< #V + 1: vertex v has the influences [offsets[v], offsets[v + 1])
  std::vector<int> joints;     ///< index into Skin::joints
  std::vector<float> weights;  ///< > 0
  bool empty() const { return offsets.empty(); }
  bool operator==(const SkinWeights&) const = default;
};

/// A frame that moves what is bound to it as one; it has no control points.
struct Cluster {
  bool operator==(const Cluster&) const = default;
};
/// A named frame; as an influence it acts like a cluster.
struct Locator {
  bool operator==(const Locator&) const = default;
};
/// A polygon mesh whose vertices are the control points: a wrap.
struct WrapMesh {
  Faces faces;
  bool operator==(const WrapMesh&) const = default;
};

/// What an influence object is; the order is that of `name_of` in deform.
using InfluenceForm = std::variant<NurbsCurve, NurbsSurface, Lattice, WrapMesh, Cluster, Locator>;

/// How an object acts on one part. Vertex k of `vertices` moves by its weight times the displacement of its point of the object:
/// sum over its entries of coefficient x displacement of the control point. A cluster or locator has no entries: it moves the vertex
/// as a rigid frame would.
struct InfluenceBinding {
  int part = 0;
  std::vector<int> vertices;        ///< ascending
  std::vector<float> weights;       ///< in (0, 1], one a vertex: the object's weight map
  std::vector<int> offsets;         ///< #vertices + 1 into the next two; empty for clusters and locators
  std::vector<int> controls;        ///< which control points
  std::vector<float> coefficients;  ///< their shares in the vertex's point of the object; sum to one a vertex
  bool operator==(const InfluenceBinding&) const = default;
};

/// One object. Its own motion counts in the bind pose, before the skin's: joints that move control points do so relative to
/// `carrier`, the node (a head joint) that carries object and skin alike, so that turning the head moves nothing twice.
struct InfluenceObject {
  std::string name;
  InfluenceForm form = Cluster{};
  int carrier = -1;  ///< node; -1: model space
  int node =
      -1;  ///< the node that moves the object as one; -1: none. What a cluster or locator does is this node's motion
  PointsD controls;  ///< #C x 3, model space, bind pose; a cluster or locator has one: where it is
  int skin = -1;     ///< index into Character::skins: joints that move control points; -1: `node` alone does
  SkinWeights skin_weights;                ///< of the control points
  std::vector<InfluenceBinding> bindings;  ///< ascending by part
};

/// How an object's control points leave their places, bind pose, model space. Linear: moves add up.
struct ObjectMove {
  int object = 0;    ///< index into Character::objects
  PointsD controls;  ///< #C displacements, or no rows
};

}  // namespace mien
