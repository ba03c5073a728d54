#include "load_face.h"

#include <algorithm>

#include "find_landmarks.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/sample/sample.h"
#include "mien/transfer/carry_landmarks.h"

namespace mien::cli {
namespace {

std::size_t marks(const Character& character) {
  return character.landmarks.size() + character.curves.size();
}

std::size_t shared_marks(const Character& a, const Character& b) {
  const auto count = [](const auto& left, const auto& right) {
    return std::count_if(left.begin(), left.end(), [&](const auto& one) {
      return std::any_of(right.begin(), right.end(),
                         [&](const auto& other) { return other.name == one.name; });
    });
  };
  return static_cast<std::size_t>(count(a.landmarks, b.landmarks) + count(a.curves, b.curves));
}

/// With fewer pairs than this the others are found; with as many, what the user gave is all there is.
constexpr std::size_t enough_pairs = 12;

/// FindLandmarksOptions::arrangement_trust of a target that is marked after its source.
constexpr double pair_trust = 0.003;

/// Gives `character` the landmarks of `like` in place of what is missing; its own stay.
void complete(const Side& side, const Character& like, FindLandmarksOptions options,
              std::vector<FoundSide>& sides) {
  Character& character = side.face;
  options.given = character.landmarks;
  FoundLandmarks found = find_landmarks_of(side.file, character, like, options);
  character.landmarks = found.points();
  for (const LandmarkCurve& curve : found.curves)
    if (std::none_of(character.curves.begin(), character.curves.end(),
                     [&](const LandmarkCurve& own) { return own.name == curve.name; }))
      character.curves.push_back(curve);
  sides.push_back({side.file, std::move(found)});
}

/// Where it is known which place of the one is which of the other, landmarks need no finding; those that `to` has stay.
bool take_landmarks(const Character& from, Character& to, bool by_uvs) {
  std::optional<CarriedLandmarks> carried = carry_landmarks(from, to, by_uvs);
  if (!carried) return false;
  const auto add = [](auto& own, auto& others) {
    for (auto& other : others)
      if (std::none_of(own.begin(), own.end(), [&](const auto& one) { return one.name == other.name; }))
        own.push_back(std::move(other));
  };
  add(to.landmarks, carried->landmarks);
  add(to.curves, carried->curves);
  return true;
}

}  // namespace

Character load_face(const std::string& path, const std::string& landmarks) {
  Character character = load(path);
  if (!landmarks.empty()) {
    LandmarkSet set = read_landmarks(landmarks, character);
    character.landmarks = std::move(set.landmarks);
    character.curves = std::move(set.curves);
  }
  return character;
}

std::vector<FoundSide> find_missing(const Side& source, const Side& target, TransferOptions& transfer) {
  std::vector<FoundSide> sides;
  if (shared_marks(source.face, target.face) >= enough_pairs) return sides;
  FindLandmarksOptions options;
  options.progress = transfer.progress;
  const bool by_uvs = transfer.correspondence != Correspondence::surfaces;
  if (marks(source.face) < enough_pairs && marks(target.face) >= enough_pairs) {
    options.arrangement_trust = pair_trust;
    if (!take_landmarks(target.face, source.face, by_uvs)) complete(source, target.face, options, sides);
  } else {
    if (marks(source.face) < enough_pairs) {
      complete(source, make_sample("human"), options, sides);
      options.like_facing = sides[0].found.facing;
    }
    if (take_landmarks(source.face, target.face, by_uvs)) return sides;
    options.arrangement_trust = pair_trust;
    complete(target, source.face, options, sides);
  }
  if (sides.empty()) return sides;
  const FoundLandmarks& found = sides.back().found;
  for (const FoundLandmark& one : found.landmarks)
    if (!one.given) transfer.found_landmarks.push_back(one.landmark.name);
  for (const LandmarkCurve& curve : found.curves) transfer.found_landmarks.push_back(curve.name);
  transfer.landmarks_hold = found.alike;
  return sides;
}

}  // namespace mien::cli
