#pragma once
/// The steps of writing a Character as glTF; write_gltf runs them in this order.

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/io/detail/gltf_builder.h"
#include "mien/io/detail/gltf_document.h"

namespace mien::detail {

/// A part's mesh with one row a distinct set of attributes, as glTF needs it. Rows 0 ... #V - 1 are the
/// part's own vertices in their order; copies for UV seams come after them.
struct SplitMesh {
  int vertex_count = 0;         ///< #V of the part
  std::vector<int> copy_of;     ///< per appended row: the vertex it is a copy of
  std::vector<int> corner_row;  ///< per face corner: its row
  std::vector<Points2> uvs;     ///< per UV set: #rows
  int rows() const { return vertex_count + static_cast<int>(copy_of.size()); }
  int vertex_of(int row) const { return row < vertex_count ? row : copy_of[row - vertex_count]; }
};
SplitMesh split_seams(const Mesh& mesh);

/// The runs of rows that share accessors: those of the face groups and what comes after them where faces, lines and points
/// keep to them; otherwise all rows are one.
class VertexRanges {
 public:
  VertexRanges(const Mesh& mesh, const SplitMesh& split);
  /// Whether [begin, end) is the range of some face group.
  bool has_faces(int begin, int end) const { return faces_.contains({begin, end}); }
  /// The range that holds the element's first vertex.
  std::pair<int, int> of(const LooseElements& loose) const;

 private:
  bool follow_groups(const Mesh& mesh);
  bool fits(const Mesh& mesh) const;
  int rows_;
  std::set<std::pair<int, int>> faces_, ranges_;
};

/// The node of the file that shows each part, -1: none does; nodes of the character keep their numbers.
std::vector<int> written_nodes_of_parts(const Character& character);
/// The parts as glTF meshes, in order.
Json write_meshes(const Character& character, GltfBuilder& builder);
/// The vendor extension of one mesh: what the glTF arrays do not say about its faces, seams and groups.
Json vendor_mesh(const Mesh& mesh, const SplitMesh& split, bool normals_computed, GltfBuilder& builder);
/// Adds the spline surface or subdivision that the part's vertices control.
void write_surface(const Part& part, Json& vendor);
/// The vendor extension of the file: landmarks, curves, sliders, wires, constraints, controls.
Json vendor_root(const Character& character, GltfBuilder& builder);
Json vendor_point(const SurfacePoint& point);
/// Adds wires and what shapes do to them to the file's vendor extension.
void write_wires(const Character& character, GltfBuilder& builder, Json& vendor);
/// Adds constraints and the control interface to the file's vendor extension.
void write_constraints(const Character& character, Json& vendor);
void write_controls(const Character& character, Json& vendor);
/// A channel that moves a wire, for the vendor extension of its animation.
Json wire_channel_json(const Character& character, const Channel& channel, GltfBuilder& builder);
/// Adds influence objects and what shapes do to them to the file's vendor extension.
void write_objects(const Character& character, GltfBuilder& builder, Json& vendor);
/// A channel that moves a control point of an object, for the vendor extension of its animation.
Json object_channel_json(const Character& character, const Channel& channel, GltfBuilder& builder);
/// The character with shapes that move objects alone listed on its first part, where glTF can name them; nothing when it has none.
std::optional<Character> with_shapes_of_objects(const Character& character);
/// Adds sliders, correctives and expressions to the file's vendor extension unless they are one plain slider a
/// shape, which every glTF has.
void write_sliders(const Character& character, Json& vendor);
/// The clip as other programs see it: slider channels become channels of the shape weights they drive.
/// Exact for plain sliders; otherwise at every key and 30 times a second.
Clip with_shape_channels(const Character& character, const Clip& clip);
/// The value of a one-valued channel at a time.
double value_at(const Channel& channel, double seconds);
const char* name_of(Interpolation interpolation);

Json write_animations(const Character& character, const std::vector<int>& node_of_part, GltfBuilder& builder);

/// The runs of faces that become one primitive each.
std::vector<FaceGroup> primitive_groups(const Mesh& mesh, const SplitMesh& split);

/// Carried JSON text, parsed; an empty object for an empty text.
Json carried_json(const std::string& text, const std::string& place);

}  // namespace mien::detail
