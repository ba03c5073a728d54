#include "mien/transfer/contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transfer/faces.h"

namespace mien::test {
namespace {

using ::testing::AnyOf;
using ::testing::IsEmpty;

constexpr int columns = 21, rows = 4;  // a lid's vertices along and across
constexpr int lid = columns * rows;

/// Two flat lids that look along +z, their rims `gap` apart around y = 0, one wide and 0.15 high each. Row 0 of either is
/// its rim; the upper lid's vertices come first.
mien::Surface lids(double gap) {
  mien::Surface s;
  s.positions.resize(2 * lid, 3);
  s.triangles.resize(4 * (columns - 1) * (rows - 1), 3);
  int t = 0;
  for (const int side : {0, 1})
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const int v = side * lid + y * columns + x;
        const double up = gap / 2 + 0.05 * y;
        s.positions.row(v) << 0.05 * x - 0.5, side == 0 ? up : -up, 0;
        if (x + 1 == columns || y + 1 == rows) continue;
        const int a = v, b = v + 1, c = v + columns, d = c + 1;
        if (side == 0) {
          s.triangles.row(t++) << a, b, d;
          s.triangles.row(t++) << a, d, c;
        } else {
          s.triangles.row(t++) << b, a, d;
          s.triangles.row(t++) << d, a, c;
        }
      }
  return s;
}

/// The upper lid's rim comes down by `by`, rows further up by less.
PointsD blink(double by) {
  PointsD delta = PointsD::Zero(2 * lid, 3);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) delta(y * columns + x, 1) = -by * (1 - y / double(rows));
  return delta;
}

/// A source with lids 0.1 apart and a guide of the same topology, faces of size one.
struct Eyes {
  mien::Surface source = lids(0.1);
  Registration registration;
  DeltaMaps maps;
  explicit Eyes(const PointsD& guide) {
    registration = no_registration(source, 1);
    registration.guide = guide;
    maps.positions = maps.aligned = source.positions;
    maps.samples = farthest_points(maps.aligned, 1000);
    maps.scale = Eigen::VectorXd::Ones(2 * lid);
    maps.samples = farthest_points(maps.aligned, 1500);
  }
  struct Looked : ContactModel {
    Looked(const Eyes& eyes, const std::vector<std::string>& names, const std::vector<PointsD>& deltas)
        : ContactModel(eyes.source, eyes.registration, eyes.maps) {
      look_at_shapes(names, [&](std::size_t s) { return deltas[s]; });
    }
  };
  Looked look_at(const std::vector<std::string>& names, const std::vector<PointsD>& deltas) const {
    return Looked(*this, names, deltas);
  }
};

/// How far the rims' middles close, as a fraction of the guide's gap.
double closed(const Eyes& eyes, const PointsD& moved) {
  const int a = columns / 2, b = lid + columns / 2;
  const double gap = eyes.registration.guide(a, 1) - eyes.registration.guide(b, 1);
  return (moved(b, 1) - moved(a, 1)) / gap;
}

TEST(ContactModel, without_shapes_nothing_touches) {
  const Eyes eyes(lids(0.1).positions);
  ContactModel model(eyes.source, eyes.registration, eyes.maps);
  model.look_at_shapes({}, [](std::size_t) { return PointsD(); });
  const DeltaDecision decision = model.decide(DeltaModel::automatic);
  EXPECT_EQ(decision.warp_share, 0);
  EXPECT_EQ(decision.contact_shapes, 0);
}

TEST(ContactModel, finds_rims_that_a_shape_brings_together) {
  const Eyes eyes(lids(0.1).positions);
  const auto model = eyes.look_at({"eyeBlink", "half", "most", "nothing"},
                                  {blink(0.1), blink(0.05), blink(0.08), PointsD::Zero(2 * lid, 3)});
  ASSERT_EQ(model.pairs(0).size(), std::size_t(columns));
  for (const ContactPair& pair : model.pairs(0)) {
    EXPECT_LT(pair.a, columns);       // an upper rim's vertex
    EXPECT_EQ(pair.b, lid + pair.a);  // and the one across
    EXPECT_NEAR(pair.closed, 1, 1e-12);
  }
  EXPECT_THAT(model.pairs(1), IsEmpty());  // half closed is not closed
  ASSERT_FALSE(model.pairs(2).empty());
  EXPECT_NEAR(model.pairs(2)[0].closed, 0.8, 1e-12);
  EXPECT_THAT(model.pairs(3), IsEmpty());
}

TEST(ContactModel, what_comes_together_along_the_skin_is_no_contact) {
  // A sheet between the lids: they do not move through open air.
  Eyes eyes(lids(0.1).positions);
  const Eigen::Index count = eyes.source.positions.rows(), faces = eyes.source.triangles.rows();
  eyes.source.positions.conservativeResize(count + 4, 3);
  eyes.source.positions.bottomRows(4) << -1, -0.06, 0, 1, -0.06, 0, 1, 0.06, 0, -1, 0.06, 0;
  eyes.source.triangles.conservativeResize(faces + 2, 3);
  eyes.source.triangles.bottomRows(2) << count, count + 1, count + 2, count, count + 2, count + 3;
  eyes.registration = no_registration(eyes.source, 1);
  eyes.maps.positions = eyes.maps.aligned = eyes.source.positions;
  eyes.maps.samples = farthest_points(eyes.maps.aligned, 1000);
  PointsD delta = PointsD::Zero(count + 4, 3);
  delta.topRows(count) = blink(0.1);
  EXPECT_THAT(eyes.look_at({"eyeBlink"}, {delta}).pairs(0), IsEmpty());
}

