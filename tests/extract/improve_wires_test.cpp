#include "mien/extract/improve_wires.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "extract/made_wires.h"
#include "mien/deform/bind_wires.h"

namespace mien {
namespace {

using test::human;
using test::human_wires;
using test::text_of_error;

const Wire& named(const std::vector<Wire>& wires, const std::string& name) {
  return *std::find_if(wires.begin(), wires.end(), [&](const Wire& wire) { return wire.name == name; });
}

double error_of(const std::vector<Wire>& wires) {
  const ExtractResult result = extract_wires(human(), wires);
  return result.error / result.displacement;
}

TEST(ImproveWiresInvalid, NamesWhatIsWrong) {
  EXPECT_EQ(text_of_error([] { improve_wires(human(), {}); }), "wires: are none; one or more");
  EXPECT_EQ(text_of_error([] { move_curves(human(), {}); }), "wires: are none; one or more");
  Character still = human();
  still.shapes.clear();
  still.sliders.clear();
  still.clips.clear();
  EXPECT_EQ(text_of_error([&] { move_curves(still, human_wires()); }),
            "shapes: move nothing that the wires reach; shapes of the face");
  EXPECT_EQ(text_of_error([&] { propose_wire(still, extract_wires(still, human_wires())); }),
            "shapes: are rebuilt without error; nothing to add");
}

TEST(ImproveWires, LeavesLessThanBefore) {
  ImproveOptions options;
  options.sweeps = 1;
  options.fixed = {"chin"};
  const std::vector<Wire>& wires = human_wires();
  const ImproveResult improved = improve_wires(human(), wires, options);
  EXPECT_LE(improved.after, improved.before);
  EXPECT_EQ(named(improved.wires, "chin").ranges, named(wires, "chin").ranges);
  EXPECT_EQ(named(improved.wires, "brow_R").ranges, named(improved.wires, "brow_L").ranges);
}

/// All wires but those whose name begins with one of these.
std::vector<std::string> all_but(const std::vector<const char*>& names) {
  std::vector<std::string> others;
  for (const Wire& wire : human_wires())
    if (std::none_of(names.begin(), names.end(),
                     [&](const char* name) { return wire.name.rfind(name, 0) == 0; }))
      others.push_back(wire.name);
  return others;
}

TEST(MoveCurves, LeavesLessAndKeepsTwinsMirrored) {
  ImproveOptions options;
  options.sweeps = 1;
  options.fixed = all_but({"brow", "lidUpper", "jaw"});
  const std::vector<Wire>& wires = human_wires();
  const ImproveResult moved = move_curves(human(), wires, options);
  EXPECT_LT(moved.after, moved.before);
  EXPECT_EQ(named(moved.wires, "chin").curve, named(wires, "chin").curve);
  const double size = bounding_box(human().parts[0].mesh.positions).diagonal();
  double furthest = 0;
  for (std::size_t w = 0; w < wires.size(); ++w) {
    ASSERT_EQ(moved.wires[w].points.size(), wires[w].points.size());
    EXPECT_EQ(moved.wires[w].ranges, wires[w].ranges);
    const double off = (moved.wires[w].curve.controls - wires[w].curve.controls).rowwise().norm().maxCoeff();
    furthest = std::max(furthest, off / wires[w].ranges[0]);
  }
  EXPECT_GT(furthest, 0.02);
  EXPECT_LT(furthest, 0.6);
  for (const char* name : {"brow", "lidUpper", "jaw"}) {
    const Eigen::RowVector3d left =
                                 named(moved.wires, std::string(name) + "_L").curve.controls.colwise().mean(),
                             right =
                                 named(moved.wires, std::string(name) + "_R").curve.controls.colwise().mean();
    // One side moves after the other has: mirrored but for what the second finds changed by the first.
    EXPECT_NEAR(left.x(), -right.x(), 0.01 * size) << name;
    EXPECT_NEAR(left.y(), right.y(), 0.01 * size) << name;
  }
}

TEST(MoveCurves, FindsItsWayBackToTheCurvesThatMadeTheShapes) {
  // A face whose shapes are what known wires do, and one of them displaced.
  Character face = human();
  const std::vector<Wire>& wires = human_wires();
  const WireSolver solver(face, wires);
  face.shapes.clear();
  face.sliders.clear();
  face.clips.clear();
  std::vector<WireMove> moves = test::some_moves(wires);
  for (int s = 0; s < 4; ++s) {
    for (WireMove& move : moves) move.controls = (move.controls * (s % 2 ? -0.8 : 1.1)).eval();
    std::rotate(moves.begin(), moves.begin() + 3, moves.end());
    std::vector<WireMove> some(moves.begin(), moves.begin() + 6);
    face.shapes.push_back({"known" + std::to_string(s), solver.apply(some)});
  }
  std::vector<WireSketch> sketches = face_wire_sketches(face, 15);
  const WireBinder binder(face);
  const double size = bounding_box(face.parts[0].mesh.positions).diagonal();
  for (WireSketch& sketch : sketches)
    if (sketch.name == "brow_L" || sketch.name == "brow_R")
      for (SurfacePoint& point : sketch.points)
        point = binder.moved(point, Eigen::Vector3d(0, 0.02 * size, 0));
  ImproveOptions options;
  options.sweeps = 3;
  options.fixed = all_but({"brow"});
  const std::vector<Wire> displaced = draw_wires(face, sketches);
  const ImproveResult moved = move_curves(face, displaced, options);
  EXPECT_LT(moved.after, 0.8 * moved.before);
  const auto off = [&](const std::vector<Wire>& list) {
    return std::abs(named(list, "brow_L").curve.controls.col(1).mean() -
                    named(wires, "brow_L").curve.controls.col(1).mean());
  };
  EXPECT_LT(off(moved.wires), 0.7 * off(displaced));
}

TEST(ProposeWire, HelpsWhereOneIsMissing) {
  std::vector<Wire> wires = human_wires();
  wires.erase(std::remove_if(wires.begin(), wires.end(),
                             [](const Wire& wire) { return wire.name == "chin" || wire.name == "jaw_L"; }),
              wires.end());
  const ExtractResult result = extract_wires(human(), wires);
  const WireSketch sketch = propose_wire(human(), result);
  EXPECT_EQ(sketch.name, "extra_14");
  EXPECT_EQ(sketch.feature, "extra");
  std::vector<Wire> more = wires;
  more.push_back(draw_wires(human(), std::span(&sketch, 1)).front());
  EXPECT_LT(error_of(more), error_of(wires));
}

}  // namespace
}  // namespace mien
