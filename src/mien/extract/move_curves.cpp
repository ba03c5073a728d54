// Pyun, Shin and Shin leave the best position of a reference curve to future work. A curve's position is not linear, and its handle has to stay
// where a designer looks for it, so a few motions of the whole curve are tried, small ones, instead of one for each of its points.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/bind_wires.h"
#include "mien/extract/detail/draw_wire.h"
#include "mien/extract/detail/wire_trial.h"
#include "mien/extract/improve_wires.h"

namespace mien {
namespace {

constexpr double first_step = 0.15;  ///< of the wire's range; half of it in the next sweep, and so on

/// How a curve may move: each point across the curve or along it, by a factor that depends on its place s on the curve, 0 to 1.
enum class Motion { across, tilt, bend, along, lengthen };
constexpr std::array motions{Motion::across, Motion::tilt, Motion::bend, Motion::along, Motion::lengthen};

bool is_along(Motion motion) {
  return motion == Motion::along || motion == Motion::lengthen;
}

double factor_at(Motion motion, double s) {
  switch (motion) {
    case Motion::tilt:
    case Motion::lengthen:
      return 2 * s - 1;
    case Motion::bend:
      return 1 - (2 * s - 1) * (2 * s - 1);
    default:
      return 1;
  }
}

/// A wire's points with the directions along the curve and across it, in the surface.
struct Frame {
  Frame(const WireBinder& binder, const Wire& wire) {
    const std::size_t count = wire.points.size();
    std::vector<WireBinder::Stand> stands;
    for (const SurfacePoint& point : wire.points) stands.push_back(binder.stand(point));
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d chord =
          stands[std::min(i + 1, count - 1)].position - stands[i > 0 ? i - 1 : 0].position;
      const Eigen::Vector3d flat = chord - chord.dot(stands[i].normal) * stands[i].normal;
      along.push_back(flat.norm() > 0 ? Eigen::Vector3d(flat.normalized()) : flat);
      across.push_back(stands[i].normal.cross(along.back()));
      centre += stands[i].position / static_cast<double>(count);
    }
  }
  std::vector<Eigen::Vector3d> along, across;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : vectors) sum += v;
  return sum / static_cast<double>(vectors.size());
}

/// 1 or -1: what `second` has to do for the same motion of `first`, as its mirror image.
double mirrored_sign(Motion motion, const Frame& first, const Frame& second) {
  const Eigen::Vector3d between = second.centre - first.centre;
  const double length = between.squaredNorm();
  const auto agrees = [&](const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
    const Eigen::Vector3d v = mean(a);
    const Eigen::Vector3d image = length > 0 ? Eigen::Vector3d(v - 2 * v.dot(between) / length * between) : v;
    return image.dot(mean(b)) < 0 ? -1.0 : 1.0;
  };
  const double order = agrees(first.along, second.along);  // -1: drawn the other way round
  const double sign = is_along(motion) ? order : agrees(first.across, second.across);
  return motion == Motion::tilt || motion == Motion::lengthen ? sign * order : sign;
}

class CurveSearch {
 public:
  CurveSearch(const Character& character, std::span<const Wire> wires, const ImproveOptions& options)
      : binder_(character),
        options_(options),
        trial_(character, wires, options.solver, options.alike),
        wires_(wires.begin(), wires.end()),
        groups_(detail::twin_groups(wires_)) {
    for (std::size_t w = 0; w < wires_.size(); ++w)
      wires_[w].bindings = bindings_of(wires_[w], trial_.distances(w));
    best_ = trial_.left_over(wires_);
  }

  double best() const { return best_; }
  std::size_t groups() const { return groups_.size(); }
  std::vector<Wire> take() { return std::move(wires_); }

  void try_motion(std::size_t group, Motion motion, double step) {
    for (const std::size_t w : groups_[group])
      if (wires_[w].points.empty() ||
          std::find(options_.fixed.begin(), options_.fixed.end(), wires_[w].name) != options_.fixed.end())
        return;
    std::array<double, 2> left{};
    std::array<std::vector<Wire>, 2> candidates{wires_, wires_};
    parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t side = begin; side < end; ++side)
        left[side] = move(group, motion, side == 0 ? step : -step, candidates[side])
                         ? trial_.left_over(candidates[side])
                         : std::numeric_limits<double>::infinity();
    });
    const std::size_t side = left[1] < left[0];
    if (!(left[side] < best_ * (1 - 1e-4))) return;
    best_ = left[side];
    wires_ = std::move(candidates[side]);
  }

 private:
  /// False: the curve cannot be drawn there.
  bool move(std::size_t group, Motion motion, double step, std::vector<Wire>& wires) const {
    const Frame first(binder_, wires[groups_[group].front()]);
    try {
      for (const std::size_t w : groups_[group]) {
        const Frame frame(binder_, wires[w]);
        const double sign = w == groups_[group].front() ? 1 : mirrored_sign(motion, first, frame);
        wires[w] = moved(wires[w], frame, motion, sign * step);
      }
    } catch (const Error&) {
      return false;
    }
    return true;
  }

  Wire moved(const Wire& wire, const Frame& frame, Motion motion, double step) const {
    const double length = step * *std::max_element(wire.ranges.begin(), wire.ranges.end());
    WireSketch sketch;
    sketch.name = wire.name;
    sketch.controls = wire.curve.control_count();
    for (std::size_t i = 0; i < wire.points.size(); ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(wire.points.size() - 1);
      const Eigen::Vector3d& direction = is_along(motion) ? frame.along[i] : frame.across[i];
      sketch.points.push_back(binder_.moved(wire.points[i], length * factor_at(motion, s) * direction));
    }
    Wire result = wire;
    result.curve = detail::draw_curve(binder_, sketch).curve;
    result.points = sketch.points;
    result.bindings = bindings_of(result, trial_.measure(binder_, result));
    return result;
  }

  WireBinder binder_;
  const ImproveOptions& options_;
  detail::WireTrial trial_;
  std::vector<Wire> wires_;
  std::vector<std::vector<std::size_t>> groups_;
  double best_ = 0;
};

}  // namespace

ImproveResult move_curves(const Character& character, std::span<const Wire> wires,
                          const ImproveOptions& options) {
  if (wires.empty()) throw invalid_input("wires", "are none", "one or more");
  CurveSearch search(character, wires, options);
  ImproveResult result;
  result.before = search.best();
  double step = first_step;
  for (int sweep = 0; sweep < options.sweeps; ++sweep, step /= 2)
    for (std::size_t group = 0; group < search.groups(); ++group) {
      report_progress(options.progress, "places",
                      (sweep + static_cast<double>(group) / static_cast<double>(search.groups())) /
                          std::max(1, options.sweeps));
      for (const Motion motion : motions) search.try_motion(group, motion, step);
    }
  result.after = search.best();
  result.wires = bind_wires(character, search.take());
  return result;
}

}  // namespace mien
