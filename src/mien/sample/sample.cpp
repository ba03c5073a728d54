#include "mien/sample/sample.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/sample/detail/character_form.h"
#include "mien/sample/detail/paint_skin.h"
#include "mien/sample/detail/remesh.h"

namespace mien {

namespace {

constexpr std::array<SampleInfo, 3> kSamples = {{
    {"human", "a rigged head: 52 ARKit shapes, joints, eyes, teeth, tongue, a talking clip (metres)", false},
    {"cartoon", "a bare cartoon child: big eyes, button nose, wide mouth; quads with UVs (centimetres)",
     true},
    {"creature",
     "a bare goblin: muzzle, heavy brow, pointed ears; triangles without UVs, turned aside (inches)", true},
}};

Character make_human() {
  const sample::CharacterForm form = sample::human_character();
  sample::BuiltCharacter built = sample::build_character(form);
  const sample::FaceRegions regions = sample::make_regions(built.head, form.head);
  sample::add_shapes(built, form, regions);
  sample::add_rig(built, form, regions);
  complete_sliders(built.character);
  sample::paint_skin(built, form);
  sample::add_talking_clip(built.character);
  sample::add_constraints(built.character);
  sample::place(built.character, 0.01, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
  sample::add_influence_objects(built.character);
  sample::move_objects_while_talking(built.character);
  return std::move(built.character);
}

Character make_cartoon() {
  sample::BuiltCharacter built = sample::build_character(sample::cartoon_character());
  return std::move(built.character);
}

/// Gives the creature's skin triangles of their own layout; its landmarks stay where they are.
void remesh_skin(sample::BuiltCharacter& built, const sample::HeadForm& form) {
  Mesh& skin = built.character.parts[sample::face_part].mesh;
  std::vector<char> kept(skin.vertex_count(), 0);
  std::vector<double> wanted(skin.vertex_count());
  // Fine around eyes and mouth, coarse elsewhere.
  const Eigen::Vector3d mouth(0, form.mouth.line, form.mouth.front);
  for (std::size_t v = 0; v < kept.size(); ++v) {
    const Eigen::Vector3d& p = built.head.points[v];
    const Eigen::Vector3d left(std::abs(p.x()), p.y(), p.z());
    const double away = std::min((left - form.eye.centre).norm() - form.eye.radius, (p - mouth).norm() - 1.0);
    wanted[v] = 0.3 + 0.4 * std::clamp(away / 6, 0.0, 1.0);
  }
  const auto keep = [&](const SurfacePoint& at) { kept[at.vertex] = 1; };
  for (const Landmark& landmark : built.character.landmarks) keep(landmark.at);
  for (const LandmarkCurve& curve : built.character.curves)
    for (const SurfacePoint& point : curve.points) keep(point);
  const sample::HalfHead& half = built.head.half;
  for (const int k : {half.lid_edge, half.lid_edge + 1})
    for (int v : half.eye[k]) kept[v] = kept[built.head.mirror[v]] = 1;
  // Thin or narrow places keep their layout: ears and nostrils.
  for (const auto* loops : {&half.ear, &half.nostril})
    for (std::size_t k = 1; k < loops->size(); ++k)
      for (int v : (*loops)[k]) kept[v] = kept[built.head.mirror[v]] = 1;
  for (int v : half.mouth[half.lip_contact]) kept[v] = kept[built.head.mirror[v]] = 1;

  sample::Remeshed remeshed = sample::remesh(skin, kept, wanted);
  skin = std::move(remeshed.mesh);
  skin.normals = vertex_normals(skin.positions, triangulate(skin.faces));
  for (Landmark& landmark : built.character.landmarks)
    landmark.at.vertex = remeshed.new_vertex[landmark.at.vertex];
  for (LandmarkCurve& curve : built.character.curves)
    for (SurfacePoint& point : curve.points) point.vertex = remeshed.new_vertex[point.vertex];
}

/// Turned and standing elsewhere, as a target may.
Character make_creature() {
  const sample::CharacterForm form = sample::creature_character();
  sample::BuiltCharacter built = sample::build_character(form);
  remesh_skin(built, form.head);
  for (Part& part : built.character.parts) part.mesh.uvs.clear();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(std::numbers::pi / 9, Eigen::Vector3d::UnitY()));
  sample::place(built.character, 1 / 2.54, turn, {12, 60, -5});
  return std::move(built.character);
}

}  // namespace

std::span<const SampleInfo> sample_list() {
  return kSamples;
}

Character make_sample(std::string_view name) {
  if (name == "human") return make_human();
  if (name == "cartoon") return make_cartoon();
  if (name == "creature") return make_creature();
  std::string names;
  for (const SampleInfo& info : kSamples) names += (names.empty() ? "" : ", ") + std::string(info.name);
  throw invalid_input("sample " + std::string(name), "is not a built-in character", "use one of " + names);
}

}  // namespace mien
