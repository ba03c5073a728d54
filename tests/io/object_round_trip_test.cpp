#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "character/objects_in_code.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using test::Folder;
using testing::HasSubstr;

InfluenceObject named(const char* name, InfluenceForm form, PointsD controls) {
  InfluenceObject object;
  object.name = name;
  object.form = std::move(form);
  object.controls = std::move(controls);
  return object;
}

/// Every kind once, bound and moved in every way.
Character with_objects() {
  Character c = test::head_and_lip();
  c.objects.push_back(test::line());
  c.objects[0].skin = 0;
  c.objects[0].skin_weights = {{0, 2, 3}, {0, 1, 1}, {0.25f, 0.75f, 1}};
  std::get<NurbsCurve>(c.objects[0].form).weights = {1, 0.1};
  c.objects.push_back(
      named("patch", NurbsSurface{2, 1, 3, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {}}, PointsD::Random(6, 3)));
  c.objects.push_back(named("cage", Lattice{{2, 3, 2}, {1, 2, 1}}, PointsD::Random(12, 3)));
  c.objects[2].bindings.push_back({0, {3}, {0.1f}, {0, 2}, {4, 11}, {0.5f, 0.5f}});
  WrapMesh wrap;
  wrap.faces.push_back({0, 1, 2, 3});
  wrap.faces.push_back({0, 2, 4});
  c.objects.push_back(named("wrap", wrap, PointsD::Random(5, 3)));
  c.objects.push_back(test::frame(Cluster{}));
  c.objects.push_back(named("place", Locator{}, PointsD::Random(1, 3)));
  c.shapes[0].objects = {{0, PointsD::Constant(2, 3, 0.5)}, {4, PointsD::Constant(1, 3, 2)}};
  Channel channel;
  channel.property = Channel::Property::object_control;
  channel.object = 2;
  channel.control = 7;
  channel.interpolation = Interpolation::step;
  channel.times = {0, 1.5f};
  channel.values = {0, 0, 0, 1, 2, 3};
  c.clips.push_back({"chew", {channel}, {}});
  return c;
}

void expect_same(const InfluenceObject& a, const InfluenceObject& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.form, b.form) << a.name;
  EXPECT_EQ(a.carrier, b.carrier) << a.name;
  EXPECT_EQ(a.node, b.node) << a.name;
  EXPECT_EQ(a.skin, b.skin) << a.name;
  EXPECT_EQ(a.controls, b.controls) << a.name;
  EXPECT_EQ(a.skin_weights, b.skin_weights) << a.name;
  EXPECT_EQ(a.bindings, b.bindings) << a.name;
}

TEST(object_round_trip, every_kind_comes_back_with_all_it_has) {
  const Folder folder;
  const Character c = with_objects();
  for (const char* name : {"objects.glb", "objects.gltf"}) {
    save(c, folder / name);
    const Character again = load(folder / name);
    ASSERT_EQ(again.objects.size(), c.objects.size());
    for (std::size_t o = 0; o < c.objects.size(); ++o) expect_same(again.objects[o], c.objects[o]);
    ASSERT_EQ(again.shapes.size(),
              1u);  // it moves objects alone: listed on the first part, so that it has a name
    ASSERT_EQ(again.shapes[0].objects.size(), 2u);
    EXPECT_EQ(again.shapes[0].objects[1].object, 4);
    EXPECT_EQ(again.shapes[0].objects[1].controls, c.shapes[0].objects[1].controls);
    ASSERT_EQ(again.clips.size(), 1u);
    ASSERT_EQ(again.clips[0].channels.size(), 1u);
    const Channel& channel = again.clips[0].channels[0];
    EXPECT_EQ(channel.property, Channel::Property::object_control);
    EXPECT_EQ(channel.object, 2);
    EXPECT_EQ(channel.control, 7);
    EXPECT_EQ(channel.interpolation, Interpolation::step);
    EXPECT_EQ(channel.values, c.clips[0].channels[0].values);
  }
  save(load(folder / "objects.glb"), folder / "again.glb");
  save(load(folder / "again.glb"), folder / "third.glb");
  EXPECT_EQ(read_file(folder / "again.glb"), read_file(folder / "third.glb"));
}

TEST(object_round_trip, bad_descriptors_are_named) {
  const Folder folder;
  save(with_objects(), folder / "o.gltf");
  const std::vector<std::uint8_t> bytes = read_file(folder / "o.gltf");
  const auto error_with = [&](const char* at, const nlohmann::json& value) {
    nlohmann::json file = nlohmann::json::parse(bytes);
    file["extensions"]["MIEN_character"][nlohmann::json::json_pointer(at)] = value;
    return test::error_of([&] { load(folder.write("bad.gltf", file.dump())); });
  };
  EXPECT_THAT(error_with("/objects/0/kind", "blob"), HasSubstr("is \"blob\"; give curve, surface"));
  EXPECT_THAT(error_with("/objects/0/knots", {0, 0, 1}), HasSubstr("has 3 knots, 4 are needed"));
  EXPECT_THAT(error_with("/objects/0/carrier", 99), HasSubstr("carrier"));
  EXPECT_THAT(error_with("/objects/1/count", {1e9, 2}), HasSubstr("give numbers from 0 to"));
  EXPECT_THAT(error_with("/objects/2/count", {2, 3}), HasSubstr("count"));
  EXPECT_THAT(error_with("/objects/2/points", {1, 2, 3}),
              HasSubstr("is a grid of 12 control points, there are 1"));
  EXPECT_NE(error_with("/objects/3/faceSizes", 0), "");
  EXPECT_THAT(error_with("/objects/1/name", "line"), HasSubstr("object line: is there twice"));
  EXPECT_THAT(error_with("/objectMoves/0/objects/0", "lines"), HasSubstr("name lines; name objects"));
  EXPECT_THAT(error_with("/objectMoves/0/objects", {"line", "frame", "frame"}),
              HasSubstr("hold 9 numbers; give three a control point"));
  nlohmann::json counts =
      nlohmann::json::parse(bytes)["extensions"]["MIEN_character"]["objects"][0]["bindings"][0]["vertices"];
  EXPECT_THAT(error_with("/objects/0/skinWeights/counts", counts), HasSubstr("in all"));
}

TEST(object_round_trip, a_binding_to_a_changed_mesh_is_left_out) {
  const Folder folder;
  Character c = with_objects();
  save(c, folder / "o.gltf");
  nlohmann::json file = nlohmann::json::parse(read_file(folder / "o.gltf"));
  nlohmann::json& binding = file["extensions"]["MIEN_character"]["objects"][4]["bindings"][0];
  binding["vertices"] = file["extensions"]["MIEN_character"]["objects"][2]["bindings"][0]["controls"];
  const Character again = load(folder.write("changed.gltf", file.dump()));
  EXPECT_TRUE(again.objects[4].bindings.empty());
  EXPECT_FALSE(again.objects[0].bindings.empty());
}

}  // namespace
}  // namespace mien
