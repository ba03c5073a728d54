// A child of an animated film: a big round head, wide eyes, a button nose and a broad mouth.

#include "mien/sample/detail/character_form.h"

namespace mien::sample {

namespace {

Sculpt cartoon_sculpt() {
  return Sculpt({
      // Skull and face.
      ellipsoid({0, 4.4, -0.6}, {8.8, 8.0, 8.6}, 1),
      ellipsoid({0, -2.0, 1.8}, {7.2, 6.2, 5.8}, 3),
      // Neck.
      capsule({0, -16, -1.8}, 3.1, {0, -5, -1.0}, 2.7, 2),
      // Jaw and chin.
      ellipsoid({0, -6.2, 3.6}, {4.4, 2.6, 3.8}, 2.5),
      ellipsoid({0, -7.5, 6.0}, {1.6, 1.1, 1.4}, 2),
      // Round cheeks, the upper jaw behind the lips.
      ellipsoid({4.2, -3.7, 4.4}, {2.9, 2.5, 2.9}, 2.2).both(),
      ellipsoid({0, -5.0, 4.9}, {4.2, 2.3, 3.5}, 2),
      // Brows.
      capsule({1.4, 3.5, 7.2}, 0.7, {5.2, 3.5, 5.6}, 0.6, 2).both(),
      // Sockets, then the lids around the eyeballs.
      ellipsoid({3.4, 0.2, 8.2}, {2.6, 2.2, 1.6}, 2).cut().both(),
      ellipsoid({3.3, 0.3, 4.9}, {2.95, 2.95, 2.95}, 1.2).both(),
      // Nose: bridge, button, wings.
      capsule({0, 0.6, 7.0}, 0.6, {0, -2.0, 8.3}, 0.6, 1.4),
      ellipsoid({0, -2.5, 8.7}, {1.15, 0.95, 1.1}, 0.9),
      ellipsoid({0.85, -2.75, 8.2}, {0.5, 0.5, 0.6}, 0.6).both(),
      // Lips, curled up at the corners.
      capsule({0, -4.82, 8.0}, 0.3, {1.4, -4.76, 7.75}, 0.28, 0.9).both(),
      capsule({1.4, -4.76, 7.75}, 0.28, {3.5, -4.5, 6.15}, 0.16, 0.9).both(),
      capsule({0, -5.45, 7.85}, 0.38, {1.3, -5.38, 7.65}, 0.36, 0.12).both(),
      capsule({1.3, -5.38, 7.65}, 0.36, {3.4, -4.68, 6.15}, 0.16, 0.15).both(),
      // The furrow above the chin.
      ellipsoid({0, -6.5, 8.2}, {1.5, 0.35, 0.8}, 1).cut(),
  });
}

HeadForm cartoon_head() {
  HeadForm form;
  form.sculpt = cartoon_sculpt();
  form.eye.centre = {3.3, 0.3, 4.9};
  form.eye.radius = 2.75;
  form.eye.lid_thickness = 0.2;
  form.eye.inner = -50;
  form.eye.outer = 58;
  form.eye.inner_tilt = -4;
  form.eye.outer_tilt = 4;
  form.eye.upper = 36;
  form.eye.lower = -31;
  form.eye.sharpness = 1.0;
  form.mouth.width = 3.4;
  form.mouth.line = -5.06;
  form.mouth.corner = -4.58;
  form.mouth.upper_border = -4.58;
  form.mouth.bow = 0.08;
  form.mouth.lower_border = -5.78;
  form.mouth.front = 7.98;
  form.mouth.corner_front = 6.2;
  form.mouth.bag_width = 3.1;
  form.mouth.bag_height = 1.6;
  form.mouth.bag_depth = 5;
  form.nostril.centre = {0.5, -3.25, 8.45};
  form.nostril.inward = {0.1, 0.95, -0.2};
  form.nostril.length = 0.26;
  form.nostril.width = 0.17;
  form.nostril.depth = 0.5;
  form.ear.centre = {8.0, -0.9, -0.9};
  form.ear.root_height = 2.0;
  form.ear.root_width = 0.8;
  form.ear.tilt = 10;
  form.ear.flare = 40;
  form.ear.up = 3.0;
  form.ear.down = 2.6;
  form.ear.back = 3.0;
  form.ear.ahead = 0.8;
  form.ear.stand = 0.8;
  form.ear.rim = 0.4;
  form.grid.rows = {
      {0, -12.0, -1.4, 0, 0, 0},    // base of the neck
      {3, -9.2, -1.0, -4, 4, 8},    // under the jaw
      {3, -5.0, 0.0, -28, -12, 4},  // bottom of the chin
      {3, -4.5, 0.0, -17, -4, 6},   // below the mouth
      {6, -3.0, 0.0, -8, 0, 6},     // above the mouth
      {3, -2.5, 0.0, 0, 4, 8},      // tip of the nose
      {3, -1.0, 0.0, -7, 2, 6},     // below the eyes
      {10, 1.4, 0.0, 17, 12, 12},   // brows
      {5, 4.0, -0.5, 34, 38, 38},   // hairline
  };
  form.grid.columns = {{0, 0}, {6, 8}, {10, 50}, {4, 90}, {4, 122}, {6, 180}};
  form.grid.eye = {6, 16, 21, 31};
  form.grid.mouth = {0, 12, 9, 15};
  form.grid.nostril = {2, 4, 15, 17};
  form.grid.ear = {20, 24, 18, 28};
  form.grid.crown_width = 8;
  form.grid.eye_rings = 5;
  form.grid.mouth_rings = 4;
  return form;
}

}  // namespace

CharacterForm cartoon_character() {
  CharacterForm form;
  form.name = "cartoon";
  form.head = cartoon_head();
  form.upper_teeth.width = 2.7;
  form.upper_teeth.depth = 4.0;
  form.upper_teeth.front = 7.35;
  form.upper_teeth.edge = -5.25;
  form.upper_teeth.height = 0.9;
  form.upper_teeth.teeth = 10;
  form.lower_teeth = form.upper_teeth;
  form.lower_teeth.width = 2.55;
  form.lower_teeth.front = 7.0;
  form.lower_teeth.edge = -5.15;
  form.lower_teeth.height = -0.7;
  form.tongue.root = {0, -6.2, 2.6};
  form.tongue.middle = {0, -5.6, 4.8};
  form.tongue.tip = {0, -5.7, 6.6};
  form.tongue.width = 2.0;
  form.brows.line = {{1.3, 3.9, 8}, {2.6, 4.5, 7.6}, {3.9, 4.7, 7.0}, {5.1, 4.4, 6.2}, {6.1, 3.6, 5.2}};
  form.brows.height = 1.0;
  form.brows.thickness = 0.35;
  form.lashes = 0.55;
  form.iris = 31;
  form.landmarks.jaw = {{0, -8.5, 6.6},   {1.5, -8.3, 5.9}, {2.9, -7.8, 4.8},
                        {4.2, -7.0, 3.6}, {5.4, -6.0, 2.6}, {6.4, -4.8, 1.9},
                        {7.1, -3.4, 1.4}, {7.7, -1.9, 1.0}, {8.2, -0.2, 0.8}};
  form.landmarks.brow = {
      {1.05, 4.3, 8.05}, {2.35, 4.5, 7.85}, {3.95, 4.6, 7.2}, {6.05, 4.3, 5.9}, {6.75, 3.95, 5.0}};
  form.landmarks.nose = {{0, 0.3, 8.1}, {0, -0.8, 8.5}, {0, -1.75, 9.2}, {0, -2.6, 9.7}};
  form.landmarks.base = {{0, -4.08, 8.5}, {0.48, -4.1, 8.3}, {1.2, -3.1, 8.1}};
  form.materials = {
      plain_material("skin", 0.93f, 0.69f, 0.55f),   plain_material("eye white", 0.97f, 0.97f, 0.96f),
      plain_material("iris", 0.30f, 0.52f, 0.28f),   plain_material("pupil", 0.02f, 0.02f, 0.02f),
      plain_material("teeth", 0.97f, 0.96f, 0.92f),  plain_material("gum", 0.80f, 0.42f, 0.42f),
      plain_material("tongue", 0.85f, 0.42f, 0.42f), plain_material("hair", 0.30f, 0.15f, 0.07f),
      plain_material("mouth", 0.45f, 0.15f, 0.15f),  plain_material("lips", 0.86f, 0.50f, 0.44f),
      plain_material("limbus", 0.16f, 0.30f, 0.14f)};
  return form;
}

}  // namespace mien::sample
