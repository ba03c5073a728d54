#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "error_of.h"
#include "mien/character/sliders.h"
#include "mien/character/validate.h"
#include "mien/character/whole_faces.h"
#include "mien/core/error.h"
#include "mien/sample/sample.h"
#include "mien/symmetry/find_mirror_plane.h"
#include "mien/symmetry/mirror_shapes.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

const Character& human() {
  static const Character character = make_sample("human");
  return character;
}

double diagonal(const Character& character) {
  return bounding_box(character.parts[0].mesh.positions).diagonal();
}

TEST(find_mirror_plane, no_surface_is_an_error) {
  EXPECT_THROW(find_mirror_plane(Character{}), Error);
}

TEST(find_mirror_plane, of_the_built_in_human_is_across_x_with_the_left_where_names_say) {
  const FoundPlane found = find_mirror_plane(human());
  EXPECT_LT((found.plane.normal - Eigen::Vector3d::UnitX()).norm(), 1e-3);
  EXPECT_LT(std::abs(found.plane.offset), 1e-3 * diagonal(human()));
  EXPECT_LT(found.asymmetry, 2e-3);
}

TEST(find_mirror_plane, follows_a_head_that_is_turned_and_moved) {
  Character turned = human();
  turned.skins.clear();
  turned.shapes.clear();
  turned.sliders.clear();
  turned.clips.clear();
  for (Part& part : turned.parts) {
    part.skin = part.node = -1;
    part.skin_weights = {};
  }
  turned.nodes.clear();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.35, Eigen::Vector3d(0.2, 1, 0.4).normalized()).toRotationMatrix();
  const Eigen::Vector3d shift(0.3, -2, 1);
  for (Part& part : turned.parts)
    part.mesh.positions =
        ((part.mesh.positions.cast<double>() * turn.transpose()).rowwise() + shift.transpose()).cast<float>();
  const FoundPlane found = find_mirror_plane(turned);
  EXPECT_LT((found.plane.normal - turn.col(0)).norm(), 5e-3);
  EXPECT_NEAR(found.plane.offset, turn.col(0).dot(shift), 2e-3 * diagonal(human()));
}

TEST(split_shapes, bad_input_is_named) {
  const MirrorPlane plane;
  EXPECT_THAT(error_of([&] { split_shapes(human(), {"gills"}, plane); }),
              HasSubstr("shape gills: does not exist"));
  EXPECT_THAT(error_of([&] { split_shapes(human(), {"jawOpen"}, plane, 0); }), HasSubstr("width: is 0"));
  Character character = human();
  character.correctives = {{0, CorrectiveRule::product, {{find_slider(character, "jawOpen"), 1}}}};
  EXPECT_THAT(error_of([&] { split_shapes(character, {"jawOpen"}, plane); }),
              HasSubstr("is used by a corrective"));
  character = human();
  character.shapes[0].name = "jawOpenLeft";
  EXPECT_THAT(error_of([&] { split_shapes(character, {"jawOpen"}, plane); }),
              HasSubstr("shape jawOpenLeft: exists"));
}

TEST(split_shapes, halves_add_up_and_stay_on_their_side) {
  const Character split = split_shapes(human(), {"jawOpen"}, MirrorPlane{});
  require_valid(split);
  const int whole = find_shape(human(), "jawOpen");
  const int left = find_shape(split, "jawOpenLeft"), right = find_shape(split, "jawOpenRight");
  ASSERT_GE(left, 0);
  ASSERT_GE(right, 0);
  EXPECT_GE(find_slider(split, "jawOpenRight"), 0);
  EXPECT_LT(find_slider(split, "jawOpen"), 0);
  const PointsD neutral = human().parts[0].mesh.positions.cast<double>();
  const PointsD sum = whole_face(split, 0, left) + whole_face(split, 0, right) - neutral;
  EXPECT_LT((sum - whole_face(human(), 0, whole)).cwiseAbs().maxCoeff(), 1e-6 * diagonal(human()));
  for (const PartDelta& delta : split.shapes[static_cast<std::size_t>(left)].parts)
    for (const int v : delta.vertices)
      EXPECT_GT(split.parts[static_cast<std::size_t>(delta.part)].mesh.positions(v, 0),
                -0.03 * diagonal(human()));
}

TEST(split_shapes, clips_move_both_halves) {
  Character talking = human();
  Channel open;
  open.property = Channel::Property::shape_weight;
  open.shape = find_shape(talking, "jawOpen");
  open.times = {0, 1};
  open.values = {0, 1};
  talking.clips = {{"open", {open}, {}}};
  const Character split = split_shapes(talking, {"jawOpen"}, MirrorPlane{});
  const auto moved = [](const Character& character, const char* name) {
    const int shape = find_shape(character, name);
    int count = 0;
    for (const Channel& channel : character.clips[0].channels) count += channel.shape == shape;
    return count;
  };
  EXPECT_EQ(moved(split, "jawOpenLeft"), 1);
  EXPECT_EQ(moved(split, "jawOpenRight"), 1);
}

TEST(mirror_shapes, without_sides_there_is_nothing_to_mirror) {
  Character character = human();
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    character.shapes[s].name = "s" + std::to_string(s);
  EXPECT_THAT(error_of([&] { mirror_shapes(character, Side::left, MirrorPlane{}); }),
              HasSubstr("none is named after the left"));
}

TEST(mirror_shapes, the_humans_right_side_comes_back_from_its_left) {
  Character character = human();
  const int smile = find_shape(character, "mouthSmileRight"), look = find_shape(character, "eyeLookUpRight");
  const Shape known_smile = character.shapes[static_cast<std::size_t>(smile)];
  const Shape known_look = character.shapes[static_cast<std::size_t>(look)];
  for (const int shape : {smile, look})
    for (PartDelta& delta : character.shapes[static_cast<std::size_t>(shape)].parts) delta.deltas.setZero();
  const MirroredShapes mirrored = mirror_shapes(character, Side::left, MirrorPlane{}, true);
  EXPECT_TRUE(mirrored.made.empty());
  EXPECT_THAT(mirrored.replaced, ::testing::Contains("mouthSmileRight"));
  require_valid(mirrored.character);
  Character truth = human();
  for (const int shape : {smile, look})
    for (int part = 0; part < static_cast<int>(truth.parts.size()); ++part) {
      const PointsD a = whole_face(truth, part, shape), b = whole_face(mirrored.character, part, shape);
      EXPECT_LT((a - b).rowwise().norm().maxCoeff(), 2e-3 * diagonal(truth)) << truth.parts[part].name;
    }
}

TEST(mirror_shapes, missing_ones_get_a_slider) {
  Character character = human();
  const int gone = find_shape(character, "cheekSquintRight");
  character.shapes[static_cast<std::size_t>(gone)].name = "spare";
  const MirroredShapes mirrored = mirror_shapes(character, Side::left, MirrorPlane{});
  EXPECT_THAT(mirrored.made, ::testing::ElementsAre("cheekSquintRight"));
  EXPECT_EQ(mirrored.character.shapes.back().name, "cheekSquintRight");
  EXPECT_TRUE(mirrored.replaced.empty());
}

}  // namespace
}  // namespace mien
