#pragma once
/// `shape_weights` and its derivative compiled for many calls: sparse, without allocation.

#include <Eigen/Core>
#include <vector>

#include "mien/character/character.h"

namespace mien::detail {

class SliderMap {
 public:
  /// d(weight of `shape`) / d(slider)
  struct Slope {
    int shape, slider;
    double value;
  };

  /// The character's sliders and correctives must be valid.
  explicit SliderMap(const Character& character);

  int slider_count() const { return static_cast<int>(first_stop_.size()) - 1; }
  int shape_count() const { return shapes_; }
  /// Whether shape weights are a linear function of the sliders wherever these are.
  bool linear() const { return linear_; }

  /// As `shape_weights`; `weights` (#S) is overwritten.
  void weights(const Eigen::VectorXd& sliders, Eigen::VectorXd& weights);
  /// As `shape_weight_slopes`, its entries alone; valid until the next call.
  const std::vector<Slope>& slopes(const Eigen::VectorXd& sliders);

 private:
  struct Stop {
    double at;
    int shape;  // -1: the neutral
  };
  struct Input {
    int slider;
    double at;
  };
  struct Combination {
    int shape, first, last;  // of inputs_
    CorrectiveRule rule;
  };
  int piece_of(int slider, double value) const;
  double fire(const Combination& combination, const Eigen::VectorXd& sliders);

  int shapes_ = 0;
  bool linear_ = true;
  std::vector<int> first_stop_;
  std::vector<Stop> stops_;  // each slider's, the neutral among them
  std::vector<Input> inputs_;
  std::vector<Combination> combinations_;
  std::vector<Slope> slopes_;
  std::vector<double> u_, fired_;
};

}  // namespace mien::detail
