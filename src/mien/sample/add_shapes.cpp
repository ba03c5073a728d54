// From displacement fields to the sparse shapes of all parts.

#include <algorithm>

#include "mien/sample/detail/character_form.h"
#include "mien/sample/detail/face_shapes.h"

namespace mien::sample {

namespace {

/// Keeps what moves by more than a micrometre on a head of life size.
PartDelta sparse(int part, const Field& field) {
  PartDelta delta;
  delta.part = part;
  for (std::size_t v = 0; v < field.size(); ++v)
    if (field[v].norm() > 1e-4) delta.vertices.push_back(static_cast<int>(v));
  delta.deltas.resize(delta.vertices.size(), 3);
  for (std::size_t i = 0; i < delta.vertices.size(); ++i)
    delta.deltas.row(i) = field[delta.vertices[i]].cast<float>();
  return delta;
}

Field moved(const Mesh& mesh, const Motion& motion) {
  Field field(mesh.vertex_count());
  for (std::size_t v = 0; v < field.size(); ++v) {
    const Vector3d p = mesh.positions.row(v).cast<double>();
    field[v] = motion.apply(p) - p;
  }
  return field;
}

Field followed(const Anchors& anchors, const Field& skin) {
  Field field(anchors.size(), Vector3d::Zero());
  for (std::size_t v = 0; v < field.size(); ++v)
    for (const auto& [vertex, share] : anchors[v]) field[v] += share * skin[vertex];
  return field;
}

/// The tongue put out: its front half slides forward over the lower teeth and hangs down.
Field tongue_out(const Mesh& tongue, const TongueForm& form) {
  Field field(tongue.vertex_count(), Vector3d::Zero());
  for (std::size_t v = 0; v < field.size(); ++v) {
    const Vector3d p = tongue.positions.row(v).cast<double>();
    const double t = std::clamp((p.z() - form.root.z()) / (form.tip.z() - form.root.z()), 0.0, 1.0);
    field[v] = Vector3d(-0.22 * t * p.x(), 0.35 * t - 1.1 * t * t * t, 3.4 * t * t);
  }
  return field;
}

}  // namespace

void add_shapes(BuiltCharacter& built, const CharacterForm& form, const FaceRegions& regions) {
  Character& character = built.character;
  const Anchors brows = anchors_of(character.parts[brows_part].mesh, built.head, {});
  const Anchors lashes = anchors_of(character.parts[lashes_part].mesh, built.head, built.lash_anchors);
  for (const FaceShape& face : make_face_shapes({built.head, form.head, regions})) {
    Shape shape;
    shape.name = face.name;
    const auto add = [&](int part, const Field& field) {
      PartDelta delta = sparse(part, field);
      if (!delta.vertices.empty()) shape.parts.push_back(std::move(delta));
    };
    add(face_part, face.skin);
    if (!face.eye_left.still()) add(left_eye_part, moved(character.parts[left_eye_part].mesh, face.eye_left));
    if (!face.eye_right.still())
      add(right_eye_part, moved(character.parts[right_eye_part].mesh, face.eye_right));
    if (!face.lower_teeth.still())
      add(lower_teeth_part, moved(character.parts[lower_teeth_part].mesh, face.lower_teeth));
    const Mesh& tongue = character.parts[tongue_part].mesh;
    if (face.tongue_out)
      add(tongue_part, tongue_out(tongue, form.tongue));
    else if (!face.tongue.still())
      add(tongue_part, moved(tongue, face.tongue));
    add(brows_part, followed(brows, face.skin));
    add(lashes_part, followed(lashes, face.skin));
    character.shapes.push_back(std::move(shape));
  }
}

}  // namespace mien::sample
