#pragma once
/// Landmarks on a head that has few or none, after those of another head.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/core/progress.h"

namespace mien {

enum class Verdict {
  accept,  ///< the face is found
  check,   ///< probably found: look at the picture
  refuse,  ///< no face, or not one that the points can be trusted on
};
std::string_view name_of(Verdict verdict);

struct FindLandmarksOptions {
  /// Points that are known, by the names of the head to be like; others are handed through. They are corrections: they
  /// stay where they are, what lies around them and its mirror image follows.
  std::vector<Landmark> given;
  /// Turns the head to be like so that it looks along +Z with +Y up.
  Eigen::Matrix3d like_facing = Eigen::Matrix3d::Identity();
  /// Trust in the arrangement of the placed head's landmarks while it is registered, of a given point's. Little makes them
  /// pairs that a registration of the same two heads starts best from; more keeps each where people mark it. Heads that
  /// are alike need no such choice.
  double arrangement_trust = 0.05;
  Progress progress;
};

struct FoundLandmark {
  Landmark landmark;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< model space
  double confidence = 0;                               ///< in [0, 1]; 1 for given points
  bool given = false;
};

/// A given point that the others and the surface contradict.
struct DoubtfulPoint {
  std::string name;
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();  ///< where the others put it, model space
  double distance = 0;                                 ///< from there, of the face's size
  std::string looks_like;  ///< the landmark that is expected where the point is, empty: none
};

struct FoundLandmarks {
  std::vector<FoundLandmark>
      landmarks;  ///< in the order of the head to be like, then given ones of other names
  std::vector<LandmarkCurve> curves;
  Verdict verdict = Verdict::refuse;
  double score = 0;     ///< how badly the head to be like fits, of the face's size: 0 is a twin
  double likeness = 0;  ///< correlation of what stands out on the two faces, 1 for a twin, 0 for an egg
  bool alike =
      false;  ///< so alike that closest points alone tell what is where: the same model's other identity
  double stretch = 0;  ///< how much it had to be bent, rms log ratio of lengths on the face
  std::string reason;  ///< of the verdict, one sentence
  std::vector<DoubtfulPoint> doubtful;
  Eigen::Matrix3d facing = Eigen::Matrix3d::Identity();  ///< turns the target to look along +Z with +Y up
  double unit = 1;                                       ///< the face's size in the target's units
  /// The landmarks alone, as a character holds them.
  std::vector<Landmark> points() const;
};

/// Finds on `target` the landmarks and curves that `like` has: the head `like` is placed on the target by robust closest
/// points from many starts (place: similarity, then how much wider, longer and deeper), registered onto it without folds
/// (register_surfaces.h) and its landmarks are read off. Any unit and orientation; inner parts (eyes, teeth) do no harm.
///   like     a head with 4 or more landmarks on its skin
///   throws   invalid_input: no faces; too few landmarks on `like`; a given name twice, a given point off the target
///   cost     about 5 s for 14,000 vertices on either side, one core
FoundLandmarks find_landmarks(const Character& target, const Character& like,
                              const FindLandmarksOptions& options = {});

}  // namespace mien
