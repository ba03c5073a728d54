#include <gmock/gmock.h>

#include "mien/character/sliders.h"
#include "mien/io/assemble.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/io/weights_file.h"
#include "support.h"

namespace mien {
namespace {

using test::error_of;
using test::Folder;
using testing::HasSubstr;

/// A unit quad in a part and a triangle above it in another; three shapes.
Character small_character() {
  Character c;
  c.parts.resize(2);
  c.parts[0].name = "Skin";
  c.parts[0].mesh.positions.resize(4, 3);
  c.parts[0].mesh.positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  c.parts[0].mesh.faces.push_back({0, 1, 2, 3});
  c.parts[1].name = "Teeth";
  c.parts[1].mesh.positions.resize(3, 3);
  c.parts[1].mesh.positions << 0, 0, 5, 1, 0, 5, 0, 1, 5;
  c.parts[1].mesh.faces.push_back({0, 1, 2});
  c.shapes.resize(3);
  c.shapes[0].name = "jawOpen";
  c.shapes[1].name = "mouthSmile_L";
  c.shapes[2].name = "mouthSmile_R";
  complete_sliders(c);
  return c;
}

std::string landmark_error(const std::string& text) {
  const Folder folder;
  const auto path = folder.write("marks.json", text);
  return error_of([&] { read_landmarks(path, small_character()); });
}

TEST(read_landmarks, broken_files_name_the_place) {
  const std::pair<std::string, std::string> table[] = {
      {"", "marks.json: JSON: is not valid JSON at byte 1; give well-formed UTF-8 JSON"},
      {"[]", "marks.json: file: is an array; give an object"},
      {"{}", "marks.json: file: has no \"landmarks\"; give {\"landmarks\": {NAME: POINT}}"},
      {R"({"landmarks": 3})", "marks.json: landmarks: is a number; give an object"},
      {R"({"landmarks": {"nose": 3}})", "marks.json: landmark nose: is a number; give an object"},
      {R"({"landmarks": {"nose": {}}})",
       "marks.json: landmark nose: is no point; give a vertex, a face with barycentric, or a position"},
      {R"({"landmarks": {"nose": {"vertex": 4}}})", "marks.json: landmark nose.vertex: is 4; give 0 to 3"},
      {R"({"landmarks": {"nose": {"vertex": -1}}})", "marks.json: landmark nose.vertex: is -1; give 0 to 3"},
      {R"({"landmarks": {"nose": {"vertex": 1.5}}})",
       "marks.json: landmark nose.vertex: is 1.5; give a whole number"},
      {R"({"landmarks": {"nose": {"vertex": 0, "prat": "Skin"}}})",
       "marks.json: landmark nose: has an unknown member \"prat\"; it may have part, vertex, face, "
       "barycentric, corners, position, control"},
      {R"({"landmarks": {"nose": {"part": "Skim", "vertex": 0}}})",
       "marks.json: landmark nose.part: is \"Skim\", which the character does not have; its first part is "
       "\"Skin\""},
      {R"({"landmarks": {"nose": {"face": 1, "barycentric": [1, 0, 0]}}})",
       "marks.json: landmark nose.face: is 1; give 0 to 0"},
      {R"({"landmarks": {"nose": {"face": 0}}})",
       "marks.json: landmark nose: has no \"barycentric\"; give three weights"},
      {R"({"landmarks": {"nose": {"face": 0, "barycentric": [1, 0]}}})",
       "marks.json: landmark nose.barycentric: has 2 numbers; give 3"},
      {R"({"landmarks": {"nose": {"face": 0, "barycentric": [1, 1, 1]}}})",
       "marks.json: landmark nose.barycentric: sums to 3; the three weights sum to 1"},
      {R"({"landmarks": {"nose": {"face": 0, "barycentric": [2, -1, 0]}}})",
       "marks.json: landmark nose.barycentric: has a negative weight; give three weights in [0, 1]"},
      {R"({"landmarks": {"nose": {"position": [1, 2]}}})",
       "marks.json: landmark nose.position: has 2 numbers; give 3"},
      {R"({"landmarks": {"nose": {"position": [1, 2, null]}}})",
       "marks.json: landmark nose.position[2]: is a null; give a number"},
      {R"({"landmarks": {"nose": {"position": [1, 2, 1e999]}}})",
       "marks.json: JSON: holds a number that is out of range; give numbers that a double can hold"},
      {R"({"curves": {"brow": {"points": [{"vertex": 0}], "count": 8}}})",
       "marks.json: curve brow.points: has 1 points; give two or more"},
      {R"({"curves": {"brow": {"points": [{"vertex": 0}, {"vertex": 1}], "count": 1}}})",
       "marks.json: curve brow.count: is 1; give 2 to 10000"},
  };
  for (const auto& [text, expected] : table) EXPECT_EQ(landmark_error(text), expected) << text;
}

TEST(read_landmarks, reads_each_form_of_a_point) {
  const Folder folder;
  const Character c = small_character();
  const LandmarkSet set = read_landmarks(folder.write("marks.json", R"({"landmarks": {
      "d": {"position": [0.25, 0.5, -3]}, "a": {"vertex": 2}, "b": {"part": "Teeth", "vertex": 1},
      "c": {"face": 0, "barycentric": [0.5, 0.25, 0.25]}, "e": {"part": "Teeth", "position": [0, 0, 0]}},
      "curves": {"brow": {"points": [{"vertex": 0}, {"vertex": 1}], "count": 8}}})"),
                                         c);
  ASSERT_EQ(set.landmarks.size(), 5u);
  EXPECT_EQ(set.landmarks[0].name, "a");
  EXPECT_EQ(set.landmarks[0].at.vertex, 2);
  EXPECT_EQ(set.landmarks[1].at.part, 1);
  EXPECT_EQ(set.landmarks[2].at.barycentric, Eigen::Vector3d(0.5, 0.25, 0.25));
  const Mesh& skin = c.parts[0].mesh;
  EXPECT_LT((position_of(skin, skin.positions, set.landmarks[3].at) - Eigen::Vector3d(0.25, 0.5, 0)).norm(),
            1e-6);
  EXPECT_EQ(set.landmarks[4].at.part, 1);
  EXPECT_EQ(set.curves.at(0).count, 8);
}

