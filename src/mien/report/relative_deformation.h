#pragma once
/// How a distance on a face changes in a clip, without units, so that faces of any size can be compared (thesis 5.3.1,
/// figure 5.3).

#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// epsilon(t) = (l1(t) - l0) / l0 with l0 the distance at rest.
///   rest     l0 > 0
///   lengths  l1, one a moment
///   throws   invalid_input: a length at rest that is not positive and finite
std::vector<double> relative_deformation(double rest, const std::vector<double>& lengths);

/// How closely one curve follows another.
struct CurveAgreement {
  double correlation = 1;     ///< Pearson's; two constant curves: 1; a constant one and another: 0
  double rms_difference = 0;  ///< root of the mean squared difference
  double gain = 1;  ///< the factor that brings the reference closest to the curve; 1 when the reference is 0
};

///   throws  invalid_input: curves that differ in number or have no values
CurveAgreement compare_curves(const std::vector<double>& reference, const std::vector<double>& curve);

/// Points of a face through a clip, model space.
struct PointTracks {
  PointsD rest;                 ///< #P x 3
  std::vector<PointsD> frames;  ///< one #P x 3 a moment
};

/// `rate` moments a second from 0 to the clip's end, ends included; fewer, evenly, where that would be more than `most`.
///   throws  invalid_input: a rate that is not positive, most below 2
std::vector<double> sample_times(const Clip& clip, double rate = 30, int most = 600);

/// Where nodes are through a clip of the character. Cost: a pose a moment.
///   throws  invalid_input: a node out of range; a clip that `sample_clip` refuses
PointTracks track_nodes(const Character& character, const Clip& clip, const std::vector<double>& seconds,
                        const std::vector<int>& nodes);

/// A control point of an influence object.
struct ControlPoint {
  int object = 0, control = 0;
};

/// The same for control points of influence objects, where the nodes that carry them take them. Cost: a pose a moment.
///   throws  invalid_input: an object or control point out of range; a clip that `sample_clip` refuses
PointTracks track_controls(const Character& character, const Clip& clip, const std::vector<double>& seconds,
                           const std::vector<ControlPoint>& points);

/// The same for points on the surface, after shapes, objects and skinning. Cost: these points' evaluation a moment.
PointTracks track_surface(const Character& character, const Clip& clip, const std::vector<double>& seconds,
                          const std::vector<SurfacePoint>& points);

/// Two tracked points.
struct PointPair {
  int a = 0, b = 0;
};

/// epsilon of one pair through the clip.
///   throws  invalid_input: two points at one place at rest
std::vector<double> relative_deformation(const PointTracks& tracks, PointPair pair);

/// Pairs whose distance says most about the clip: greedily the largest range of epsilon, no point twice, no curve that
/// one before already tells (correlation 0.98).
///   least_length  shorter distances at rest are left out: their epsilon says nothing
///   returns       at most `count`; none when nothing moves
///   cost          #P^2 x moments
std::vector<PointPair> telling_pairs(const PointTracks& tracks, double least_length, int count);

/// The clip with its values unchanged on another character's nodes, shapes, sliders, wires and objects of the same names: what copying an
/// animation without transferring it gives. Channels without a counterpart are left out.
Clip copy_by_name(const Character& from, const Clip& clip, const Character& to);

}  // namespace mien
