// ARKit: developer.apple.com, ARFaceAnchor.BlendShapeLocation. FACS: Ekman, Friesen and Hager 2002, with the ARKit
// shapes that do the same. VRM: vrm-c/vrm-specification, VRMC_vrm-1.0 expressions. Visemes: the fifteen of Oculus
// Lipsync. What ARKit has no single shape for is a recipe of ours.
#include "mien/naming/detail/tables.h"

namespace mien {

const std::vector<std::string>& action_names() {
  static const std::vector<std::string> names = {
      "eyeBlinkLeft",      "eyeLookDownLeft",    "eyeLookInLeft",
      "eyeLookOutLeft",    "eyeLookUpLeft",      "eyeSquintLeft",
      "eyeWideLeft",       "eyeBlinkRight",      "eyeLookDownRight",
      "eyeLookInRight",    "eyeLookOutRight",    "eyeLookUpRight",
      "eyeSquintRight",    "eyeWideRight",       "jawForward",
      "jawLeft",           "jawRight",           "jawOpen",
      "mouthClose",        "mouthFunnel",        "mouthPucker",
      "mouthLeft",         "mouthRight",         "mouthSmileLeft",
      "mouthSmileRight",   "mouthFrownLeft",     "mouthFrownRight",
      "mouthDimpleLeft",   "mouthDimpleRight",   "mouthStretchLeft",
      "mouthStretchRight", "mouthRollLower",     "mouthRollUpper",
      "mouthShrugLower",   "mouthShrugUpper",    "mouthPressLeft",
      "mouthPressRight",   "mouthLowerDownLeft", "mouthLowerDownRight",
      "mouthUpperUpLeft",  "mouthUpperUpRight",  "browDownLeft",
      "browDownRight",     "browInnerUp",        "browOuterUpLeft",
      "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",
      "cheekSquintRight",  "noseSneerLeft",      "noseSneerRight",
      "tongueOut"};
  return names;
}

namespace detail {

const std::vector<Recipe>& recipes() {
  using C = Convention;
  static const std::vector<Recipe> table = {
      {C::ict, "cheekRaiser", {{"cheekSquint", 0.5}}},
      {C::makehuman, "eye-closure", {{"eyeBlink"}}},
      {C::makehuman, "eye-opened-up", {{"eyeWide"}}},
      {C::makehuman, "eye-slit", {{"eyeSquint"}}},
      {C::makehuman, "eyebrows-down", {{"browDown"}}},
      {C::makehuman, "eyebrows-extern-up", {{"browOuterUp"}}},
      {C::makehuman, "eyebrows-inner-up", {{"browInnerUp"}}},
      {C::makehuman, "eyebrows-up", {{"browInnerUp", 0.5}, {"browOuterUp", 0.5}}},
      {C::makehuman, "mouth-compression", {{"mouthPress"}}},
      {C::makehuman, "mouth-corner-puller", {{"mouthSmile"}}},
      {C::makehuman, "mouth-depression", {{"mouthFrown"}}},
      {C::makehuman, "mouth-depression-retraction", {{"mouthStretch", 0.5}, {"mouthLowerDown", 0.5}}},
      {C::makehuman, "mouth-elevation", {{"mouthShrugUpper"}}},
      {C::makehuman, "mouth-eversion", {{"mouthFunnel"}}},
      {C::makehuman, "mouth-open", {{"jawOpen"}}},
      {C::makehuman, "mouth-pursing", {{"mouthPucker"}}},
      {C::makehuman, "mouth-retraction", {{"mouthStretch"}}},
      {C::makehuman, "mouth-upward-retraction", {{"mouthUpperUp", 0.5}, {"mouthSmile", 0.5}}},
      {C::makehuman, "nose-elevation", {{"noseSneer"}}},
      {C::facs, "AU1", {{"browInnerUp"}}},
      {C::facs, "AU2", {{"browOuterUp"}}},
      {C::facs, "AU4", {{"browDown"}}},
      {C::facs, "AU5", {{"eyeWide"}}},
      {C::facs, "AU6", {{"cheekSquint"}}},
      {C::facs, "AU7", {{"eyeSquint"}}},
      {C::facs, "AU9", {{"noseSneer"}}},
      {C::facs, "AU10", {{"mouthUpperUp"}}},
      {C::facs, "AU12", {{"mouthSmile"}}},
      {C::facs, "AU14", {{"mouthDimple"}}},
      {C::facs, "AU15", {{"mouthFrown"}}},
      {C::facs, "AU16", {{"mouthLowerDown"}}},
      {C::facs, "AU17", {{"mouthShrugLower"}}},
      {C::facs, "AU18", {{"mouthPucker"}}},
      {C::facs, "AU19", {{"tongueOut"}}},
      {C::facs, "AU20", {{"mouthStretch"}}},
      {C::facs, "AU22", {{"mouthFunnel"}}},
      {C::facs, "AU24", {{"mouthPress"}}},
      {C::facs, "AU26", {{"jawOpen", 0.5}}},
      {C::facs, "AU27", {{"jawOpen"}}},
      {C::facs, "AU28", {{"mouthRollLower"}, {"mouthRollUpper"}}},
      {C::facs, "AU29", {{"jawForward"}}},
      {C::facs, "AU34", {{"cheekPuff"}}},
      {C::facs, "AU43", {{"eyeBlink"}}},
      {C::facs, "AU45", {{"eyeBlink"}}},
      {C::facs, "AU61", {{"eyeLookOutLeft"}, {"eyeLookInRight"}}},
      {C::facs, "AU62", {{"eyeLookInLeft"}, {"eyeLookOutRight"}}},
      {C::facs, "AU63", {{"eyeLookUp"}}},
      {C::facs, "AU64", {{"eyeLookDown"}}},
      {C::vrm, "happy", {{"mouthSmile", 0.8}, {"cheekSquint", 0.5}, {"eyeSquint", 0.3}}},
      {C::vrm, "angry", {{"browDown", 0.9}, {"noseSneer", 0.5}, {"mouthFrown", 0.5}, {"eyeSquint", 0.3}}},
      {C::vrm, "sad", {{"browInnerUp", 0.8}, {"mouthFrown", 0.7}, {"eyeBlink", 0.15}}},
      {C::vrm, "relaxed", {{"mouthSmile", 0.35}, {"eyeBlink", 0.3}}},
      {C::vrm, "surprised", {{"browInnerUp", 0.8}, {"browOuterUp", 0.8}, {"eyeWide", 0.7}, {"jawOpen", 0.4}}},
      {C::vrm, "aa", {{"jawOpen", 0.6}, {"mouthLowerDown", 0.3}, {"mouthUpperUp", 0.2}}},
      {C::vrm, "ih", {{"jawOpen", 0.2}, {"mouthStretch", 0.4}, {"mouthSmile", 0.2}}},
      {C::vrm, "ou", {{"jawOpen", 0.2}, {"mouthPucker", 0.8}}},
      {C::vrm, "ee", {{"jawOpen", 0.25}, {"mouthSmile", 0.4}, {"mouthUpperUp", 0.2}}},
      {C::vrm, "oh", {{"jawOpen", 0.45}, {"mouthFunnel", 0.6}}},
      {C::vrm, "blink", {{"eyeBlink"}}},
      {C::vrm, "lookUp", {{"eyeLookUp"}}},
      {C::vrm, "lookDown", {{"eyeLookDown"}}},
      {C::vrm, "lookLeft", {{"eyeLookOutLeft"}, {"eyeLookInRight"}}},
      {C::vrm, "lookRight", {{"eyeLookInLeft"}, {"eyeLookOutRight"}}},
      {C::visemes, "viseme_sil", {}},
      {C::visemes, "viseme_PP", {{"mouthPress", 0.6}, {"mouthRollLower", 0.3}, {"mouthRollUpper", 0.3}}},
      {C::visemes, "viseme_FF", {{"mouthRollLower", 0.6}, {"mouthUpperUp", 0.3}, {"jawOpen", 0.05}}},
      {C::visemes, "viseme_TH", {{"jawOpen", 0.2}, {"tongueOut", 0.25}, {"mouthLowerDown", 0.2}}},
      {C::visemes, "viseme_DD", {{"jawOpen", 0.15}, {"mouthStretch", 0.2}, {"mouthLowerDown", 0.3}}},
      {C::visemes, "viseme_kk", {{"jawOpen", 0.25}, {"mouthLowerDown", 0.25}, {"mouthUpperUp", 0.15}}},
      {C::visemes, "viseme_CH", {{"jawOpen", 0.1}, {"mouthFunnel", 0.6}, {"mouthPucker", 0.3}}},
      {C::visemes, "viseme_SS", {{"jawOpen", 0.08}, {"mouthStretch", 0.4}, {"mouthLowerDown", 0.3}}},
      {C::visemes, "viseme_nn", {{"jawOpen", 0.15}, {"mouthLowerDown", 0.2}, {"mouthUpperUp", 0.1}}},
      {C::visemes, "viseme_RR", {{"jawOpen", 0.15}, {"mouthFunnel", 0.5}, {"mouthPucker", 0.2}}},
      {C::visemes, "viseme_aa", {{"jawOpen", 0.65}, {"mouthLowerDown", 0.3}}},
      {C::visemes, "viseme_E", {{"jawOpen", 0.3}, {"mouthSmile", 0.3}, {"mouthStretch", 0.2}}},
      {C::visemes, "viseme_I", {{"jawOpen", 0.2}, {"mouthSmile", 0.4}, {"mouthStretch", 0.3}}},
      {C::visemes, "viseme_O", {{"jawOpen", 0.45}, {"mouthFunnel", 0.6}}},
      {C::visemes, "viseme_U", {{"jawOpen", 0.2}, {"mouthPucker", 0.8}}},
  };
  return table;
}

}  // namespace detail
}  // namespace mien