TEST(read_landmarks, what_was_written_comes_back) {
  const Folder folder;
  const Character c = small_character();
  LandmarkSet set = read_landmarks(
      folder.write("marks.json", R"({"landmarks": {"d": {"position": [0.25, 0.5, -3]}, "a": {"vertex": 2}},
      "curves": {"brow": {"points": [{"vertex": 0}, {"vertex": 1}], "count": 8}}})"),
      c);
  write_landmarks(set, c, folder / "again.json");
  const LandmarkSet again = read_landmarks(folder / "again.json", c);
  ASSERT_EQ(again.landmarks.size(), 2u);
  for (int l : {0, 1}) test::expect_same_point(set.landmarks[l].at, again.landmarks[l].at);
  EXPECT_EQ(again.curves.at(0).points.size(), 2u);
}

TEST(read_weights, unknown_names_and_other_forms_are_named) {
  const std::pair<std::string, std::string> table[] = {
      {"{", "w.json: JSON: is not valid JSON at byte 2; give well-formed UTF-8 JSON"},
      {"{}", "w.json: file: has no \"weights\"; give {\"weights\": {NAME: NUMBER}}"},
      {R"({"weights": {"jawOpen": "much"}})", "w.json: weights.jawOpen: is a string; give a number"},
      {R"({"weights": {"mouthSmileR": 1}})",
       "w.json: slider mouthSmileR: does not exist; name one of the 3 sliders, perhaps mouthSmile_R"},
  };
  for (const auto& [text, expected] : table) {
    const Folder folder;
    const auto path = folder.write("w.json", text);
    EXPECT_EQ(error_of([&] { read_weights(path, small_character()); }), expected);
  }
}

TEST(read_weights, missing_names_weigh_nothing_and_weights_come_back) {
  const Folder folder;
  const Character c = small_character();
  const SliderValues weights =
      read_weights(folder.write("w.json", R"({"weights": {"mouthSmile_L": 0.4}})"), c);
  EXPECT_EQ(weights.values, Eigen::Vector3d(0, 0.4, 0));
  write_weights(weights, c, folder / "again.json");
  EXPECT_EQ(read_weights(folder / "again.json", c).values, weights.values);
}

Character with_a_wire() {
  Character c = small_character();
  Wire wire;
  wire.name = "lip";
  wire.curve.knots = clamped_knots(4);
  wire.curve.controls = PointsD::Zero(4, 3);
  wire.curve.controls.col(0) << 0, 1, 2, 3;
  wire.ranges = {1};
  c.wires.push_back(wire);
  return c;
}

