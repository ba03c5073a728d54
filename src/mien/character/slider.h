#pragma once
/// What an animator moves, and how it drives the shapes: sliders with their in-betweens, combination
/// correctives, saved expressions. Data only; sliders.h turns slider values into shape weights.

#include <string>
#include <vector>

namespace mien {

/// A shape that a slider shows in full at one of its values.
struct SliderStop {
  double at = 1;  ///< slider value, not 0 (there the slider shows the neutral)
  int shape = 0;  ///< index into Character::shapes
  bool operator==(const SliderStop&) const = default;
};

/// One control of the face. Between its stops, and between a stop and the neutral at 0, the shape weights are
/// linear in the slider's value; beyond the outermost stops the last piece goes on. One stop at 1 is a plain
/// slider; stops at 0.5 and 1 an in-between; stops at -1 and 1 two shapes of opposite directions; a value
/// above the maximum over-drives.
struct Slider {
  std::string name;
  double minimum = 0, maximum = 1;  ///< what solvers stay within; evaluation takes any value
  double rest = 0;                  ///< value when nothing is animated
  std::vector<SliderStop> stops;    ///< ascending by `at`
  bool operator==(const Slider&) const = default;
};

/// How the inputs of a corrective combine. Each input counts as u = slider value / at, and as 0 below 0.
enum class CorrectiveRule {
  product,   ///< the product of all u
  smallest,  ///< the least u
  smooth,  ///< between the two and smooth: m c(u / m) with m = max(1, all u), c(v) = (sum v^-2 - n + 1)^-1/2
};

struct CorrectiveInput {
  int slider = 0;  ///< index into Character::sliders
  double at = 1;   ///< the slider value that counts as full, not 0; negative: the corrective fires below 0
  bool operator==(const CorrectiveInput&) const = default;
};

/// A shape that fires by itself when all of its inputs are up: it repairs what their sum gets wrong.
struct Corrective {
  int shape = 0;  ///< index into Character::shapes
  CorrectiveRule rule = CorrectiveRule::product;
  std::vector<CorrectiveInput> inputs;  ///< each slider once
  bool operator==(const Corrective&) const = default;
};

/// A slider's value in an expression.
struct ExpressionValue {
  int slider = 0;  ///< index into Character::sliders
  double value = 0;
  bool operator==(const ExpressionValue&) const = default;
};

/// A saved pose of some or all sliders; a viseme names those of the mouth alone and leaves the rest.
struct Expression {
  std::string name;
  std::vector<ExpressionValue> values;  ///< ascending by slider
  bool operator==(const Expression&) const = default;
};

}  // namespace mien
