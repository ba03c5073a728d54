#include "mien/sample/sample.h"

#include <array>
#include <numbers>

#include "mien/core/error.h"
#include "mien/sample/detail/character_form.h"

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
  sample::add_talking_clip(built.character);
  sample::place(built.character, 0.01, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
  return std::move(built.character);
}

Character make_cartoon() {
  sample::BuiltCharacter built = sample::build_character(sample::cartoon_character());
  return std::move(built.character);
}

/// Turned and standing elsewhere, as a target may.
Character make_creature() {
  sample::BuiltCharacter built = sample::build_character(sample::creature_character());
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
