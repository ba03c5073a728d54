#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/character/sliders.h"
#include "mien/io/load.h"
#include "mien/io/pins_file.h"
#include "support.h"

namespace mien {
namespace {

using test::Folder;
using testing::HasSubstr;

/// A rational patch of 3 x 2 control vertices beside a cage of one quad, with a shape that lifts a control vertex.
Character with_patch() {
  Character c;
  c.parts.resize(2);
  c.parts[0].name = "Lips";
  c.parts[0].mesh.positions.resize(6, 3);
  c.parts[0].mesh.positions << 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0;
  c.parts[0].mesh.faces.push_back({0, 1, 4, 3});
  c.parts[0].mesh.faces.push_back({1, 2, 5, 4});
  c.parts[0].surface = NurbsSurface{2, 1, 3, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {1, 0.5, 1, 1, 0.5, 1}};
  c.parts[1].name = "Cage";
  c.parts[1].mesh.positions = c.parts[0].mesh.positions.topRows(4);
  c.parts[1].mesh.faces.push_back({0, 1, 2, 3});
  c.parts[1].subdivision = Subdivision::catmull_clark;
  PartDelta lift;
  lift.vertices = {4};
  lift.deltas = Eigen::RowVector3f(0, 0, 1);
  c.shapes = {{"lift", {lift}}};
  complete_sliders(c);
  return c;
}

TEST(surface_round_trip, spline_surfaces_and_cages_come_back) {
  const Folder folder;
  const Character c = with_patch();
  for (const char* name : {"patch.glb", "patch.gltf"}) {
    save(c, folder / name);
    const Character again = load(folder / name);
    ASSERT_EQ(again.parts.size(), 2u);
    EXPECT_EQ(again.parts[0].surface, c.parts[0].surface);
    EXPECT_EQ(again.parts[0].mesh.positions, c.parts[0].mesh.positions);
    EXPECT_FALSE(again.parts[1].surface);
    EXPECT_EQ(again.parts[1].subdivision, Subdivision::catmull_clark);
  }
}

TEST(surface_round_trip, bad_descriptors_are_named) {
  const Folder folder;
  save(with_patch(), folder / "p.gltf");
  const std::vector<std::uint8_t> bytes = read_file(folder / "p.gltf");
  const auto error_with = [&](const char* at, const nlohmann::json& value) {
    nlohmann::json file = nlohmann::json::parse(bytes);
    const bool cage = std::string_view(at) == "/subdivision";
    file["meshes"][cage ? 1 : 0]["extensions"]["MIEN_character"][nlohmann::json::json_pointer(at)] = value;
    return test::error_of([&] { load(folder.write("bad.gltf", file.dump())); });
  };
  EXPECT_THAT(error_with("/surface/count", {4, 2}),
              HasSubstr("part Lips: spline surface: has 6 knots along u, 7 are needed"));
  EXPECT_THAT(error_with("/surface/count", {1e9, 2}), HasSubstr("give counts of control vertices"));
  EXPECT_THAT(error_with("/surface/degree", {2}), HasSubstr("degree"));
  EXPECT_THAT(error_with("/surface/weights", {1, 2}),
              HasSubstr("has 2 weights, there are 6 control vertices"));
  EXPECT_THAT(error_with("/subdivision", "butterfly"), HasSubstr("give catmull-clark or loop"));
}

TEST(read_pins, a_control_vertex_is_named_by_its_place_in_the_grid) {
  const Folder folder;
  const Character c = with_patch();
  const auto pins_with = [&](const char* at) {
    return folder.write("pins.json", std::string(R"({"pins": [{"at": )") + at + R"(, "move": [0, 0, 1]}]})");
  };
  const auto pins = read_pins(pins_with(R"({"part": "Lips", "control": [1, 1]})"), c);
  ASSERT_EQ(pins.pins.size(), 1u);
  EXPECT_EQ(std::get<SurfacePoint>(pins.pins[0].at).vertex, 4);
  EXPECT_THAT(test::error_of([&] { read_pins(pins_with(R"({"part": "Lips", "control": [3, 0]})"), c); }),
              HasSubstr("give [i, j] below [3, 2]"));
  EXPECT_THAT(test::error_of([&] { read_pins(pins_with(R"({"part": "Cage", "control": [0, 0]})"), c); }),
              HasSubstr("asks for a control vertex of part Cage"));
}

}  // namespace
}  // namespace mien