TEST(ContactModel, knows_lids_by_name) {
  const Eyes eyes(lids(0.1).positions);
  const PointsD shut = blink(0.1);
  const auto model = eyes.look_at({"eyeBlinkLeft", "LeftUpperLidClosed", "mouthClose", "jawOpen", "eyeWide"},
                                  {shut, shut, shut, shut, PointsD::Zero(2 * lid, 3)});
  EXPECT_TRUE(model.closes_lid(0));
  EXPECT_TRUE(model.closes_lid(1));
  EXPECT_FALSE(model.closes_lid(2));
  EXPECT_FALSE(model.closes_lid(3));
  EXPECT_FALSE(model.closes_lid(4));  // nothing touches
}

TEST(ContactModel, closes_lids_over_a_larger_eye) {
  const Eyes eyes(lids(0.15).positions);
  const auto model = eyes.look_at({"eyeBlink"}, {blink(0.1)});
  PointsD moved = blink(0.1);
  EXPECT_NEAR(closed(eyes, moved), 2.0 / 3, 1e-9);
  model.close_lids(0, moved);
  EXPECT_NEAR(closed(eyes, moved), 1, 0.02);
  EXPECT_EQ(moved.bottomRows(lid).norm(), 0);               // the still lid stays still
  EXPECT_EQ(moved.col(0).norm() + moved.col(2).norm(), 0);  // directions stay
}

TEST(ContactModel, holds_lids_back_over_a_smaller_eye) {
  const Eyes eyes(lids(0.07).positions);
  const auto model = eyes.look_at({"eyeBlink"}, {blink(0.1)});
  PointsD moved = blink(0.1);
  model.close_lids(0, moved);
  EXPECT_NEAR(closed(eyes, moved), 1, 0.02);
}

TEST(ContactModel, leaves_lids_that_close_and_all_other_shapes_alone) {
  const PointsD shut = blink(0.1);
  const Eyes same(lids(0.1).positions);
  PointsD moved = shut;
  same.look_at({"eyeBlink"}, {shut}).close_lids(0, moved);
  EXPECT_EQ(moved, shut);
  const Eyes larger(lids(0.15).positions);
  const auto model = larger.look_at({"mouthClose", "eyeSquint"}, {shut, blink(0.04)});
  model.close_lids(0, moved);
  EXPECT_EQ(moved, shut);
  moved = blink(0.04);
  model.close_lids(1, moved);
  EXPECT_EQ(moved, blink(0.04));
}

TEST(ContactModel, a_lid_that_hardly_crosses_the_eye_follows_the_warp) {
  for (const auto& [gap, share] : std::vector<std::pair<double, double>>{
           {0.1, 0}, {0.1 / 0.8, 0}, {0.1 / 0.7, 0.5}, {0.1 / 0.6, 1}, {0.3, 1}}) {
    const Eyes eyes(lids(gap).positions);
    const auto model = eyes.look_at({"eyeBlink", "mouthClose"}, {blink(0.1), blink(0.1)});
    EXPECT_NEAR(model.lid_warp_share(0, blink(0.1)), share, 1e-9) << gap;
    EXPECT_EQ(model.lid_warp_share(1, blink(0.1)), 0) << gap;
  }
}

TEST(ContactModel, a_model_asked_for_by_name_is_taken) {
  const Eyes eyes(lids(0.1).positions);
  const ContactModel model(eyes.source, eyes.registration, eyes.maps);
  for (const DeltaModel wanted :
       {DeltaModel::local, DeltaModel::raw, DeltaModel::copy, DeltaModel::warp, DeltaModel::thesis}) {
    const DeltaDecision decision = model.decide(wanted);
    EXPECT_EQ(decision.model, wanted);
    EXPECT_EQ(decision.warp_share, wanted == DeltaModel::warp ? 1 : 0);
    EXPECT_EQ(decision.reason, "asked for by name");
  }
}

/// A guide whose height is `stretch` times the source's, and `shapes` blinks.
DeltaDecision decide_on(double stretch, int shapes) {
  PointsD guide = lids(0.1).positions;
  guide.col(1) *= stretch;
  const Eyes eyes(guide);
  return eyes.look_at(std::vector<std::string>(shapes, "eyeBlink"), std::vector<PointsD>(shapes, blink(0.1)))
      .decide(DeltaModel::automatic);
}

TEST(ContactModel, fewer_than_five_contacts_say_nothing) {
  const DeltaDecision decision = decide_on(1.6, 4);
  EXPECT_EQ(decision.contact_shapes, 4);
  EXPECT_EQ(decision.warp_share, 0);
  EXPECT_EQ(decision.reason,
            "fewer than 5 source shapes close a gap, so contacts say nothing: smooth local scale");
}

TEST(ContactModel, warps_where_only_the_map_keeps_contacts) {
  const DeltaDecision decision = decide_on(1.6, 5);
  EXPECT_EQ(decision.contact_shapes, 5);
  EXPECT_LT(decision.contact_ratio, 0.3);
  EXPECT_GT(decision.stretch, 0.1);
  EXPECT_EQ(decision.warp_share, 1);
  EXPECT_EQ(decision.reason, "the source's contacts are kept by following the map: warp");
}

TEST(ContactModel, does_not_warp_what_is_only_scaled) {
  const DeltaDecision decision = decide_on(1, 6);
  EXPECT_EQ(decision.contact_shapes, 6);
  EXPECT_NEAR(decision.stretch, 0, 1e-6);
  EXPECT_EQ(decision.warp_share, 0);
  EXPECT_EQ(decision.reason,
            "the source's contacts are kept no better by following the map: smooth local scale");
}

}  // namespace
}  // namespace mien::test
