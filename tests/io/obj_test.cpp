#include "mien/io/obj.h"

#include <gmock/gmock.h>

#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using test::error_of;
using test::Folder;
using testing::ElementsAre;
using testing::HasSubstr;

Character read(const std::string& text) {
  const Folder folder;
  return load(folder.write("face.obj", text));
}

std::string obj_error_in(const std::string& text) {
  const Folder folder;
  const auto path = folder.write("face.obj", text);
  const std::string error = error_of([&] { load(path); });
  EXPECT_EQ(error.find('\n'), error.npos);
  return error;
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(read_obj, broken_files_name_their_line) {
  const std::pair<std::string, std::string> table[] = {
      {"", "face.obj: file: is empty; give an OBJ with v lines"},
      {"# nothing\n", "face.obj: file: has no vertices; give an OBJ with v lines"},
      {"v 0 0\n", "face.obj: line 1: ends too early; give x, y and z"},
      {"v 0 0 x\n", "face.obj: line 1: has \"x\"; give a finite number"},
      {"v 0 nan 0\n", "face.obj: line 1: has \"nan\"; give a finite number"},
      {"v 0 inf 0\n", "face.obj: line 1: has \"inf\"; give a finite number"},
      {"v 0 1e999 0\n",
       "face.obj: line 1: has a number that is too large; give numbers that a float can hold"},
      {"v 0 1.0.0 0\n", "face.obj: line 1: has \".\" after a number; separate numbers by blanks"},
      {triangle + "f 1 2\n", "face.obj: line 4: has a face of 2 corners; give three or more"},
      {triangle + "f 1 2 4\n", "face.obj: line 4: names vertex 4; the file has 3"},
      {triangle + "f 1 2 0\n", "face.obj: line 4: names vertex 0; there are 3 so far"},
      {triangle + "f 1 2 -4\n", "face.obj: line 4: names vertex -4; there are 3 so far"},
      {triangle + "f 1 2 99999999999999999999\n",
       "face.obj: line 4: names vertex far out of range; there are 3 so far"},
      {triangle + "f 1 2 4000000000\n",
       "face.obj: line 4: names vertex far out of range; there are 3 so far"},
      {triangle + "\n\nf 1/9 2/9 3/9\n", "face.obj: line 6: names texture coordinate 9; the file has 0"},
      {triangle + "f 1//1 2//1 3//1\n", "face.obj: line 4: names normal 1; the file has 0"},
      {triangle + "f a b c\n",
       "face.obj: line 4: has a face corner without a vertex number; give v, v/vt, v//vn or v/vt/vn"},
  };
  for (const auto& [text, expected] : table) EXPECT_EQ(obj_error_in(text), expected) << text;
}

TEST(read_obj, a_missing_file_and_a_folder_are_named) {
  const Folder folder;
  EXPECT_THAT(error_of([&] { read_obj(folder / "none.obj"); }),
              HasSubstr("none.obj: file: cannot be opened"));
  std::filesystem::create_directory(folder / "is.obj");
  EXPECT_THAT(error_of([&] { read_obj(folder / "is.obj"); }), HasSubstr("is not a regular file"));
}

TEST(read_obj, numbers_too_small_for_a_float_are_zero) {
  const Character c = read("v 1e-99 -0.5e-60 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(c.parts[0].mesh.positions.row(0), Eigen::RowVector3f(0, 0, 1));
}

TEST(read_obj, keeps_ngons_and_file_order) {
  const Character c =
      read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 2 0\nv 9 9 9\nf 1 2 3 4\nf 4 3 5\nf 1 2 3 5 4\n");
  ASSERT_EQ(c.parts.size(), 1u);
  const Mesh& mesh = c.parts[0].mesh;
  EXPECT_EQ(c.parts[0].name, "face");
  EXPECT_EQ(mesh.vertex_count(), 6u);  // the last has no face
  EXPECT_EQ(mesh.faces.size(), 3u);
  EXPECT_THAT(std::vector<int>(mesh.faces[2].begin(), mesh.faces[2].end()), ElementsAre(0, 1, 2, 4, 3));
  EXPECT_FLOAT_EQ(mesh.positions(4, 0), 0.5f);
}

TEST(read_obj, takes_crlf_comments_continuations_blanks_and_negative_numbers) {
  const Character c = read(
      "\xEF\xBB\xBF# a comment\r\n  v 0 0 0 # here too\r\nv\t1 0 0\r\nv 1 \\\r\n1 0\r\nv 0 +1 0\r\n\r\n"
      "f -4 -3 \\\r\n -2\r\ns off\r\nl 1 2\r\nf -4 -2 -1");
  EXPECT_EQ(c.parts[0].mesh.vertex_count(), 4u);
  ASSERT_EQ(c.parts[0].mesh.faces.size(), 2u);
  EXPECT_THAT(c.parts[0].mesh.faces.corners(), ElementsAre(0, 1, 2, 0, 2, 3));
}

TEST(read_obj, the_line_of_an_error_after_a_continuation_is_the_file_s) {
  EXPECT_THAT(obj_error_in("v 0 \\\n0 0\nv 1 x 0\n"), HasSubstr("line 3"));
}

TEST(read_obj, keeps_a_uv_for_each_corner) {
  const Character c =
      read(triangle + "v 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt .5 .5\nf 1/1 2/2 3/3\nf 2/4 4/1 3\n");
  const UvSet& uv = c.parts[0].mesh.uvs.at(0);
  EXPECT_EQ(uv.coordinates.rows(), 4);
  EXPECT_THAT(uv.corners, ElementsAre(0, 1, 2, 3, 0, -1));
}

TEST(read_obj, uvs_numbered_as_their_vertices_need_no_corners) {
  const Character c = read(triangle + "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
  EXPECT_TRUE(c.parts[0].mesh.uvs.at(0).corners.empty());
}

TEST(read_obj, keeps_normals_that_agree_and_drops_others) {
  const std::string normals = triangle + "v 1 1 0\nvn 0 0 2\nvn 1 0 0\n";
  EXPECT_EQ(read(normals + "f 1//1 2//1 3//1\nf 2//1 4//2 3//1\n").parts[0].mesh.normals.row(0),
            Eigen::RowVector3f(0, 0, 1));
  EXPECT_EQ(read(normals + "f 1//1 2//1 3//1\nf 2//2 4//2 3//1\n").parts[0].mesh.normals.rows(), 0);
}

TEST(read_obj, groups_follow_g_o_and_usemtl) {
  const std::string f = "f 1 2 3\n";
  const Character c = read(triangle + f + "g brow\n" + f + f + "usemtl skin\n" + f + "g eye\n" + "g brow\n" +
                           f + "o tooth\nusemtl bone\n" + f);
  const std::vector<FaceGroup>& groups = c.parts[0].mesh.groups;
  ASSERT_EQ(groups.size(), 4u);
  EXPECT_EQ(groups[0].name, "");
  EXPECT_EQ(groups[1].name, "brow");
  EXPECT_EQ(groups[1].face_begin, 1);
  EXPECT_EQ(groups[1].face_end, 3);
  EXPECT_EQ(groups[2].material, 0);
  EXPECT_EQ(groups[2].face_end, 5);
  EXPECT_EQ(groups[3].name, "tooth");
  EXPECT_EQ(c.appearance.materials[1].name, "bone");
}

TEST(read_obj, reads_vertex_colours) {
  const Character c = read("v 0 0 0\nv 1 0 0 1 0 .5\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(c.parts[0].mesh.colors.size(), 1u);
  EXPECT_EQ(c.parts[0].mesh.colors[0].row(1), Eigen::RowVector4f(1, 0, .5f, 1));
  EXPECT_EQ(c.parts[0].mesh.colors[0].row(2), Eigen::RowVector4f(1, 1, 1, 1));
}

TEST(read_obj, decimals_of_any_length_become_the_nearest_float) {
  const Folder folder;
  std::string text;
  std::vector<std::string> numbers;
  std::uint32_t state = 1;
  const auto random = [&](std::uint32_t below) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % below;
  };
  for (int i = 0; i < 6000; ++i) {
    std::string number = random(2) ? "-" : "";
    for (std::uint32_t k = random(10); k > 0; --k) number += static_cast<char>('0' + random(10));
    number += random(8) ? "." : "";
    for (std::uint32_t k = random(14); k > 0; --k) number += static_cast<char>('0' + random(10));
    if (number.find_first_of("0123456789") == number.npos) number += "7";
    numbers.push_back(number);
    text += (i % 3 == 0 ? "v " : " ") + number + (i % 3 == 2 ? "\n" : "");
  }
  // Halfway between two floats: to even, whatever the way.
  for (const char* number : {"16777217", "16777219.", "0.500000029802322"}) {
    numbers.push_back(number);
    text += (numbers.size() % 3 == 1 ? "v " : " ") + numbers.back();
  }
  const Character c = read_obj(folder.write("numbers.obj", text + "\nf 1 2 3\n"));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    ASSERT_EQ(c.parts[0].mesh.positions.data()[i], std::strtof(numbers[i].c_str(), nullptr)) << numbers[i];
}

TEST(write_obj, gives_back_what_was_read) {
  const Folder folder;
  const Character c = load(folder.write(
      "face.obj", triangle +
                      "v 1 1 0.1\nvt 0 0\nvt 1 0\nvt 1 1\nvt .5 .3\nvn 0 0 1\ng a\nf 1/1/1 2/2/1 3/3/1\n"
                      "g b\nusemtl m\nf 2/4/1 4/1/1 3/2/1\n"));
  save(c, folder / "face2.obj");
  const Character again = load(folder / "face2.obj");
  test::expect_same_mesh(c.parts[0].mesh, again.parts[0].mesh);
}

TEST(write_obj, places_parts_in_model_space_and_numbers_them_on) {
  const Folder folder;
  Character c = read(triangle + "f 1 2 3\n");
  Node node;
  node.name = "up";
  node.rest.translation = {0, 5, 0};
  c.nodes.push_back(node);
  c.parts.push_back(c.parts[0]);
  c.parts[1].name = "second";
  c.parts[1].node = 0;
  save(c, folder / "two.obj");
  const Character again = load(folder / "two.obj");
  EXPECT_EQ(again.parts[0].mesh.vertex_count(), 6u);
  EXPECT_EQ(again.parts[0].mesh.positions(3, 1), 5.f);
  EXPECT_EQ(again.parts[0].mesh.groups.at(1).name, "second");
  EXPECT_THAT(again.parts[0].mesh.faces.corners(), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(obj, real_faces_come_back_through_obj_and_glb) {
  const std::filesystem::path data(MIEN_SHARED_DATA);
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data";
  const Folder folder;
  for (const char* name :
       {"makehuman/x_elf.obj", "makehuman/x_elf.lowpoly.obj", "makehuman/african_male_young.obj",
        "mediapipe/canonical_face_model.obj", "cases/A1_ict_id1.0/target.obj"}) {
    SCOPED_TRACE(name);
    const Character c = load(data / name);
    save(c, folder / "out.obj");
    save(c, folder / "out.glb");
    test::expect_same_mesh(c.parts[0].mesh, load(folder / "out.obj").parts[0].mesh);
    test::expect_same_mesh(c.parts[0].mesh, load(folder / "out.glb").parts[0].mesh, 6e-8f);
  }
}

}  // namespace
}  // namespace mien
