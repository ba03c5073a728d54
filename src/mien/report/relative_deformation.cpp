#include "mien/report/relative_deformation.h"

#include <algorithm>
#include <cmath>

#include "mien/character/pose.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/influence.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/point_evaluator.h"

namespace mien {
namespace {

/// A smaller range of epsilon is rounding.
constexpr double least_range = 1e-4;
/// Two curves that agree this well tell the same.
constexpr double same_story = 0.98;

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

double length_at_rest(const PointTracks& tracks, PointPair pair) {
  return (tracks.rest.row(pair.a) - tracks.rest.row(pair.b)).norm();
}

struct Candidate {
  PointPair pair;
  double range = 0;
};

/// All pairs that move, the most telling first; ties keep the order of the points.
std::vector<Candidate> ranked_pairs(const PointTracks& tracks, double least_length) {
  const int count = static_cast<int>(tracks.rest.rows());
  std::vector<std::vector<Candidate>> rows(static_cast<std::size_t>(count));
  parallel_for(rows.size(), 1, [&](std::size_t begin, std::size_t) {
    const int a = static_cast<int>(begin);
    for (int b = a + 1; b < count; ++b) {
      const double length = length_at_rest(tracks, {a, b});
      if (!(length >= least_length) || length <= 0) continue;
      const double range = range_of(relative_deformation(tracks, {a, b}));
      if (range > least_range) rows[begin].push_back({{a, b}, range});
    }
  });
  std::vector<Candidate> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& x, const Candidate& y) { return x.range > y.range; });
  return all;
}

/// `places`: a pose's points.
template <class Places>
PointTracks tracks_of(const Character& character, const Clip& clip, const std::vector<double>& seconds,
                      const Places& places) {
  PointTracks tracks{places(rest_pose(character)), std::vector<PointsD>(seconds.size())};
  parallel_for(seconds.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      tracks.frames[k] = places(sample_clip(character, clip, seconds[k]));
  });
  return tracks;
}

int node_named(const Character& character, const std::string& name) {
  for (const Skin& skin : character.skins)
    for (const int node : skin.joints)
      if (character.nodes[static_cast<std::size_t>(node)].name == name) return node;
  return find_node(character, name);
}

}  // namespace

std::vector<double> relative_deformation(double rest, const std::vector<double>& lengths) {
  if (!std::isfinite(rest) || rest <= 0)
    throw invalid_input("relative deformation", "has a length at rest of " + std::to_string(rest),
                        "two points apart");
  std::vector<double> epsilon(lengths.size());
  std::transform(lengths.begin(), lengths.end(), epsilon.begin(),
                 [&](double l) { return (l - rest) / rest; });
  return epsilon;
}

CurveAgreement compare_curves(const std::vector<double>& reference, const std::vector<double>& curve) {
  if (reference.empty() || reference.size() != curve.size())
    throw invalid_input(
        "curves",
        "have " + std::to_string(reference.size()) + " and " + std::to_string(curve.size()) + " values",
        "as many of both, at least one");
  const double mean_r = mean_of(reference), mean_c = mean_of(curve);
  double rr = 0, cc = 0, rc = 0, squared = 0, r2 = 0, r_c = 0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double r = reference[i] - mean_r, c = curve[i] - mean_c;
    rr += r * r;
    cc += c * c;
    rc += r * c;
    squared += (reference[i] - curve[i]) * (reference[i] - curve[i]);
    r2 += reference[i] * reference[i];
    r_c += reference[i] * curve[i];
  }
  CurveAgreement agreement;
  const bool still_r = rr < 1e-18 * std::max(1.0, r2), still_c = cc < 1e-18 * std::max(1.0, r2);
  agreement.correlation = still_r || still_c ? (still_r && still_c ? 1 : 0) : rc / std::sqrt(rr * cc);
  agreement.rms_difference = std::sqrt(squared / static_cast<double>(curve.size()));
  agreement.gain = r2 > 0 ? r_c / r2 : 1;
  return agreement;
}

std::vector<double> sample_times(const Clip& clip, double rate, int most) {
  if (!(rate > 0) || !std::isfinite(rate)) throw invalid_input("rate", "is not positive", "moments a second");
  if (most < 2) throw invalid_input("most", "is " + std::to_string(most), "at least 2 moments");
  const double duration = clip.duration();
  if (!(duration > 0)) return {0};
  const int wanted = static_cast<int>(std::min(std::ceil(duration * rate - 1e-6), 1e6)) + 1;
  const int count = std::clamp(wanted, 2, most);
  std::vector<double> seconds(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k)
    seconds[static_cast<std::size_t>(k)] =
        wanted <= most ? std::min(k / rate, duration) : duration * k / (count - 1);
  return seconds;
}

