#pragma once
/// The steps of reading a glTF into a Character; read_gltf runs them in this order.

#include <vector>

#include "mien/character/character.h"
#include "mien/io/detail/gltf_document.h"

namespace mien::detail {

/// What the later steps need to know about a part that the Character does not say.
struct PartSource {
  int mesh = -1;
  std::vector<int> shapes;  ///< per morph target: index into Character::shapes
};
/// The part that a vendor member's "mesh" became; -1: a mesh that is not in use.
int part_of_mesh(const JsonObject& source, const std::vector<PartSource>& sources);
/// The same where there must be one.
int used_part_of_mesh(const JsonObject& source, const std::vector<PartSource>& sources);

void read_nodes(GltfDocument& document, Character& character);
void read_skins(GltfDocument& document, Character& character);
void read_appearance(GltfDocument& document, Character& character);
std::vector<PartSource> read_parts(GltfDocument& document, Character& character);
void read_clips(GltfDocument& document, const std::vector<PartSource>& sources, Character& character);
/// Sliders, correctives and expressions from the file's vendor extension, in place of one slider a shape.
void read_sliders(const JsonObject& vendor, Character& character);
/// A point of the vendor extension on one of the meshes in use.
SurfacePoint read_vendor_point(const JsonObject& source, const std::vector<PartSource>& sources,
                               const Character& character);
/// Wires and what shapes do to them, from the file's vendor extension.
void read_wires(const JsonObject& vendor, GltfDocument& document, const std::vector<PartSource>& sources,
                Character& character);
/// Constraints and the control interface, from the file's vendor extension.
void read_constraints(const JsonObject& vendor, Character& character);
void read_controls(const JsonObject& vendor, Character& character);
/// What a channel moves of a wire; its keys are left out.
Channel read_wire_channel(const JsonObject& source, const Character& character);
/// Influence objects and what shapes do to them, from the file's vendor extension.
void read_objects(const JsonObject& vendor, GltfDocument& document, const std::vector<PartSource>& sources,
                  Character& character);
/// Which control point of an object a channel moves; its keys are left out.
Channel read_object_channel(const JsonObject& source, const Character& character);
/// N-gons, seams, groups, landmarks and curves from the vendor extension; sliders, wires and objects too.
void read_vendor(GltfDocument& document, const std::vector<PartSource>& sources, Character& character);

/// The spline surface or subdivision that a part's vertices control, from its mesh's vendor extension.
void read_surface(const JsonObject& vendor, Part& part);

/// One mesh as the file holds it: its surface, its influences and its morph targets.
struct MeshData {
  Mesh mesh;
  SkinWeights skin_weights;
  std::vector<PartDelta> targets;
  std::string carried_primitives;  ///< JSON array text of each primitive's extras and extensions, or empty
};
/// Cost: linear in the accessors. `skinned`: whether to read influences.
MeshData read_mesh(GltfDocument& document, int mesh, bool skinned);

/// The text of all members of `source` but these, and but what MIEN_character says of it; empty when there are none.
std::string others_but_vendor(const JsonObject& source, std::initializer_list<const char*> keys);

}  // namespace mien::detail
