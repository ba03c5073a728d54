#include "mien/report/detail/measure_clips.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "mien/report/detail/at.h"

namespace mien::detail {
namespace {

constexpr std::size_t most_clips = 6;
constexpr std::size_t curves_a_kind = 4;
/// Pairs looked at: some of the source's telling pairs lie too close on the target.
constexpr int candidates = 12;
/// Of the face's size: epsilon of closer points (lips that touch) is large and says little.
constexpr double least_joint_length = 0.05, least_control_length = 0.05, least_landmark_length = 0.08;
/// A smaller difference between a copied and a transferred clip is rounding.
constexpr double same_curve = 1e-4;

/// A point that is followed on both characters.
struct Followed {
  std::vector<std::string> names;
  PointTracks source, target, copied;
};

double length_at_rest(const PointTracks& tracks, PointPair pair) {
  return (tracks.rest.row(pair.a) - tracks.rest.row(pair.b)).norm();
}

/// `unit` and `target_unit`: the face's size on both sides.
std::vector<CurveRow> curves_of(const Followed& followed, double least_length, double unit,
                                double target_unit) {
  std::vector<CurveRow> rows;
  for (const PointPair& pair : telling_pairs(followed.source, least_length * unit, candidates)) {
    if (rows.size() == curves_a_kind) break;
    if (length_at_rest(followed.target, pair) < 0.8 * least_length * target_unit) continue;
    CurveRow row;
    row.name = followed.names[at(pair.a)] + " \u2013 " + followed.names[at(pair.b)];
    row.source = relative_deformation(followed.source, pair);
    row.target = relative_deformation(followed.target, pair);
    row.copied = relative_deformation(followed.copied, pair);
    row.target_agreement = compare_curves(row.source, row.target);
    row.copied_agreement = compare_curves(row.source, row.copied);
    if (compare_curves(row.target, row.copied).rms_difference < same_curve) row.copied.clear();
    rows.push_back(std::move(row));
  }
  return rows;
}

struct Clips {
  const Clip &source, &target, &copied;
  const std::vector<double>& seconds;
};

Followed follow_joints(const ReportInput& input, const Clips& clips) {
  const Character &source = input.source, &target = input.result.character;
  std::map<std::string, int> target_joint;
  for (const Skin& skin : target.skins)
    for (const int node : skin.joints) target_joint.emplace(target.nodes[at(node)].name, node);
  Followed followed;
  std::vector<int> from, to;
  for (const Skin& skin : source.skins)
    for (const int node : skin.joints) {
      const auto found = target_joint.find(source.nodes[at(node)].name);
      if (found == target_joint.end() || std::find(from.begin(), from.end(), node) != from.end()) continue;
      followed.names.push_back(found->first);
      from.push_back(node);
      to.push_back(found->second);
    }
  followed.source = track_nodes(source, clips.source, clips.seconds, from);
  followed.target = track_nodes(target, clips.target, clips.seconds, to);
  followed.copied = track_nodes(target, clips.copied, clips.seconds, to);
  return followed;
}

/// Control points of the objects that both have.
Followed follow_objects(const ReportInput& input, const Clips& clips) {
  const Character &source = input.source, &target = input.result.character;
  Followed followed;
  std::vector<ControlPoint> from, to;
  for (std::size_t o = 0; o < source.objects.size(); ++o) {
    const InfluenceObject& object = source.objects[o];
    const int same = find_object(target, object.name);
    if (same < 0 || target.objects[at(same)].controls.rows() != object.controls.rows()) continue;
    for (int c = 0; c < static_cast<int>(object.controls.rows()); ++c) {
      std::string name = object.name;
      if (object.controls.rows() > 1) name.append(" ").append(std::to_string(c));
      followed.names.push_back(std::move(name));
      from.push_back({static_cast<int>(o), c});
      to.push_back({same, c});
    }
  }
  followed.source = track_controls(source, clips.source, clips.seconds, from);
  followed.target = track_controls(target, clips.target, clips.seconds, to);
  followed.copied = track_controls(target, clips.copied, clips.seconds, to);
  return followed;
}

Followed follow_landmarks(const ReportInput& input, const Clips& clips) {
  const LandmarkPairs& pairs = input.result.report.pairs;
  Followed followed;
  std::vector<SurfacePoint> from, to;
  for (std::size_t i = 0; i < pairs.names.size(); ++i) {
    followed.names.push_back(pairs.names[i]);
    from.push_back(pairs.source[i].at);
    to.push_back(pairs.target[i].at);
  }
  followed.source = track_surface(input.source, clips.source, clips.seconds, from);
  followed.target = track_surface(input.result.character, clips.target, clips.seconds, to);
  followed.copied = track_surface(input.result.character, clips.copied, clips.seconds, to);
  return followed;
}

}  // namespace

std::vector<ClipRows> measure_clips(const ReportInput& input) {
  std::vector<ClipRows> rows;
  const std::vector<Clip>&clips = input.source.clips, &carried = input.result.character.clips;
  const double target_unit = input.result.report.unit,
               unit = target_unit / input.result.report.similarity.scale;
  for (std::size_t c = 0; c < std::min({clips.size(), carried.size(), most_clips}); ++c) {
    const Clip copied = copy_by_name(input.source, clips[c], input.result.character);
    ClipRows clip{clips[c].name, sample_times(clips[c]), {}, {}, {}};
    if (clip.seconds.size() < 2) continue;
    const Clips three{clips[c], carried[c], copied, clip.seconds};
    if (!input.source.skins.empty() && !input.result.character.skins.empty())
      clip.joints = curves_of(follow_joints(input, three), least_joint_length, unit, target_unit);
    clip.objects = curves_of(follow_objects(input, three), least_control_length, unit, target_unit);
    clip.surface = curves_of(follow_landmarks(input, three), least_landmark_length, unit, target_unit);
    rows.push_back(std::move(clip));
  }
  return rows;
}

}  // namespace mien::detail
