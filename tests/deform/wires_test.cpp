#include "mien/deform/wires.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mien/core/error.h"
#include "mien/deform/bind_wires.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

constexpr int side = 21;

/// Flat grids of 21 x 21 vertices over [-1, 1] x [-1, 1], one a part, each a little above the last.
Character flat(int parts = 1) {
  Character character;
  for (int p = 0; p < parts; ++p) {
    Part& part = character.parts.emplace_back();
    part.name = "flat" + std::to_string(p);
    part.mesh.positions.resize(side * side, 3);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        part.mesh.positions.row(y * side + x) << 0.1f * static_cast<float>(x) - 1,
            0.1f * static_cast<float>(y) - 1, 0.05f * static_cast<float>(p);
        if (x + 1 == side || y + 1 == side) continue;
        const int a = y * side + x;
        part.mesh.faces.push_back({a, a + 1, a + side + 1, a + side});
      }
  }
  return character;
}

/// A straight wire along y = 0 (or another height), from end to end.
Wire straight(double y = 0) {
  Wire wire;
  wire.name = "straight";
  wire.curve.knots = clamped_knots(6);
  wire.curve.controls.resize(6, 3);
  // A B-spline with its control points at the Greville abscissae is a straight line at constant speed.
  const double greville[] = {0, 1 / 9.0, 1 / 3.0, 2 / 3.0, 8 / 9.0, 1};
  for (int l = 0; l < 6; ++l) wire.curve.controls.row(l) << 2 * greville[l] - 1, y, 0;
  wire.ranges = {0.5};
  wire.turn_controls = 0;
  return wire;
}

PointsD moved(const Character& character, const std::vector<Wire>& wires, const std::vector<WireMove>& moves,
              int part = 0) {
  PointsD positions = character.parts[part].mesh.positions.cast<double>();
  WireField(character, wires).add(part, moves, positions);
  return positions - character.parts[part].mesh.positions.cast<double>();
}

WireMove shift(const Eigen::Vector3d& by, int wire = 0) {
  return {wire, by.transpose().replicate(6, 1), 0, {}};
}

