#pragma once
/// A rigged face: what every file is read into, every operation takes and gives, and every file is written
/// from.
///
/// `Character` is a plain value: copy it, change it, compare its parts. An empty part is an absent part. It
/// is the editable form; nothing in it is compiled for speed. `validate` lists what is wrong with one.
///
/// Spaces: a part's positions and deltas are in its node's local space when the part has no skin, and in
/// model space (the bind pose) when it has one, as in glTF. `model_matrices` gives the nodes' transforms to
/// model space. Units are the file's own; nothing depends on which.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mien/character/constraint.h"
#include "mien/character/control.h"
#include "mien/character/influence_object.h"
#include "mien/character/slider.h"
#include "mien/character/surface_point.h"
#include "mien/character/wire.h"
#include "mien/geometry/mesh.h"
#include "mien/geometry/nurbs_surface.h"

namespace mien {

/// Translation, then rotation, then scale: x -> t + R (s x).
struct Transform {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Matrix4d matrix() const;
};

/// One transform of the scene's hierarchy. A node that a skin lists is a joint; others group nodes or hold a
/// part.
struct Node {
  std::string name;
  int parent =
      -1;  ///< index into Character::nodes, -1: a root. Parents may come after children; cycles are invalid
  Transform rest;  ///< local, when nothing is animated
  bool has_matrix =
      false;  ///< the file gave a matrix, kept in `matrix` because it may shear; `rest` is its best TRS
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  std::string
      carried;  ///< JSON object text of members that mien only carries ("extras", "extensions", "camera")
};

/// How the motions of a vertex's joints are blended: their matrices, or the dual quaternions of their rigid parts.
enum class SkinningMethod { linear_blend, dual_quaternion };

/// A list of joints that parts are bound to.
struct Skin {
  std::string name;
  std::vector<int> joints;  ///< node indices
  /// Per joint: model space at bind time to the joint's space (the inverse of its bind matrix).
  std::vector<Eigen::Matrix4d> inverse_bind;
  bool has_inverse_bind = true;  ///< false: the file had none (they are identity then, as glTF says)
  int skeleton = -1;             ///< node index of the common root as the file named it, -1: not named
  std::string carried;
  SkinningMethod method = SkinningMethod::linear_blend;
};

/// How a part's mesh is smoothed by a program that subdivides: mien carries it.
enum class Subdivision { none, catmull_clark, loop };

/// A mesh in the scene: face, eye, teeth, tongue, lashes.
struct Part {
  std::string name;
  Mesh mesh;
  int node = -1;  ///< the node that holds it, -1: model space
  int skin = -1;  ///< index into Character::skins, -1: not skinned
  SkinWeights skin_weights;
  /// The vertices are the control vertices of this surface, which shapes, skins and pins move like any other; the mesh's faces
  /// are their grid.
  std::optional<NurbsSurface> surface;
  Subdivision subdivision = Subdivision::none;  ///< the mesh is the cage of such a surface
  bool shown = true;      ///< false: no node of the file shows the mesh; it is only carried
  std::string mesh_name;  ///< the mesh's own name where a file tells it from the node's
  std::string carried;
};

/// Sparse displacements of one part's vertices.
struct PartDelta {
  int part = 0;
  std::vector<int> vertices;  ///< ascending
  Points deltas;              ///< one row a vertex of `vertices`: shape minus neutral
  Points normal_deltas;       ///< same rows, or none
  Points tangent_deltas;      ///< same rows, or none
};

/// A sculpted change of the neutral, applied in proportion to its shape weight.
struct Shape {
  std::string name;
  std::vector<PartDelta>
      parts;  ///< ascending by part; an entry with no vertices: the file lists the shape there
  /// What the wires have to do with it, ascending by wire; none: nothing is known. `parts` remain what the shape is: these
  /// moves and what the wires leave over. Moving the wires of a shape moves its parts (`edit_wires`).
  std::vector<WireMove> wires = {};
  /// How it moves the control points of influence objects, ascending by object; they move the skin besides `parts`.
  std::vector<ObjectMove> objects = {};
};

enum class Interpolation { step, linear, cubic_spline };

/// One animated property. Values are interleaved by key; a cubic spline has (in-tangent, value, out-tangent)
/// a key.
struct Channel {
  enum class Property {
    translation,
    rotation,
    scale,
    shape_weight,
    slider,
    wire_control,
    wire_scale,
    wire_turn,
    object_control
  };
  Property property = Property::translation;
  int node = -1;    ///< for translation (3 values), rotation (unit quaternion x, y, z, w) and scale (3)
  int shape = -1;   ///< for shape_weight (1 value): index into Character::shapes
  int part = -1;    ///< shape_weight on this part alone; -1: on every part that has the shape
  int slider = -1;  ///< for slider (1 value): index into Character::sliders
  int wire =
      -1;  ///< for wire_scale (s - 1, 1 value), wire_control and wire_turn (3): index into Character::wires
  int control = -1;  ///< for wire_control, wire_turn and object_control: which of the control points or turns
  int object = -1;   ///< for object_control (3 values): index into Character::objects
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;  ///< seconds, strictly ascending
  std::vector<float> values;
  bool moves_wire() const {
    return property == Property::wire_control || property == Property::wire_scale ||
           property == Property::wire_turn;
  }
  int width() const {
    if (property == Property::rotation) return 4;
    const bool single = property == Property::shape_weight || property == Property::slider ||
                        property == Property::wire_scale;
    return single ? 1 : 3;
  }
};

struct Clip {
  std::string name;
  std::vector<Channel> channels;
  std::string carried;
  double duration() const;  ///< the last key's time in seconds; 0 without keys
};

struct Landmark {
  std::string name;
  SurfacePoint at;
};

/// A named polyline on the surface, sampled into `count` landmarks `name.0` ... evenly by length.
struct LandmarkCurve {
  std::string name;
  std::vector<SurfacePoint> points;  ///< two or more
  int count = 2;
};

/// The looks that ride along: materials, textures and images are carried, not interpreted, but for base
/// colours.
struct Material {
  std::string name;
  Eigen::Vector4f base_color = Eigen::Vector4f(0.8f, 0.8f, 0.8f, 1.f);
  std::string carried;  ///< the file's whole material as JSON text; empty: made from the two fields above
};
struct Image {
  std::string name, mime_type;
  std::string uri;  ///< as the file named it; empty when the bytes were embedded
  std::vector<unsigned char> bytes;
  std::string carried;
};
struct Appearance {
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<std::string> textures, samplers;  ///< JSON text, indexing images and samplers
};

struct Character {
  std::string name;
  std::vector<Node> nodes;
  std::vector<Part> parts;
  std::vector<Skin> skins;
  std::vector<Shape> shapes;            ///< names are unique
  std::vector<Slider> sliders;          ///< names are unique; `load` gives each undriven shape one
  std::vector<Corrective> correctives;  ///< shapes that fire with sliders
  std::vector<Expression> expressions;  ///< names are unique
  std::vector<Clip> clips;
  std::vector<Landmark> landmarks;
  std::vector<LandmarkCurve> curves;
  std::vector<Wire> wires;               ///< names are unique
  std::vector<InfluenceObject> objects;  ///< names are unique
  std::vector<Constraint> constraints;   ///< in the order in which they apply; names are unique
  std::vector<Control> controls;         ///< the control interface
  Appearance appearance;
  std::string carried;  ///< JSON object text of the file's members that mien only carries
};

/// Index of the element with this name, or -1.
int find_part(const Character& character, std::string_view name);
int find_shape(const Character& character, std::string_view name);
int find_wire(const Character& character, std::string_view name);
int find_node(const Character& character, std::string_view name);
int find_object(const Character& character, std::string_view name);

/// #N matrices, node space to model space, for nodes in rest. Cost: linear.
///   throws  invalid_input: a cycle among the parents, a parent out of range
std::vector<Eigen::Matrix4d> model_matrices(const Character& character);

/// The same for nodes whose local matrices are `locals` (#N).
std::vector<Eigen::Matrix4d> model_matrices(const Character& character,
                                            const std::vector<Eigen::Matrix4d>& locals);

/// Where a surface point is, in its part's space, on `positions` of that part (#V).
Eigen::Vector3d position_of(const Mesh& mesh, const Points& positions, const SurfacePoint& point);

}  // namespace mien
