#pragma once
/// What a shape or slider does, whatever it is called: names of ARKit, Live Link Face, ICT-FaceKit, MakeHuman's
/// pose units, FACS action units, VRM 1.0 expressions and the usual fifteen visemes, in terms of ARKit's 52
/// shapes ("actions").

#include <string>
#include <string_view>
#include <vector>

namespace mien {

enum class Convention { arkit, live_link, ict, face_cap, makehuman, facs, vrm, visemes };
constexpr int convention_count = 8;

/// ARKit's 52 shapes in Apple's order: `eyeBlinkLeft` ...
const std::vector<std::string>& action_names();

/// How much of an action a name stands for.
struct ActionShare {
  int action = 0;    ///< index into action_names()
  double share = 1;  ///< of the action when the name's slider is at 1
  bool operator==(const ActionShare&) const = default;
};

/// What `name` does: one action for the most part, two for a name that does both sides (`browDown`, `AU12`) or one
/// that ARKit splits, several for a viseme. Case, separators and the way of writing sides (Left, _L, .l, L_) do not
/// matter. None: the name is not known.
std::vector<ActionShare> actions_of(std::string_view name);

/// What a convention calls each action, "" where it has no name for it alone. A convention that has one name for
/// both sides gives it to both.
///   returns  52 names
std::vector<std::string> names_in(Convention convention);

/// The convention that has most of these names, and how many.
struct FoundConvention {
  Convention convention = Convention::arkit;
  int known = 0;
};
FoundConvention find_convention(const std::vector<std::string>& names);

/// "arkit", "live-link", "ict", "face-cap", "makehuman", "facs", "vrm", "visemes".
std::string_view name_of(Convention convention);

///   throws  invalid_input: no such convention
Convention convention_of_name(std::string_view name);

/// A joint's name to compare with others: lower case, letters and digits alone, without what stands in front of the last
/// ":" or "|".
std::string bare_name(std::string_view name);

enum class Side { none, left, right };

/// The side that a name tells: mouthSmileLeft, eyeBlink_L, L_brow; none for a name without one.
Side side_of_name(std::string_view name);

/// The name of the other side: mouthSmileLeft for mouthSmileRight, eyeBlink_R for eyeBlink_L, L_brow for R_brow;
/// empty for a name without a side.
std::string mirrored_name(std::string_view name);

}  // namespace mien
