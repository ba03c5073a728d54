// Most shapes are a few soft pulls on the skin; lids, lips and jaw have their own makers.

#include "mien/sample/detail/face_shapes.h"

#include <algorithm>
#include <cmath>

namespace mien::sample {

namespace {

/// Moves the skin around a point; the pull fades out at the ellipsoid's border.
struct Pull {
  enum class On { all, upper, lower };  ///< upper and lower: what the jaw does not carry, what it carries
  Vector3d centre, radii, move;
  On on = On::all;
};

using On = Pull::On;

Field pulled(const Face& face, const std::vector<Pull>& pulls) {
  const auto& [head, form, regions] = face;
  Field field(head.points.size(), Vector3d::Zero());
  for (std::size_t v = 0; v < field.size(); ++v)
    for (const Pull& pull : pulls) {
      double w = soft(head.points[v], pull.centre, pull.radii);
      if (pull.on == On::upper) w *= 1 - regions.lower[v];
      if (pull.on == On::lower) w *= regions.lower[v];
      field[v] += w * pull.move;
    }
  return field;
}

Field operator+(Field a, const Field& b) {
  for (std::size_t v = 0; v < a.size(); ++v) a[v] += b[v];
  return a;
}

/// Collects shapes by name, pairs from their left one.
class Shapes {
 public:
  explicit Shapes(const HeadMesh& head) : head_(head) {}
  void add(const std::string& name, Field skin) {
    list.push_back({name, std::move(skin), {}, {}, {}, {}, false});
  }
  /// NAME + Left and NAME + Right.
  void add_pair(const std::string& name, const Field& left) {
    add(name + "Left", left);
    add(name + "Right", mirrored(head_, left));
  }
  std::vector<FaceShape> list;

