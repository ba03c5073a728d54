// A goblin: heavy brow, small deep eyes, a muzzle with fangs, long pointed ears.

#include "mien/sample/detail/character_form.h"

namespace mien::sample {

namespace {

Sculpt creature_sculpt() {
  return Sculpt({
      // A low skull that runs far back, and the face in front of it.
      ellipsoid({0, 2.4, -1.6}, {7.0, 5.8, 9.2}, 1),
      ellipsoid({0, -1.8, 2.8}, {5.7, 5.2, 5.6}, 2),
      // Thick neck.
      capsule({0, -16, -4.6}, 5.6, {0, -4, -3.0}, 5.2, 3),
      capsule({5.2, -3.6, -3.0}, 1.2, {2.0, -16, 0.6}, 1.0, 2).both(),
      // Muzzle, lower jaw, broad chin, jaw corners.
      ellipsoid({0, -4.4, 6.0}, {4.0, 2.7, 5.2}, 2.5),
      ellipsoid({0, -6.8, 4.6}, {4.4, 2.2, 5.6}, 2),
      ellipsoid({0, -7.7, 8.6}, {2.5, 1.4, 1.9}, 1.6),
      ellipsoid({4.9, -5.2, 2.6}, {1.7, 2.4, 2.6}, 2).both(),
      // Cheekbones and hollows below them.
      capsule({4.2, -1.9, 6.2}, 1.0, {6.2, -0.6, 1.6}, 0.9, 1.4).both(),
      ellipsoid({6.6, -3.4, 6.0}, {1.6, 1.4, 2.4}, 1.6).cut().both(),
      // The brow: a heavy roof, lower towards the nose.
      capsule({0.7, 1.7, 8.0}, 1.2, {4.6, 2.7, 5.9}, 1.15, 1.2).both(),
      ellipsoid({8.4, 2.4, 4.2}, {1.9, 2.4, 3.0}, 2).cut().both(),
      // Sockets, then the lids.
      ellipsoid({2.9, 0.0, 8.6}, {1.7, 0.9, 1.7}, 1.2).cut().both(),
      ellipsoid({2.9, -0.1, 6.4}, {1.5, 1.5, 1.5}, 0.8).both(),
      // A flat broad nose with wrinkles over its root.
      capsule({0, 0.6, 7.8}, 0.9, {0, -2.2, 10.4}, 0.9, 1.2),
      ellipsoid({0, -2.7, 10.9}, {1.3, 0.9, 1.0}, 0.8),
      ellipsoid({1.25, -2.9, 10.4}, {0.75, 0.7, 0.9}, 0.5).both(),
      // Lips: thin, over a wide mouth that runs back along the muzzle.
      capsule({0, -4.6, 10.7}, 0.4, {1.5, -4.55, 10.3}, 0.4, 0.8).both(),
      capsule({1.5, -4.55, 10.3}, 0.4, {3.7, -4.75, 7.6}, 0.25, 0.8).both(),
      capsule({0, -5.55, 10.5}, 0.5, {1.5, -5.5, 10.1}, 0.48, 0.15).both(),
      capsule({1.5, -5.5, 10.1}, 0.48, {3.6, -5.05, 7.6}, 0.25, 0.2).both(),
      // A low keel over the skull, and two bumps where horns might grow.
      capsule({0, 6.4, 4.0}, 0.8, {0, 7.3, -2.0}, 0.9, 2.5),
      capsule({0, 7.3, -2.0}, 0.9, {0, 5.6, -7.4}, 0.8, 2.5),
      capsule({3.4, 5.6, 3.4}, 1.15, {4.7, 8.2, 2.6}, 0.45, 1.2).both(),
      // Warts along the brow's end.
      ellipsoid({5.9, 3.6, 4.4}, {0.7, 0.7, 0.7}, 0.8).both(),
      ellipsoid({6.2, 4.2, 2.2}, {0.6, 0.6, 0.6}, 0.8).both(),
  });
}

HeadForm creature_head() {
  HeadForm form;
  form.sculpt = creature_sculpt();
  form.eye.centre = {2.9, -0.1, 6.4};
  form.eye.radius = 1.35;
  form.eye.lid_thickness = 0.15;
  form.eye.inner = -58;
  form.eye.outer = 56;
  form.eye.inner_tilt = -12;
  form.eye.outer_tilt = 12;
  form.eye.upper = 17;
  form.eye.lower = -22;
  form.mouth.width = 3.7;
  form.mouth.line = -5.02;
  form.mouth.corner = -4.9;
  form.mouth.upper_border = -4.25;
  form.mouth.bow = 0.05;
  form.mouth.lower_border = -6.0;
  form.mouth.front = 10.75;
  form.mouth.corner_front = 7.6;
  form.mouth.bag_width = 3.4;
  form.mouth.bag_height = 1.7;
  form.mouth.bag_depth = 7;
  form.nostril.centre = {0.75, -3.4, 10.9};
  form.nostril.inward = {0.1, 0.7, -0.7};
  form.nostril.length = 0.42;
  form.nostril.width = 0.32;
  form.nostril.turn = -30;
  form.nostril.depth = 0.8;
  form.ear.centre = {6.6, -0.2, -1.2};
  form.ear.root_height = 1.9;
  form.ear.root_width = 0.8;
  form.ear.tilt = 22;
  form.ear.flare = 52;
  form.ear.up = 2.3;
  form.ear.down = 2.2;
  form.ear.back = 3.4;
  form.ear.ahead = 0.8;
  form.ear.point = 3.4;
  form.ear.stand = 0.6;
  form.ear.rim = 0.35;
  form.grid.rows = {
      {0, -12.5, -3.8, 0, 0, 4},    // base of the neck
      {3, -9.6, -3.2, -6, 10, 22},  // under the jaw
      {4, -5.0, 0.0, -24, 0, 16},   // bottom of the chin
      {4, -4.6, 0.0, -15, -2, 14},  // below the mouth
      {8, -3.6, 0.0, -2, 2, 12},    // above the mouth
      {3, -3.2, 0.0, 3, 6, 12},     // tip of the nose
      {6, -1.4, 0.0, 0, 3, 12},     // below the eyes
      {8, 0.6, 0.0, 10, 8, 14},     // brows
      {7, 2.4, -1.0, 30, 36, 34},   // top of the forehead
  };
  form.grid.columns = {{0, 0}, {7, 11}, {9, 40}, {6, 88}, {5, 120}, {7, 180}};
  form.grid.eye = {7, 16, 28, 36};
  form.grid.mouth = {0, 13, 11, 19};
  form.grid.nostril = {2, 5, 19, 21};
  form.grid.ear = {22, 27, 25, 35};
  form.grid.crown_width = 8;
  return form;
}

}  // namespace

CharacterForm creature_character() {
  CharacterForm form;
  form.name = "creature";
  form.head = creature_head();
  form.upper_teeth.width = 2.9;
  form.upper_teeth.depth = 6.0;
  form.upper_teeth.front = 9.7;
  form.upper_teeth.edge = -5.1;
  form.upper_teeth.height = 0.9;
  form.upper_teeth.pointed = 0.8;
  form.lower_teeth = form.upper_teeth;
  form.lower_teeth.width = 2.75;
  form.lower_teeth.front = 9.5;
  form.lower_teeth.edge = -5.0;
  form.lower_teeth.height = -0.9;
  form.lower_teeth.fang = 0.3;
  form.tongue.root = {0, -6.6, 3.4};
  form.tongue.middle = {0, -5.7, 6.2};
  form.tongue.tip = {0, -5.8, 8.8};
  form.tongue.width = 1.7;
  form.iris = 30;
  form.landmarks.jaw = {{0, -9.0, 9.2},   {1.9, -8.7, 8.4}, {3.4, -8.2, 6.8},
                        {4.6, -7.6, 5.2}, {5.5, -6.9, 3.8}, {6.2, -5.8, 2.6},
                        {6.5, -4.4, 1.8}, {6.6, -2.8, 1.2}, {6.9, -1.0, 0.8}};
  form.landmarks.brow = {
      {0.85, 2.35, 9.4}, {2.15, 2.4, 8.7}, {3.15, 2.75, 8.0}, {4.25, 2.95, 7.05}, {4.8, 3.1, 6.7}};
  form.landmarks.nose = {{0, 0.05, 9.6}, {0, -1.0, 10.4}, {0, -1.85, 11.2}, {0, -2.7, 11.85}};
  form.landmarks.base = {{0, -3.95, 11.3}, {0.85, -3.97, 11.1}, {1.9, -3.2, 10.3}};
  form.materials = {
      plain_material("skin", 0.42f, 0.55f, 0.30f),   plain_material("eye white", 0.93f, 0.88f, 0.60f),
      plain_material("iris", 0.80f, 0.42f, 0.06f),   plain_material("pupil", 0.02f, 0.02f, 0.02f),
      plain_material("teeth", 0.90f, 0.86f, 0.68f),  plain_material("gum", 0.45f, 0.25f, 0.27f),
      plain_material("tongue", 0.55f, 0.28f, 0.33f), plain_material("hair", 0.10f, 0.10f, 0.08f),
      plain_material("mouth", 0.25f, 0.11f, 0.11f),  plain_material("lips", 0.33f, 0.40f, 0.24f),
      plain_material("limbus", 0.45f, 0.18f, 0.02f)};
  return form;
}

}  // namespace mien::sample