TEST(read_weights, moves_of_wires_add_up_and_come_back) {
  const Character c = with_a_wire();
  const Folder folder;
  WireMove move;
  move.controls = PointsD::Constant(4, 3, 0.25);
  WireMove more = move;
  more.scale = 0.5;
  more.turns = PointsD::Constant(4, 3, -0.125);
  write_weights(SliderValues(c.sliders.size()), c, folder / "w.json", {move, more});
  const std::vector<WireMove> read = read_wire_moves(folder / "w.json", c);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].controls, 2 * move.controls);
  EXPECT_EQ(read[0].scale, 0.5);
  EXPECT_EQ(read[0].turns, more.turns);
  EXPECT_EQ(read_weights(folder / "w.json", c).values.cwiseAbs().sum(), 0);
  EXPECT_TRUE(read_wire_moves(folder.write("none.json", R"({"weights": {}})"), c).empty());
}

TEST(read_weights, odd_moves_of_wires_are_named) {
  const Character c = with_a_wire();
  const Folder folder;
  const std::pair<const char*, const char*> cases[] = {
      {R"({"wires": {"lips": {}}})",
       "w.json: wire lips: does not exist; name one of the 1 wires, perhaps lip"},
      {R"({"wires": {"lip": {"controls": [[0, 0, 0]]}}})",
       "w.json: wires.lip.controls: is no list of points; give 4 times [x, y, z]"},
      {R"({"wires": {"lip": {"turns": [[0, 0, 0], [0, 0], [0, 0, 0], [0, 0, 0]]}}})",
       "w.json: wires.lip.turns: is no list of points; give 4 times [x, y, z]"}};
  for (const auto& [text, expected] : cases) {
    const auto path = folder.write("w.json", text);
    EXPECT_THAT(error_of([&] { read_wire_moves(path, c); }), ::testing::HasSubstr(expected));
  }
}

class Assemble : public testing::Test {
 protected:
  const std::string triangle_ = "f 1 2 3\n";
  Folder folder_;
  const std::filesystem::path neutral_ =
      folder_.write("neutral.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + triangle_);
};

TEST_F(Assemble, names_the_file_that_does_not_fit) {
  const std::vector<std::filesystem::path> more = {
      folder_.write("smile.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n" + triangle_)};
  EXPECT_EQ(error_of([&] { assemble(neutral_, more); }), "smile.obj: vertices: are 4; the neutral has 3");
  const std::vector<std::filesystem::path> other = {
      folder_.write("order.obj", "v 1 0 0\nv 0 1 0\nv 0 0 0\n" + triangle_)};
  EXPECT_THAT(error_of([&] { assemble(neutral_, other); }),
              HasSubstr("order.obj: vertices: 3 of 3 move by more than a quarter of the face"));
  const std::vector<std::filesystem::path> twice = {neutral_, neutral_};
  EXPECT_THAT(error_of([&] { assemble(neutral_, twice); }), HasSubstr("shape neutral: is also made from"));
}

TEST_F(Assemble, a_shape_is_the_difference_without_noise) {
  const std::vector<std::filesystem::path> files = {
      folder_.write("jawOpen.obj", "v 0 0.000001 0\nv 1 -0.25 0\nv 0 1 0\n" + triangle_)};
  const Character c = assemble(neutral_, files);
  ASSERT_EQ(c.shapes.size(), 1u);
  EXPECT_EQ(c.shapes[0].name, "jawOpen");
  EXPECT_EQ(c.shapes[0].parts.at(0).vertices, std::vector<int>{1});
  EXPECT_EQ(c.shapes[0].parts[0].deltas.row(0), Eigen::RowVector3f(0, -0.25f, 0));
  AssembleOptions exact;
  exact.threshold = 0;
  EXPECT_EQ(assemble(neutral_, files, exact).shapes[0].parts[0].vertices, (std::vector<int>{0, 1}));
}

TEST(write_file_atomically, replaces_whole_files_and_leaves_nothing_else) {
  const Folder folder;
  const auto path = folder.write("a.txt", "first");
  write_file_atomically(path, "second");
  EXPECT_EQ(read_file(path), (std::vector<std::uint8_t>{'s', 'e', 'c', 'o', 'n', 'd'}));
  EXPECT_EQ(folder.file_count(), 1u);
  EXPECT_THAT(error_of([&] { write_file_atomically(folder / "none/a.txt", "x"); }),
              HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace mien
