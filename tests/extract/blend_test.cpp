#include "mien/extract/blend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "extract/made_wires.h"
#include "mien/evaluate/evaluate.h"
#include "mien/extract/edit_wires.h"
#include "mien/extract/extract_wires.h"

namespace mien {
namespace {

using test::human;
using test::text_of_error;

const Character& rigged() {
  static const Character character = extract_wires(human(), test::human_wires()).character;
  return character;
}

ShapeWeights weights(const Character& character, const char* shape) {
  ShapeWeights result(character.shapes.size());
  result.values[find_shape(character, shape)] = 1;
  return result;
}

TEST(BlendInvalid, NamesWhatIsWrong) {
  const Character& face = rigged();
  const ShapeWeights from = weights(face, "jawOpen"), to = weights(face, "eyeBlinkLeft");
  BlendOptions options;
  EXPECT_EQ(text_of_error([&] { blend(human(), from, to, options); }),
            "wires: are none; a character with wires (mien wires)");
  options.functions = {{"ears", {}}};
  EXPECT_EQ(text_of_error([&] { blend(face, from, to, options); }),
            "feature ears: has no wire; there are brows, eyes, nose, mouth, jaw");
  options = {};
  options.frames = 1;
  EXPECT_EQ(text_of_error([&] { blend(face, from, to, options); }), "frames: are 1; 2 to 100000");
  EXPECT_THAT(text_of_error([] { blend_function("cubic"); }),
              ::testing::StartsWith("function cubic: is not one; "));
  EXPECT_THAT(text_of_error([] { blend_function("0,0;0,1"); }),
              ::testing::HasSubstr("has points out of order"));
}

TEST(BlendFunction, NamedAndDrawn) {
  EXPECT_DOUBLE_EQ(blend_function("sqrt")(0.25), 0.5);
  EXPECT_DOUBLE_EQ(blend_function("cube")(0.5), 0.125);
  EXPECT_DOUBLE_EQ(blend_function("linear")(0.3), 0.3);
  EXPECT_DOUBLE_EQ(blend_function("(0,0),(0.5,0.8),(1,1)")(0.25), 0.4);
}

TEST(FeatureShapes, AddUpToTheExpression) {
  const Character& face = rigged();
  const ShapeWeights smile = weights(face, "mouthSmileLeft");
  Character parts = face;
  parts.shapes = feature_shapes(face, smile, "part");
  parts.sliders.clear();
  Pose whole = rest_pose(face), sum = rest_pose(parts);
  whole.shape_weights = smile;
  sum.shape_weights.values.setOnes(static_cast<Eigen::Index>(parts.shapes.size()));
  const auto wanted = evaluate(face, whole), got = evaluate(parts, sum);
  for (std::size_t p = 0; p < wanted.size(); ++p)
    EXPECT_LT((wanted[p] - got[p]).cwiseAbs().maxCoeff(), 1e-5 * bounding_box(wanted[0]).diagonal());
}

TEST(Blend, EndsAreTheExpressionsAndFeaturesKeepTheirPace) {
  const Character& face = rigged();
  const ShapeWeights from = weights(face, "jawOpen"), to = weights(face, "eyeBlinkLeft");
  BlendOptions options;
  options.functions = {{"eyes", blend_function("sqrt")}, {"mouth", blend_function("cube")}};
  options.frames = 11;
  const Character blended = blend(face, from, to, options);
  const Clip& clip = blended.clips.back();
  EXPECT_NEAR(clip.duration(), 10 / 30.0, 1e-6);
  const double tolerance = 1e-5 * bounding_box(face.parts[0].mesh.positions).diagonal();
  const auto at = [&](double seconds) { return evaluate(blended, sample_clip(blended, clip, seconds)); };
  Pose pose = rest_pose(face);
  for (const auto& [seconds, weights] : {std::pair(0.0, from), std::pair(clip.duration(), to)}) {
    pose.shape_weights = weights;
    const auto wanted = evaluate(face, pose), got = at(seconds);
    for (std::size_t p = 0; p < wanted.size(); ++p)
      EXPECT_LT((wanted[p] - got[p]).cwiseAbs().maxCoeff(), tolerance);
  }
  // Early on the lids are ahead: at a quarter of the time they have half of their way behind them.
  const Pose quarter = sample_clip(blended, clip, clip.duration() / 4);
  EXPECT_NEAR(quarter.shape_weights.values[find_shape(blended, "blend.to.eyes")], 0.5, 0.02);
}

TEST(EditWires, MovesTheSurfaceAndIsUndone) {
  const Character& face = rigged();
  const int smile = find_shape(face, "mouthSmileLeft");
  std::vector<WireMove> moves = exaggerate_wires(face, smile, 1.5, "mouth");
  ASSERT_FALSE(moves.empty());
  const Character edited = edit_wires(face, smile, moves);
  for (WireMove& move : moves) {
    move.controls *= -1;
    move.turns *= -1;
    move.scale *= -1;
  }
  const Character undone = edit_wires(edited, smile, moves);
  Pose pose = rest_pose(face);
  pose.shape_weights = weights(face, "mouthSmileLeft");
  const auto before = evaluate(face, pose), between = evaluate(edited, pose), after = evaluate(undone, pose);
  const double box = bounding_box(before[0]).diagonal();
  double changed = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    changed = std::max<double>(changed, (between[p] - before[p]).cwiseAbs().maxCoeff());
    EXPECT_LT((after[p] - before[p]).cwiseAbs().maxCoeff(), 1e-6 * box);
  }
  EXPECT_GT(changed, 1e-3 * box);
  EXPECT_EQ(text_of_error([&] { exaggerate_wires(face, smile, 2, "ears"); }),
            "feature ears: has no wire; a feature of the wires");
}

TEST(PoseWires, AddToTheEvaluatedFaceAndToClips) {
  Character face = rigged();
  Clip clip;
  clip.name = "brow up";
  Channel channel;
  channel.property = Channel::Property::wire_control;
  channel.wire = 0;
  channel.control = 4;
  channel.times = {0, 1};
  channel.values = {0, 0, 0, 0, 0.2f, 0};
  clip.channels.push_back(channel);
  const auto rest = evaluate(face, rest_pose(face)), still = evaluate(face, sample_clip(face, clip, 0)),
             moved = evaluate(face, sample_clip(face, clip, 1));
  EXPECT_EQ(rest[0], still[0]);
  const float up = (moved[0] - rest[0]).col(1).maxCoeff();
  EXPECT_GT(up, 0.02f);
  EXPECT_LT((moved[0] - rest[0]).col(0).cwiseAbs().maxCoeff(), 1e-6f);
}

}  // namespace
}  // namespace mien
