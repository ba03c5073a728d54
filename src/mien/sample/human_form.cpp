#include "mien/sample/detail/character_form.h"

namespace mien::sample {

static Sculpt human_sculpt() {
  return Sculpt({
      // Skull.
      ellipsoid({0, 3.6, -0.7}, {7.4, 8.1, 9.2}, 1),
      ellipsoid({0, 3.8, 3.0}, {6.3, 5.8, 6.3}, 2),
      // Middle of the face, the upper jaw behind the lips, the floor of the mouth.
      ellipsoid({0, -2.6, 3.3}, {6.0, 6.0, 5.4}, 2),
      ellipsoid({0, -6.4, 5.3}, {3.7, 3.3, 4.75}, 2),
      ellipsoid({0, -7.8, 3.4}, {4.2, 3.0, 5.0}, 2),
      // Neck.
      capsule({0, -19, -3.2}, 5.2, {0, -7, -1.8}, 4.7, 2.5),
      capsule({5.2, -3.6, -2.4}, 0.9, {1.2, -18.5, 1.6}, 0.7, 3).both(),
      // Jaw: ramus, body, chin.
      capsule({5.2, -1.5, 1.6}, 0.9, {4.4, -6.2, 2.4}, 0.9, 2.4).both(),
      capsule({4.2, -6.7, 2.8}, 1.0, {1.4, -10.3, 7.7}, 1.1, 2.2).both(),
      ellipsoid({0, -10.2, 8.2}, {1.6, 1.45, 1.75}, 1.8),
      // Cheeks: flesh, cheekbone, arch back to the ear.
      ellipsoid({3.0, -5.4, 4.8}, {2.4, 3.4, 3.2}, 2.0).both(),
      ellipsoid({2.8, -4.6, 6.5}, {2.5, 3.0, 2.5}, 2).both(),
      ellipsoid({4.1, -2.5, 6.3}, {1.9, 1.4, 1.9}, 2.4).both(),
      capsule({4.7, -2.0, 5.4}, 0.8, {5.9, -1.4, 1.2}, 0.7, 2.8).both(),
      // Temples.
      ellipsoid({8.9, 2.0, 4.6}, {1.9, 2.8, 3.0}, 2).cut().both(),
      // Brow ridge and glabella.
      capsule({0.9, 1.7, 8.35}, 0.85, {4.4, 2.0, 6.9}, 0.85, 1.5).both(),
      ellipsoid({0, 1.8, 8.4}, {1.4, 1.2, 1.0}, 1.5),
      // Eye sockets, then the lids around the eyeballs and the fold above them.
      ellipsoid({3.1, -0.1, 9.0}, {1.8, 1.15, 1.75}, 1.4).cut().both(),
      ellipsoid({3.15, 0, 7.0}, {1.58, 1.58, 1.58}, 0.9).both(),
      // Nose: bridge, sides, tip, wings, septum.
      capsule({0, 0.9, 8.5}, 0.65, {0, -3.2, 11.1}, 0.72, 1.2),
      capsule({0.75, -0.4, 7.9}, 0.6, {0.95, -3.6, 9.6}, 0.6, 1.6).both(),
      ellipsoid({0, -3.7, 11.45}, {0.9, 0.8, 0.9}, 0.8),
      ellipsoid({1.1, -4.1, 10.5}, {0.66, 0.62, 0.95}, 0.6).both(),
      capsule({0, -4.25, 11.5}, 0.35, {0, -4.75, 10.2}, 0.45, 0.5),
      // Lips; where they meet the blend is tight and leaves the line between them.
      capsule({0.3, -6.48, 10.40}, 0.43, {1.0, -6.52, 10.28}, 0.42, 0.8).both(),
      capsule({1.0, -6.52, 10.28}, 0.42, {1.8, -6.68, 9.80}, 0.33, 0.8).both(),
      capsule({1.8, -6.68, 9.80}, 0.33, {2.6, -6.78, 9.15}, 0.2, 0.8).both(),
      capsule({0, -7.40, 10.22}, 0.5, {0.8, -7.39, 10.12}, 0.48, 0.12).both(),
      capsule({0.8, -7.39, 10.12}, 0.48, {1.7, -7.26, 9.70}, 0.34, 0.12).both(),
      capsule({1.7, -7.26, 9.70}, 0.34, {2.55, -6.96, 9.15}, 0.18, 0.12).both(),
      ellipsoid({0, -8.0, 9.0}, {2.2, 0.7, 1.2}, 0.8),
      // Philtrum and the furrow above the chin.
      capsule({0, -5.2, 10.9}, 0.2, {0, -5.9, 11.1}, 0.25, 0.5).cut(),
      ellipsoid({0, -8.8, 10.7}, {1.7, 0.5, 0.9}, 1.2).cut(),
  });
}

static HeadForm human_form() {
  HeadForm form;
  form.sculpt = human_sculpt();
  form.eye.upper = 28;
  form.mouth.upper_border = -6.1;
  form.mouth.lower_border = -7.86;
  form.mouth.line = -7.0;
  form.mouth.corner = -6.88;
  form.mouth.corner_front = 9.3;
  form.grid.rows = {
      {0, -15.6, -2.2, -4, 0, 4},    // base of the neck
      {4, -11.5, -1.8, -8, 12, 22},  // under the jaw
      {4, -8.0, 0.0, -22, 16, 20},   // bottom of the chin
      {4, -6.0, 0.0, -17, 8, 18},    // below the mouth
      {8, -4.0, 0.0, -6, 4, 14},     // above the mouth
      {6, -4.0, 0.0, 1, 8, 14},      // tip of the nose
      {6, -1.0, 0.0, -6, 3, 10},     // below the eyes
      {8, 1.0, 0.0, 6, 6, 14},       // brows
      {8, 3.6, -0.7, 32, 38, 38},    // hairline
  };
  form.grid.columns = {{0, 0}, {8, 10}, {10, 39}, {5, 88}, {5, 122}, {8, 180}};
  form.grid.eye = {8, 18, 32, 40};
  form.grid.mouth = {0, 12, 12, 20};
  form.grid.nostril = {3, 6, 21, 25};
  form.grid.ear = {23, 28, 28, 38};
  return form;
}

CharacterForm human_character() {
  CharacterForm form;
  form.name = "human";
  form.head = human_form();
  form.upper_teeth.edge = -7.22;
  form.upper_teeth.height = 1.1;
  form.upper_teeth.front = 9.4;
  form.upper_teeth.width = 2.15;
  form.lower_teeth.edge = -7.0;
  form.lower_teeth.front = 8.95;
  form.lower_teeth.width = 2.0;
  form.lower_teeth.height = -0.85;
  form.brows.line = {{1.0, 1.75, 9}, {2.1, 2.25, 9}, {3.3, 2.45, 8.5}, {4.3, 2.25, 8}, {5.1, 1.6, 7}};
  form.brows.height = 0.6;
  form.brows.thickness = 0.13;
  form.lashes = 0.4;
  form.landmarks.jaw = {{0, -11.6, 9.2},  {1.5, -11.4, 8.6}, {2.9, -10.7, 7.0},
                        {4.1, -9.6, 5.3}, {5.1, -8.2, 3.6},  {5.9, -6.4, 2.2},
                        {6.4, -4.4, 1.5}, {6.8, -2.2, 1.2},  {7.0, -0.2, 1.2}};
  form.landmarks.brow = {
      {0.9, 2.4, 9.75}, {2.25, 2.6, 9.15}, {3.45, 2.6, 8.62}, {4.65, 2.35, 7.9}, {5.17, 1.95, 7.3}};
  form.landmarks.nose = {{0, -0.05, 9.95}, {0, -1.4, 10.8}, {0, -2.4, 11.5}, {0, -3.5, 12.25}};
  form.landmarks.base = {{0, -5.3, 10.25}, {0.66, -5.3, 10.25}, {1.5, -4.7, 10.3}};
  form.materials = {
      plain_material("skin", 0.85f, 0.66f, 0.56f),   plain_material("eye white", 0.92f, 0.91f, 0.89f),
      plain_material("iris", 0.24f, 0.38f, 0.46f),   plain_material("pupil", 0.02f, 0.02f, 0.02f),
      plain_material("teeth", 0.93f, 0.90f, 0.83f),  plain_material("gum", 0.68f, 0.36f, 0.36f),
      plain_material("tongue", 0.72f, 0.38f, 0.38f), plain_material("hair", 0.22f, 0.15f, 0.11f),
      plain_material("mouth", 0.45f, 0.18f, 0.17f),  plain_material("lips", 0.74f, 0.47f, 0.43f),
      plain_material("limbus", 0.13f, 0.22f, 0.29f)};
  return form;
}

}  // namespace mien::sample
