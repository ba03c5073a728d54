// Regions by words that names have, and by ARKit's names for what a slider does: those stand for all conventions that the tables
// know. The panel shows the face as one looks at it: the character's right side is on the left.
#include "mien/controls/make_controls.h"

namespace mien {
namespace {

using RegionSide = ControlRegion::Side;

/// The same region for what is right, left, and neither.
void add_sides(std::vector<ControlRegion>& regions, const std::string& name,
               const std::vector<std::string>& match) {
  regions.push_back({name + " right", match, RegionSide::right});
  regions.push_back({name + " left", match, RegionSide::left});
  regions.push_back({name, match, RegionSide::any});
}

std::vector<ControlRegion> face_regions() {
  std::vector<ControlRegion> regions = {
      {"visemes", {"viseme*", "aa", "ih", "ou", "ee", "oh"}, RegionSide::any},
      {"expressions",
       {"happy", "angry", "sad", "relaxed", "surprised", "neutral", "joy", "fun", "sorrow", "expression*"},
       RegionSide::any}};
  add_sides(regions, "brows", {"*brow*", "*forehead*"});
  regions.push_back({"gaze", {"lookAt*", "look?At*", "gaze*"}, RegionSide::any});
  add_sides(regions, "eyes",
            {"*eye*", "lid*", "*_lid*", "*.lid*", "*blink*", "*lash*", "lookUp", "lookDown", "lookLeft",
             "lookRight"});
  regions.push_back({"nose", {"*nose*", "*nostril*", "*sneer*"}, RegionSide::any});
  add_sides(regions, "cheeks", {"*cheek*"});
  regions.push_back({"tongue", {"*tongue*"}, RegionSide::any});
  regions.push_back({"jaw", {"*jaw*", "*chin*", "*teeth*", "*tooth*", "*mandible*"}, RegionSide::any});
  add_sides(regions, "mouth", {"*mouth*", "*lip*", "*smile*", "*frown*", "*pucker*"});
  regions.push_back({"ears", {"ear*", "*_ear*", "*.ear*"}, RegionSide::any});
  regions.push_back({"head",
                     {"*head*", "*neck*", "*skull*", "*spine*", "*chest*", "root", "hips", "pelvis"},
                     RegionSide::any});
  return regions;
}

std::vector<ControlPad> face_pads() {
  return {
      {"lookRight",
       "look",
       "eyes right",
       {"eyeLookInRight", "eyeLookOutRight", "eyeLookUpRight", "eyeLookDownRight"}},
      {"lookLeft",
       "look",
       "eyes left",
       {"eyeLookOutLeft", "eyeLookInLeft", "eyeLookUpLeft", "eyeLookDownLeft"}},
      {"lidRight", "lid", "eyes right", {"", "", "eyeWideRight", "eyeBlinkRight"}},
      {"lidLeft", "lid", "eyes left", {"", "", "eyeWideLeft", "eyeBlinkLeft"}},
      {"browRight", "brow", "brows right", {"", "", "browOuterUpRight", "browDownRight"}},
      {"browLeft", "brow", "brows left", {"", "", "browOuterUpLeft", "browDownLeft"}},
      {"cornerRight",
       "corner",
       "mouth right",
       {"", "mouthStretchRight", "mouthSmileRight", "mouthFrownRight"}},
      {"cornerLeft", "corner", "mouth left", {"mouthStretchLeft", "", "mouthSmileLeft", "mouthFrownLeft"}},
      {"jaw", "jaw", "jaw", {"jawLeft", "jawRight", "", "jawOpen"}},
      {"mouth", "mouth", "mouth", {"mouthLeft", "mouthRight", "", ""}},
  };
}

}  // namespace

const ControlConfig& default_control_config() {
  static const ControlConfig config = [] {
    ControlConfig made;
    made.regions = face_regions();
    made.pads = face_pads();
    made.moves = {"*head*", "*root*", "hips", "pelvis", "lookAt*"};
    made.layout.columns = {{"brows right", "eyes right", "cheeks right", "mouth right"},
                           {"brows", "gaze", "eyes", "nose", "cheeks", "mouth", "jaw", "tongue"},
                           {"brows left", "eyes left", "cheeks left", "mouth left"},
                           {"head", "ears", "visemes", "expressions", "other"}};
    return made;
  }();
  return config;
}

}  // namespace mien
