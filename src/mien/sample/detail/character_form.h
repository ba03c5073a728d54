#pragma once
/// A built-in character before it becomes a `Character`: the head's form and what goes with it.

#include "mien/character/character.h"
#include "mien/sample/detail/face_regions.h"
#include "mien/sample/detail/inner_parts.h"

namespace mien::sample {

/// Where the 68 landmarks are, roughly, on the left half; each goes to the closest vertex of the skin. Eyes
/// and mouth need none: their landmarks are places in their loops.
struct LandmarkForm {
  std::vector<Vector3d> jaw;   ///< 9: from the chin to the ear
  std::vector<Vector3d> brow;  ///< 5: from the inner to the outer end
  std::vector<Vector3d> nose;  ///< 4: from the root to the tip
  std::vector<Vector3d> base;  ///< 3: from the middle under the nose to the wing
};

struct CharacterForm {
  std::string name;
  HeadForm head;
  TeethForm upper_teeth, lower_teeth;
  TongueForm tongue;
  BrowForm brows;     ///< no line: none
  double lashes = 0;  ///< their length; 0: none
  double iris = 25;   ///< half the iris' angle seen from the eye's centre, degrees
  LandmarkForm landmarks;
  std::vector<Material> materials;  ///< by MaterialId
};

/// A material of one colour, given in sRGB and kept linear, as glTF has base colours.
Material plain_material(const char* name, float red, float green, float blue);

CharacterForm human_character();
CharacterForm cartoon_character();
CharacterForm creature_character();

enum PartId {
  face_part,
  left_eye_part,
  right_eye_part,
  upper_teeth_part,
  lower_teeth_part,
  tongue_part,
  brows_part,
  lashes_part
};

struct BuiltCharacter {
  HeadMesh head;
  std::vector<int> lash_anchors;  ///< the skin vertex that each lash vertex grows from
  Character character;            ///< parts, materials and landmarks, in centimetres; no rig
};

BuiltCharacter build_character(const CharacterForm& form);

/// The landmarks and curves, on part `face_part`.
void add_landmarks(Character& character, const HeadMesh& head, const CharacterForm& form);

/// For each vertex of a part that rides on the skin, the skin vertices (all or the given anchors) that carry
/// it.
using Anchors = std::vector<std::vector<std::pair<int, double>>>;
Anchors anchors_of(const Mesh& mesh, const HeadMesh& head, const std::vector<int>& given);

void add_shapes(BuiltCharacter& built, const CharacterForm& form, const FaceRegions& regions);
void add_rig(BuiltCharacter& built, const CharacterForm& form, const FaceRegions& regions);
void add_talking_clip(Character& character);
/// Limits on the turns of jaw and eyes; the talking clip stays within them.
void add_constraints(Character& character);
/// One influence object of each kind, or two, around the mouth, jaw, cheeks and nose of a rigged character with the 68 landmarks.
void add_influence_objects(Character& character);
/// Lets the objects of the mouth take part in the talking clip.
void move_objects_while_talking(Character& character);

/// Moves the whole character: positions, deltas, joints and translation keys; p -> R (scale p) + move.
void place(Character& character, double scale, const Eigen::Quaterniond& turn, const Vector3d& move);

}  // namespace mien::sample