PointTracks track_nodes(const Character& character, const Clip& clip, const std::vector<double>& seconds,
                        const std::vector<int>& nodes) {
  for (const int node : nodes)
    if (node < 0 || node >= static_cast<int>(character.nodes.size()))
      throw invalid_input("node " + std::to_string(node), "does not exist",
                          "one of " + std::to_string(character.nodes.size()));
  const auto places = [&](const Pose& pose) {
    const std::vector<Eigen::Matrix4d> model = posed_matrices(character, pose);
    PointsD points(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      points.row(static_cast<Eigen::Index>(n)) =
          model[static_cast<std::size_t>(nodes[n])].topRightCorner<3, 1>().transpose();
    return points;
  };
  return tracks_of(character, clip, seconds, places);
}

PointTracks track_controls(const Character& character, const Clip& clip, const std::vector<double>& seconds,
                           const std::vector<ControlPoint>& points) {
  for (const ControlPoint& point : points)
    if (point.object < 0 || point.object >= static_cast<int>(character.objects.size()) || point.control < 0 ||
        point.control >= character.objects[static_cast<std::size_t>(point.object)].controls.rows())
      throw invalid_input(
          "control point " + std::to_string(point.control) + " of object " + std::to_string(point.object),
          "does not exist", "one of the character's");
  const InfluenceField field(character, posed_matrices(character, rest_pose(character)));
  const auto places = [&](const Pose& pose) {
    const std::vector<Eigen::Matrix4d> model = posed_matrices(character, pose);
    const std::vector<ObjectPose> objects = field.pose(model, pose.shape_weights, pose.objects);
    std::vector<PointsD> controls;
    for (int o = 0; o < field.object_count(); ++o)
      controls.push_back(field.place(o, objects[static_cast<std::size_t>(o)], model));
    PointsD found(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
      found.row(static_cast<Eigen::Index>(i)) =
          controls[static_cast<std::size_t>(points[i].object)].row(points[i].control);
    return found;
  };
  return tracks_of(character, clip, seconds, places);
}

PointTracks track_surface(const Character& character, const Clip& clip, const std::vector<double>& seconds,
                          const std::vector<SurfacePoint>& points) {
  PointEvaluator evaluator(character, points);
  PointTracks tracks;
  evaluator.positions(rest_pose(character), tracks.rest);
  for (const double second : seconds)
    evaluator.positions(sample_clip(character, clip, second), tracks.frames.emplace_back());
  return tracks;
}

std::vector<double> relative_deformation(const PointTracks& tracks, PointPair pair) {
  std::vector<double> lengths;
  lengths.reserve(tracks.frames.size());
  for (const PointsD& frame : tracks.frames)
    lengths.push_back((frame.row(pair.a) - frame.row(pair.b)).norm());
  return relative_deformation(length_at_rest(tracks, pair), lengths);
}

std::vector<PointPair> telling_pairs(const PointTracks& tracks, double least_length, int count) {
  std::vector<PointPair> chosen;
  std::vector<std::vector<double>> told;
  if (tracks.frames.empty()) return chosen;
  for (const Candidate& candidate : ranked_pairs(tracks, least_length)) {
    if (static_cast<int>(chosen.size()) >= count) break;
    const auto shares_a_point = [&](const PointPair& other) {
      return other.a == candidate.pair.a || other.a == candidate.pair.b || other.b == candidate.pair.a ||
             other.b == candidate.pair.b;
    };
    if (std::any_of(chosen.begin(), chosen.end(), shares_a_point)) continue;
    std::vector<double> curve = relative_deformation(tracks, candidate.pair);
    const auto tells_the_same = [&](const std::vector<double>& other) {
      return std::abs(compare_curves(other, curve).correlation) > same_story;
    };
    if (std::any_of(told.begin(), told.end(), tells_the_same)) continue;
    chosen.push_back(candidate.pair);
    told.push_back(std::move(curve));
  }
  return chosen;
}

Clip copy_by_name(const Character& from, const Clip& clip, const Character& to) {
  Clip copy{clip.name, {}, clip.carried};
  for (Channel channel : clip.channels) {
    if (channel.moves_wire()) {
      channel.wire = find_wire(to, from.wires[static_cast<std::size_t>(channel.wire)].name);
      if (channel.wire >= 0) copy.channels.push_back(std::move(channel));
    } else if (channel.property == Channel::Property::shape_weight) {
      channel.shape = find_shape(to, from.shapes[static_cast<std::size_t>(channel.shape)].name);
      channel.part = -1;
      if (channel.shape >= 0) copy.channels.push_back(std::move(channel));
    } else if (channel.property == Channel::Property::slider) {
      channel.slider = find_slider(to, from.sliders[static_cast<std::size_t>(channel.slider)].name);
      if (channel.slider >= 0) copy.channels.push_back(std::move(channel));
    } else if (channel.property == Channel::Property::object_control) {
      channel.object = find_object(to, from.objects[static_cast<std::size_t>(channel.object)].name);
      if (channel.object >= 0 &&
          channel.control < to.objects[static_cast<std::size_t>(channel.object)].controls.rows())
        copy.channels.push_back(std::move(channel));
    } else {
      channel.node = node_named(to, from.nodes[static_cast<std::size_t>(channel.node)].name);
      if (channel.node >= 0) copy.channels.push_back(std::move(channel));
    }
  }
  return copy;
}

}  // namespace mien