std::string error_of(const Character& character, Wire wire, const std::vector<WireMove>& moves = {}) {
  try {
    moved(character, bind_wires(character, {std::move(wire)}), moves);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(WiresInvalid, NamesWhatIsWrong) {
  const Character character = flat();
  Wire wire = straight();
  wire.ranges = {};
  EXPECT_EQ(error_of(character, wire), "wire straight: has no range; a length above 0");
  wire.ranges = {0.5, -1};
  EXPECT_THAT(error_of(character, wire), HasSubstr("wire straight: has range -1"));
  wire = straight();
  wire.falloff = {{0, 1}, {0, 0.5}};
  EXPECT_THAT(error_of(character, wire), HasSubstr("wire straight, falloff point 1: is out of order"));
  wire = straight();
  wire.localizing = -1;
  EXPECT_THAT(error_of(character, wire), HasSubstr("localizing exponent that is negative"));
  wire = straight();
  wire.curve.controls.col(2).array() += 5;
  EXPECT_EQ(error_of(character, wire),
            "wire straight: is further from the surface than it reaches; a curve on the surface");
  wire.geodesic = false;
  EXPECT_EQ(error_of(character, wire),
            "wire straight: reaches no vertex; a longer range or a curve on the surface");
  EXPECT_EQ(error_of(character, straight(), {{1, {}, 0, {}}}), "wire 1: does not exist; a wire from 0 to 0");
  EXPECT_EQ(error_of(character, straight(), {{0, PointsD::Zero(5, 3), 0, {}}}),
            "wire straight: is moved by 5 control points; 6");
  EXPECT_EQ(error_of(character, straight(), {{0, {}, std::numeric_limits<double>::quiet_NaN(), {}}}),
            "wire straight: has a scale that is not finite");
}

// A shift of the whole curve moves a vertex at distance d by f(d / range) times the shift; a scale by f sigma times its offset.
TEST(Wires, OneWireInClosedForm) {
  const Character character = flat();
  for (const bool geodesic : {false, true}) {
    Wire wire = straight();
    wire.geodesic = geodesic;
    const std::vector<Wire> wires = bind_wires(character, {wire});
    const PointsD rest = character.parts[0].mesh.positions.cast<double>();
    WireMove move = shift({0.1, 0.2, 0.3});
    move.scale = 0.5;
    const PointsD by = moved(character, wires, {move});
    for (Eigen::Index v = 0; v < rest.rows(); ++v) {
      const double x = std::abs(rest(v, 1)) / 0.5, f = x < 1 ? (x * x - 1) * (x * x - 1) : 0;
      EXPECT_LT((by.row(v) - f * Eigen::RowVector3d(0.1, 0.2 + 0.5 * rest(v, 1), 0.3)).norm(), 2e-5);
    }
  }
}

TEST(Wires, TurnsRotateAboutTheCurve) {
  const Character character = flat();
  Wire wire = straight();
  wire.turn_controls = 4;
  const std::vector<Wire> wires = bind_wires(character, {wire});
  WireMove move;
  move.turns = Eigen::RowVector3d(0.01, 0, 0).replicate(4, 1);  // about x: what lies at +y goes up
  const PointsD by = moved(character, wires, {move});
  for (Eigen::Index v = 0; v < by.rows(); ++v) {
    const double y = character.parts[0].mesh.positions(v, 1), f = falloff_at(wire, std::abs(y) / 0.5);
    EXPECT_LT((by.row(v) - f * Eigen::RowVector3d(0, 0, 0.01 * y)).norm(), 1e-6);
  }
}

TEST(Wires, RangesMayVaryAndFalloffsMayBeDrawn) {
  const Character character = flat();
  Wire wire = straight();
  wire.ranges = {0.2, 0.6};
  wire.falloff = {{0, 1}, {0.5, 0.5}, {1, 0}};
  wire.geodesic = false;
  const PointsD by = moved(character, bind_wires(character, {wire}), {shift({0, 0, 1})});
  for (Eigen::Index v = 0; v < by.rows(); ++v) {
    const double x = character.parts[0].mesh.positions(v, 0), y = character.parts[0].mesh.positions(v, 1);
    const double range = 0.2 + 0.4 * (x + 1) / 2;
    EXPECT_NEAR(by(v, 2), std::max(0.0, 1 - std::abs(y) / range), 1e-4);
  }
}

// Two wires share a vertex by f^k / sum f^k: where both hold it alike it takes the mean, and a high k leaves it to the nearer one.
TEST(Wires, SeveralAreSharedOut) {
  const Character character = flat();
  for (const double k : {0.0, 3.0, 30.0}) {
    Wire low = straight(-0.2), high = straight(0.2);
    high.name = "high";
    low.ranges = high.ranges = {0.8};
    low.localizing = high.localizing = k;
    low.geodesic = high.geodesic = false;
    const std::vector<Wire> wires = bind_wires(character, {low, high});
    const PointsD by = moved(character, wires, {shift({0, 0, 1}), shift({0, 0, 3}, 1)});
    const auto at = [&](double y) { return by(static_cast<int>(std::lround(10 * (y + 1))) * side + 10, 2); };
    EXPECT_NEAR(at(0), 2 * falloff_at(low, 0.25), 1e-5);
    const double f = falloff_at(low, 0.5), one = 1, share = std::pow(f, k) / (std::pow(f, k) + one);
    EXPECT_NEAR(at(0.2), share * f * 1 + (1 - share) * 3, 1e-4);
  }
}

TEST(Wires, AnAdjustedPointMovesLess) {
  const Character character = flat();
  std::vector<Wire> wires = bind_wires(character, {straight()});
  const PointsD before = moved(character, wires, {shift({0, 0, 1})});
  wires[0].bindings[0].falloff[3] = 0.25f;
  const int vertex = wires[0].bindings[0].vertices[3];
  const PointsD after = moved(character, wires, {shift({0, 0, 1})});
  EXPECT_NEAR(after(vertex, 2), 0.25, 1e-6);
  for (Eigen::Index v = 0; v < after.rows(); ++v) {
    if (v != vertex) {
      EXPECT_EQ(after(v, 2), before(v, 2));
    }
  }
}

TEST(Wires, OneCurveActsOnSeveralParts) {
  const Character character = flat(2);
  Wire wire = straight();
  wire.geodesic = false;
  const std::vector<Wire> wires = bind_wires(character, {wire});
  ASSERT_EQ(wires[0].bindings.size(), 2u);
  EXPECT_NEAR(moved(character, wires, {shift({0, 0, 1})}, 1)(10 * side + 10, 2), falloff_at(wire, 0.1), 1e-5);
}

TEST(Wires, AtRestNothingMovesBitForBit) {
  const Character character = flat();
  const std::vector<Wire> wires = bind_wires(character, {straight()});
  EXPECT_TRUE(moved(character, wires, {}).isZero(0));
  EXPECT_TRUE(moved(character, wires, {{0, PointsD::Zero(6, 3), 0, {}}}).isZero(0));
}

}  // namespace
}  // namespace mien