 private:
  const HeadMesh& head_;
};

void add_eyes(Shapes& shapes, const Face& face) {
  const auto lids = [&](double upper, double lower) { return lid_field(face, upper, lower); };
  const auto pull = [&](const std::vector<Pull>& pulls) { return pulled(face, pulls); };
  const auto gaze = [&](const Vector3d& axis, double degrees) {
    for (const bool left : {true, false}) {
      FaceShape& shape = shapes.list[shapes.list.size() - (left ? 2 : 1)];
      Motion& motion = left ? shape.eye_left : shape.eye_right;
      motion.centre = face.form.eye.centre;
      if (!left) motion.centre.x() *= -1;
      motion.axis = axis;
      motion.degrees = left || axis.x() != 0 ? degrees : -degrees;
    }
  };
  shapes.add_pair("eyeBlink", blink_field(face) + pull({{{3.2, 1.5, 8.2}, {2.2, 1.0, 2}, {0, -0.12, 0}}}));
  shapes.add_pair("eyeLookDown", lids(-15, -5));
  gaze(Vector3d::UnitX(), 24);
  shapes.add_pair("eyeLookIn", lids(-1, 1));
  gaze(Vector3d::UnitY(), -28);
  shapes.add_pair("eyeLookOut", lids(-1, 1));
  gaze(Vector3d::UnitY(), 28);
  shapes.add_pair("eyeLookUp", lids(8, 4));
  gaze(Vector3d::UnitX(), -22);
  shapes.add_pair("eyeSquint", lids(-7, 11) + pull({{{3.4, -1.7, 8.0}, {2.2, 1.2, 2}, {0.05, 0.3, 0.1}}}));
  shapes.add_pair("eyeWide", lids(11, -4) + pull({{{3.2, 1.6, 8.2}, {2.4, 1.1, 2}, {0, 0.15, 0}}}));
}

/// Adds the jaw's shapes and returns the open jaw's displacement.
Field add_jaw(Shapes& shapes, const Face& face) {
  const auto& [head, form, regions] = face;
  const auto add = [&](const std::string& name, const Motion& motion) {
    shapes.add(name, carried(head, regions.jaw, motion));
    shapes.list.back().lower_teeth = shapes.list.back().tongue = motion;
  };
  Motion forward, left, right;
  forward.move = {0, 0.04, 0.75};
  left.centre = right.centre = jaw_opening(0).centre;
  left.axis = right.axis = Vector3d::UnitY();
  left.degrees = 5;
  right.degrees = -5;
  add("jawForward", forward);
  add("jawLeft", left);
  add("jawRight", right);
  add("jawOpen", jaw_opening(20));
  // The upper lip makes way for the teeth.
  const MouthForm& m = form.mouth;
  shapes.list.back().skin =
      shapes.list.back().skin +
      pulled(face, {{{0, m.line + 0.4, m.front - 0.3}, {2.6, 2.0, 3}, {0, 0.22, 0}, On::upper}});
  return shapes.list.back().skin;
}

void add_lips(Shapes& shapes, const Face& face) {
  const auto pull = [&](const std::vector<Pull>& pulls) { return pulled(face, pulls); };
  const MouthForm& m = face.form.mouth;
  const Vector3d corner(m.width, m.corner, m.corner_front), middle(0, m.line, m.front - 0.4);
  shapes.add("mouthFunnel", lips_gathered(face, {0.3, 0.5, 0.6}));
  shapes.add("mouthPucker", lips_gathered(face, {0.5, 0.02, 0.85}));
  const Field aside = pull({{middle, {4.4, 3.2, 4}, {0.95, 0.06, -0.1}}});
  shapes.add("mouthLeft", aside);
  shapes.add("mouthRight", mirrored(face.head, aside));
  shapes.add_pair("mouthSmile",
                  pull({{corner, {3.0, 2.4, 3.6}, {0.75, 0.72, -0.6}},
                        {{1.0, m.line + 0.4, m.front - 0.4}, {2.2, 1.6, 3}, {0.05, 0.14, -0.06}, On::upper},
                        {{3.9, -4.0, 8.0}, {2.4, 2.2, 2.6}, {0.24, 0.36, 0.38}}}) +
                      lid_field(face, 0, 3));
  shapes.add_pair("mouthFrown", pull({{corner, {2.2, 2.0, 3}, {0.08, -0.75, -0.1}}}));
  shapes.add_pair("mouthDimple", pull({{corner, {1.9, 1.7, 2.4}, {0.4, 0.06, -0.55}}}));
  shapes.add_pair("mouthStretch", pull({{corner, {2.8, 2.3, 3.4}, {0.72, -0.32, -0.5}},
                                        {{3.4, -10, 6}, {2.6, 2.6, 4}, {0.15, -0.2, 0}}}));
  shapes.add("mouthRollLower", lip_roll(face, false));
  shapes.add("mouthRollUpper", lip_roll(face, true));
  shapes.add("mouthShrugLower",
             pull({{{0, m.line - 1.6, m.front - 0.4}, {3.2, 3.0, 3.4}, {0, 0.5, 0.18}, On::lower},
                   {{0, m.line, m.front - 0.3}, {2.8, 1.8, 3}, {0, 0.34, 0.12}, On::upper}}));
  shapes.add("mouthShrugUpper",
             pull({{{0, m.line + 0.4, m.front}, {2.9, 2.0, 3}, {0, 0.34, 0.22}, On::upper},
                   {{0, m.line, m.front - 0.3}, {2.5, 1.3, 3}, {0, 0.22, 0.1}, On::lower}}));
  shapes.add_pair("mouthPress", lip_press(face));
  shapes.add_pair("mouthLowerDown",
                  pull({{{1.1, m.line - 0.5, m.front - 0.5}, {2.2, 2.1, 3}, {0.1, -0.75, 0}, On::lower}}));
  shapes.add_pair("mouthUpperUp",
                  pull({{{1.1, m.line + 0.4, m.front - 0.5}, {2.2, 2.0, 3}, {0.08, 0.6, 0.05}, On::upper},
                        {{1.6, -4.2, 10}, {1.3, 1.3, 1.6}, {0.06, 0.14, 0}}}));
}

void add_brows_cheeks_nose(Shapes& shapes, const Face& face) {
  const auto pull = [&](const std::vector<Pull>& pulls) { return pulled(face, pulls); };
  shapes.add_pair("browDown", pull({{{1.7, 2.0, 9}, {2.3, 1.7, 2.6}, {-0.18, -0.55, 0.12}},
                                    {{3.8, 2.2, 8}, {2.3, 1.5, 2.6}, {-0.05, -0.36, 0.04}}}) +
                                  lid_field(face, -3, 0));
  const Field inner = pull({{{1.4, 2.4, 9}, {2.1, 2.6, 2.8}, {0.02, 0.72, -0.06}}});
  shapes.add("browInnerUp", inner + mirrored(face.head, inner));
  shapes.add_pair("browOuterUp",
                  pull({{{4.2, 2.4, 7.8}, {2.3, 2.6, 2.8}, {0.04, 0.75, -0.12}}}) + lid_field(face, 2, 0));
  const Field puff = pull({{{3.9, -6.0, 7.6}, {2.7, 3.2, 3.6}, {0.8, 0, 0.5}}});
  shapes.add("cheekPuff", puff + mirrored(face.head, puff) + lips_gathered(face, {0.06, 0, 0.12}));
  shapes.add_pair("cheekSquint",
                  pull({{{3.7, -2.4, 8}, {2.3, 1.9, 2.6}, {0.08, 0.55, 0.22}}}) + lid_field(face, 0, 6));
  shapes.add_pair("noseSneer", pull({{{1.3, -3.4, 10}, {1.5, 2.2, 2.2}, {0.05, 0.5, 0.06}, On::upper},
                                     {{1.4, -6.1, 10}, {1.5, 1.3, 2.2}, {0.02, 0.3, 0.03}, On::upper},
                                     {{1.2, 1.6, 9}, {1.3, 1.2, 2}, {-0.04, -0.2, 0.05}}}));
}

/// ARKit's own order.
const char* const kOrder[52] = {
    "browDownLeft",      "browDownRight",      "browInnerUp",         "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",     "cheekSquintRight",
    "eyeBlinkLeft",      "eyeBlinkRight",      "eyeLookDownLeft",     "eyeLookDownRight",
    "eyeLookInLeft",     "eyeLookInRight",     "eyeLookOutLeft",      "eyeLookOutRight",
    "eyeLookUpLeft",     "eyeLookUpRight",     "eyeSquintLeft",       "eyeSquintRight",
    "eyeWideLeft",       "eyeWideRight",       "jawForward",          "jawLeft",
    "jawOpen",           "jawRight",           "mouthClose",          "mouthDimpleLeft",
    "mouthDimpleRight",  "mouthFrownLeft",     "mouthFrownRight",     "mouthFunnel",
    "mouthLeft",         "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft",
    "mouthPressRight",   "mouthPucker",        "mouthRight",          "mouthRollLower",
    "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",     "mouthSmileLeft",
    "mouthSmileRight",   "mouthStretchLeft",   "mouthStretchRight",   "mouthUpperUpLeft",
    "mouthUpperUpRight", "noseSneerLeft",      "noseSneerRight",      "tongueOut"};

}  // namespace

std::vector<FaceShape> make_face_shapes(const Face& face) {
  Shapes shapes(face.head);
  add_eyes(shapes, face);
  const Field jaw_open = add_jaw(shapes, face);
  shapes.add("mouthClose", mouth_close(face, jaw_open));
  add_lips(shapes, face);
  add_brows_cheeks_nose(shapes, face);
  // The tongue comes out between parted lips.
  const Motion parted = jaw_opening(7);
  shapes.add("tongueOut", carried(face.head, face.regions.jaw, parted));
  shapes.list.back().lower_teeth = parted;
  shapes.list.back().tongue_out = true;

  std::vector<FaceShape> ordered;
  for (const char* name : kOrder)
    ordered.push_back(*std::find_if(shapes.list.begin(), shapes.list.end(),
                                    [&](const FaceShape& s) { return s.name == name; }));
  return ordered;
}

}  // namespace mien::sample
