#include "mien/extract/extract_wires.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "extract/made_wires.h"
#include "mien/core/error.h"
#include "mien/deform/bind_wires.h"
#include "mien/evaluate/evaluate.h"
#include "mien/extract/draw_wires.h"

namespace mien {
namespace {

using test::human;
using test::human_wires;
using test::text_of_error;

TEST(ExtractWiresInvalid, NamesWhatIsWrong) {
  const Character& face = human();
  EXPECT_EQ(text_of_error([&] { WireSolver(face, {}); }), "wires: are none; one or more");
  std::vector<Wire> wires = human_wires();
  wires[3].bindings.clear();
  EXPECT_EQ(text_of_error([&] { WireSolver(face, wires); }),
            "wire lidUpper_L: reaches no vertex; bind it first");
  wires = human_wires();
  wires[1].name = wires[0].name;
  EXPECT_EQ(text_of_error([&] { extract_wires(face, wires); }),
            "wire brow_R: is there twice; names of their own");
  EXPECT_THAT(text_of_error([&] { WireSolver(face, human_wires(), {.ridge = 0, .vertex_weights = {}}); }),
              ::testing::StartsWith("ridge: is 0"));
}

TEST(DrawWiresInvalid, NamesTheWire) {
  const Character& face = human();
  std::vector<WireSketch> sketches = face_wire_sketches(face, 15);
  sketches.resize(1);
  WireSketch good = sketches[0];
  sketches[0].points.resize(3);
  EXPECT_EQ(text_of_error([&] { draw_wires(face, sketches); }),
            "wire brow_R: has 3 points; a cubic needs four or more");
  sketches[0] = good;
  sketches[0].controls = 3;
  EXPECT_EQ(text_of_error([&] { draw_wires(face, sketches); }),
            "wire brow_R: has 3 control points; a cubic needs four or more, at most 1000");
  sketches[0] = good;
  sketches[0].range = -1;
  EXPECT_THAT(text_of_error([&] { draw_wires(face, sketches); }),
              ::testing::StartsWith("wire brow_R: has range -1"));
  sketches[0].range = 1e-12;
  EXPECT_EQ(text_of_error([&] { draw_wires(face, sketches); }),
            "wire brow_R: reaches no vertex; a longer range or a curve on the surface");
  sketches[0] = good;
  sketches[0].points[2].vertex = 1 << 28;
  EXPECT_THAT(text_of_error([&] { draw_wires(face, sketches); }),
              ::testing::StartsWith("wire brow_R: has a point on vertex 268435456"));
  EXPECT_EQ(text_of_error([&] { face_wire_sketches(Character{}, 22); }),
            "landmark ibug_18: is missing; the 68 iBUG landmarks, or curves of your own");
}

TEST(ExtractWires, FindsKnownWiresAgain) {
  const Character& face = human();
  const std::vector<Wire> wires = human_wires();
  const WireSolver solver(face, wires, {.ridge = 1e-12, .vertex_weights = {}});
  const std::vector<WireMove> known = test::some_moves(wires);
  Shape shape{"known", solver.apply(known)};
  const std::vector<WireMove> found = solver.solve(shape);
  ASSERT_EQ(found.size(), wires.size());
  const std::vector<PartDelta> again = solver.apply(found);
  double largest = 0, moved = 0;
  for (std::size_t p = 0; p < again.size(); ++p) {
    largest = std::max(largest, double((again[p].deltas - shape.parts[p].deltas).cwiseAbs().maxCoeff()));
    moved = std::max(moved, double(shape.parts[p].deltas.cwiseAbs().maxCoeff()));
  }
  EXPECT_LT(largest, 1e-4 * moved);
}

TEST(ExtractWires, NeutralHasNoMoves) {
  const WireSolver solver(human(), human_wires());
  EXPECT_TRUE(solver.solve(Shape{"neutral", {}}).empty());
}

TEST(ExtractWires, RebuildsTheBuiltInHumanAndKeepsWhatItCannot) {
  const Character& face = human();
  const ExtractResult result = extract_wires(face, human_wires());
  ASSERT_EQ(result.shapes.size(), face.shapes.size());
  EXPECT_LT(result.error, 0.35 * result.displacement);
  EXPECT_LT(result.kept_error, result.error);
  for (const WireFit& fit : result.shapes)
    for (const WireMove& move : fit.moves) EXPECT_LT(move.controls.rowwise().norm().maxCoeff(), result.box);
  // The new shapes are off by at most what is not kept.
  const double threshold = 0.002 * result.box;
  for (std::size_t s = 0; s < face.shapes.size(); ++s) {
    Pose pose = rest_pose(face);
    pose.shape_weights.values.setZero();
    pose.shape_weights.values[static_cast<Eigen::Index>(s)] = 1;
    const auto before = evaluate(face, pose), after = evaluate(result.character, pose);
    for (std::size_t p = 0; p < before.size(); ++p)
      EXPECT_LT((before[p] - after[p]).rowwise().norm().maxCoeff(), 1.001 * threshold) << face.shapes[s].name;
  }
}

TEST(ExtractWires, CountsApartWhatCanBeSeen) {
  const Character& face = human();
  const ExtractResult all = extract_wires(face, human_wires());
  EXPECT_EQ(all.seen_displacement, all.displacement);
  EXPECT_EQ(all.seen_error, all.error);
  EXPECT_EQ(all.seen_largest, all.largest);
  const auto with_weights = [&](float left, float right) {
    ExtractOptions options;
    for (const Part& part : face.parts)
      options.solver.vertex_weights.push_back(
          (part.mesh.positions.col(0).array() > 0)
              .select(Eigen::VectorXf::Constant(part.mesh.positions.rows(), left), right));
    return extract_wires(face, human_wires(), options);
  };
  EXPECT_EQ(with_weights(0.02f, 0.02f).seen_displacement, 0);
  const ExtractResult left = with_weights(1, 0.02f), right = with_weights(0.02f, 1);
  EXPECT_NEAR(std::hypot(left.seen_displacement, right.seen_displacement), all.displacement,
              1e-9 * all.displacement);
  EXPECT_LT(left.seen_error, right.error);
}

TEST(ExtractWires, ExactKeepsEveryShape) {
  const Character& face = human();
  ExtractOptions options;
  options.exact = true;
  const Character exact = extract_wires(face, human_wires(), options).character;
  for (std::size_t s = 0; s < face.shapes.size(); ++s) {
    ASSERT_EQ(exact.shapes[s].parts.size(), face.shapes[s].parts.size());
    for (std::size_t p = 0; p < face.shapes[s].parts.size(); ++p)
      EXPECT_EQ(exact.shapes[s].parts[p].deltas, face.shapes[s].parts[p].deltas);
  }
}

TEST(ExtractWires, ScaleAndRigidMotionChangeNothing) {
  const Character& face = human();
  const Character moved = test::moved_character(face, 100);
  const auto error = [](const Character& character) {
    const ExtractResult result =
        extract_wires(character, draw_wires(character, face_wire_sketches(character, 15)));
    return result.error / result.displacement;
  };
  EXPECT_NEAR(error(moved), error(face), 1e-3);
}

TEST(ExtractWires, KeepsAResidualOnAsManyVerticesAsAllowed) {
  const Character& face = human();
  ExtractOptions options;
  options.residual = 0;
  options.residual_vertices = 0.02;
  const ExtractResult result = extract_wires(face, human_wires(), options);
  std::size_t kept = 0;
  for (const WireFit& fit : result.shapes)
    for (const PartDelta& delta : fit.residual) kept += delta.vertices.size();
  const double most = 0.02 * static_cast<double>(result.skin_vertices * result.shapes.size());
  EXPECT_LE(static_cast<double>(kept), most);
  EXPECT_GT(static_cast<double>(kept), 0.95 * most);
  EXPECT_LT(result.kept_error, 0.9 * result.error);
  options.residual_vertices = 1.5;
  EXPECT_EQ(text_of_error([&] { extract_wires(face, human_wires(), options); }),
            "residual vertices: are 1.500000; a share of the vertices, 0 to 1");
}

TEST(ExtractWires, ManyShapesAtOnceAreSolvedAsOneByOne) {
  const Character& face = human();
  const WireSolver solver(face, human_wires());
  const std::vector<std::vector<WireMove>> all = solver.solve(face.shapes);
  ASSERT_EQ(all.size(), face.shapes.size());
  for (std::size_t s = 0; s < face.shapes.size(); s += 7) {
    const std::vector<WireMove> one = solver.solve(face.shapes[s]);
    ASSERT_EQ(one.size(), all[s].size());
    for (std::size_t w = 0; w < one.size(); ++w) {
      EXPECT_TRUE(one[w].controls.isApprox(all[s][w].controls, 1e-9));
      EXPECT_TRUE(one[w].turns.isApprox(all[s][w].turns, 1e-9));
    }
  }
}

}  // namespace
}  // namespace mien
