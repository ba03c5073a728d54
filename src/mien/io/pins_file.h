#pragma once
/// The pins file, the tags file and the rules file: what is held of a face, and what may move it.

#include <filesystem>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/character/region_rule.h"

namespace mien {

/// A slider's name in the file, with its range during the drag.
struct NamedLimits {
  int slider = 0;
  double low = 0, high = 1;
};

/// A joint that may move, with its limits from rest: radians, the character's unit.
struct NamedJoint {
  int node = 0;
  Eigen::Vector3d turn_low = Eigen::Vector3d::Zero(), turn_high = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_low = Eigen::Vector3d::Zero(), shift_high = Eigen::Vector3d::Zero();
};

struct PinSet {
  std::vector<Pin> pins;
  std::vector<int> locked;
  std::vector<NamedLimits> limits;
  std::vector<std::vector<int>> exclusive;
  std::vector<double> stiffness;  ///< #sliders or none
  std::vector<NamedJoint> joints;
  std::vector<int> wires;  ///< those that may move
};

/// {"pins": [{"at": POINT or {"joint": NAME}, "goal": [x, y, z] or "move": [dx, dy, dz], "axes": "xyz" or {"plane": [nx, ny,
/// nz]} or {"direction": [x, y, z]}, "weight": 1, "hard": false, "sliders": [NAME, ...]}], "locked": [NAME], "limits": {NAME:
/// [low, high]}, "exclusive": [[NAME, ...]], "stiffness": {NAME: number}, "joints": {NAME: {"turn": [[x, y, z], [x, y, z]],
/// "shift": ...}}, "wires": [NAME, ...]}.
///   throws  Error naming the file and the place: another form, names that the character does not have, numbers that are not
///           finite, a position farther from the surface than a tenth of the face
PinSet read_pins(const std::filesystem::path& path, const Character& character);

/// {"tags": [{"at": POINT, "axes": "xyz"}]}
///   throws  as read_pins
std::vector<Tag> read_tags(const std::filesystem::path& path, const Character& character);

/// {"rules": [{"name": "lids", "region": [POINT, ...], "radius": 0.1, "sliders": [NAME, ...], "at_most": 0.5}]}: the region is the
/// vertices of its points' parts within `radius` (0: the points alone); without "at_most" any distance.
///   throws  as read_pins
std::vector<RegionRule> read_region_rules(const std::filesystem::path& path, const Character& character);

}  // namespace mien
