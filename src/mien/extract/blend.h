#pragma once
/// Blending expressions feature by feature: the eyes may be ahead of the mouth.

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// g: [0, 1] -> share of the second expression.
struct BlendFunction {
  std::vector<Eigen::Vector2d>
      points;        ///< (t, g) by ascending t, linear between them and constant beyond; empty: `power`
  double power = 1;  ///< g(t) = t^power
  double operator()(double t) const;
};

/// "linear" (t), "sqrt" (t^0.5), "cube" (t^3), or points: "0,0;0.3,0.9;1,1" or "(0,0),(0.3,0.9),(1,1)".
///   throws  invalid_input: another name; points that are fewer than two, out of order or not finite
BlendFunction blend_function(std::string_view text);

struct FeatureFunction {
  std::string feature;
  BlendFunction function;
};

/// What each feature's wires do in an expression, as shapes that add up to it: a vertex's residual goes to the features by the
/// shares of their wires there, a piece without wires to the features of the skin around it, and what no wire is near to a last shape.
///   weights  #S, the expression
///   returns  one shape a feature (in the order of `wire_features`), and one for the rest; named `name`.FEATURE and `name`.rest
///   throws   invalid_input: no wires; not one weight a shape, one that is not finite
std::vector<Shape> feature_shapes(const Character& character, const ShapeWeights& weights,
                                  const std::string& name);

struct BlendOptions {
  std::vector<FeatureFunction> functions;  ///< features that are not named, and the rest, follow `uniform`
  BlendFunction uniform;
  int frames = 60;  ///< two or more, both ends included
  double frames_per_second = 30;
  std::string name = "blend";  ///< of the clip and its shapes
};

/// The character with a clip from one expression to the other. Features that follow their own function become shapes of the
/// character, so that every program that plays shape weights plays the clip.
///   throws  invalid_input: as `feature_shapes`; a feature that no wire has, or twice; fewer than two frames or more than 100,000; a
///           frame rate that is not above 0; a clip of that name
///   method  Pyun, Shin and Shin 2001, Figs. 4 to 6
Character blend(const Character& character, const ShapeWeights& from, const ShapeWeights& to,
                const BlendOptions& options = {});

}  // namespace mien
