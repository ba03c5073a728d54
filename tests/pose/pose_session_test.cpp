#include "mien/pose/pose_session.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"
#include "pose/small_face.h"

namespace mien {
namespace {

using test::pin_at;

double distance(const RigPose& a, const RigPose& b) {
  return (a.sliders.values - b.sliders.values).cwiseAbs().maxCoeff();
}

TEST(PoseSession, a_drag_is_one_undoable_change) {
  const Character face = test::small_face(20);
  const RigPose rest = rest_rig_pose(face);
  PoseSession session(face, rest);
  const int chin = session.add_pin(pin_at(65, {0, 0, 0})), brow = session.add_pin(pin_at(90, {0, 0, 0}));
  const Eigen::Vector3d from = session.pin_goal(chin);
  EXPECT_FALSE(session.can_undo());
  session.begin_drag(chin);
  for (const double t : {0.2, 0.7, 1.0}) session.drag_to(from + t * Eigen::Vector3d(0.1, 0.1, 0));
  session.end_drag();
  const RigPose dragged = session.pose();
  EXPECT_GT(distance(dragged, rest), 0.01);
  session.begin_drag(brow);
  session.drag_to(session.pin_goal(brow) + Eigen::Vector3d(0, 0.2, 0));
  session.cancel_drag();
  EXPECT_EQ(distance(session.pose(), dragged), 0);
  session.undo();
  EXPECT_EQ(distance(session.pose(), rest), 0);
  EXPECT_EQ((session.pin_goal(chin) - from).norm(), 0);
  EXPECT_TRUE(session.can_redo());
  session.redo();
  EXPECT_EQ(distance(session.pose(), dragged), 0);
  session.undo();
  session.set_slider(3, 0.5);
  EXPECT_FALSE(session.can_redo());
}

TEST(PoseSession, a_slider_takes_the_pins_with_it) {
  const Character face = test::small_face(20);
  PoseSession session(face, rest_rig_pose(face));
  const int pin = session.add_pin(pin_at(65, {0, 0, 0}));
  session.set_slider(4, 0.8);
  EXPECT_LT((session.pin_goal(pin) - test::vertex_at(face, session.pose(), 65)).norm(), 1e-6);
  session.begin_drag(pin);  // and dragging it nowhere moves nothing
  EXPECT_TRUE(session.drag_to(session.pin_goal(pin)).moved.empty());
  session.end_drag();
}

TEST(PoseSession, says_before_which_sliders_a_drag_would_move) {
  const Character face = test::small_face(20);
  PoseSession session(face, rest_rig_pose(face));
  const int pin = session.add_pin(pin_at(65, {0, 0, 0}));
  const Eigen::Vector3d goal = session.pin_goal(pin) + Eigen::Vector3d(0.05, 0.05, 0);
  const std::vector<int> said = session.sliders_moved_by(pin, goal);
  EXPECT_EQ(distance(session.pose(), rest_rig_pose(face)), 0);
  session.begin_drag(pin);
  EXPECT_EQ(session.drag_to(goal).moved, said);
  EXPECT_THROW(session.begin_drag(pin), Error);
  EXPECT_THROW(session.set_slider(1, 0.2), Error);
  EXPECT_THROW(session.drag_to({NAN, 0, 0}), Error);
  session.end_drag();
  EXPECT_THROW(session.drag_to(goal), Error);
  EXPECT_THROW(session.add_pin(pin_at(1000, {0, 0, 0})), Error);
  EXPECT_THROW(session.remove_pin(17), Error);
}

TEST(PoseSession, tags_attenuate_sliders_until_they_are_cleared) {
  const Character face = test::small_face(20);
  PoseSession session(face, rest_rig_pose(face)), plain(face, rest_rig_pose(face));
  Tag tag;
  tag.at.vertex = 65;
  session.set_tags({tag});
  EXPECT_EQ(distance(session.pose(), rest_rig_pose(face)), 0);
  for (int s = 0; s < 20; ++s) {
    session.set_slider(s, 0.3);
    plain.set_slider(s, 0.3);
  }
  const Eigen::Vector3d rest = test::vertex_at(face, rest_rig_pose(face), 65);
  EXPECT_LT((test::vertex_at(face, session.pose(), 65) - rest).norm(),
            0.5 * (test::vertex_at(face, plain.pose(), 65) - rest).norm());
  const RigPose before = session.pose();
  session.clear_tags();
  EXPECT_EQ(distance(session.pose(), before), 0);
}

/// Two bumps that are each other's mirror image.
Character two_sided_face() {
  Character face = test::small_face(0);
  face.shapes.push_back(test::bump(face, "left", {0.5, 0.2}, {0.05, 0.2, 0.1}));
  face.shapes.push_back(test::bump(face, "right", {-0.5, 0.2}, {-0.05, 0.2, 0.1}));
  complete_sliders(face);
  return face;
}

TEST(MirrorPins, the_other_side_does_the_same) {
  const Character face = two_sided_face();
  const MirrorPlane plane = middle_plane(face);
  EXPECT_LT(std::abs(plane.offset), 1e-6);
  PoseSession session(face, rest_rig_pose(face));
  const int pin = session.add_pin(pin_at(7 * test::grid + 9, {0, 0, 0}));
  session.begin_drag(pin, plane);
  session.drag_to(session.pin_goal(pin) + Eigen::Vector3d(0.01, 0.1, 0.05));
  session.end_drag();
  EXPECT_GT(session.pose().sliders.values[0], 0.2);
  EXPECT_NEAR(session.pose().sliders.values[0], session.pose().sliders.values[1], 1e-6);
  const std::vector<Pin> both = mirror_pins(face, {pin_at(7 * test::grid + 9, {0.1, 0.2, 0.3})}, plane);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_LT((both[1].goal - Eigen::Vector3d(-0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_THROW(mirror_pins(face, both, {Eigen::Vector3d::Zero(), 0}), Error);
}

}  // namespace
}  // namespace mien
