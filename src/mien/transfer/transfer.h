#pragma once
/// Rig transfer: the rig of one face on another face of any topology, proportions, pose and size.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mien/character/character.h"
#include "mien/core/progress.h"
#include "mien/transfer/contact.h"
#include "mien/transfer/delta_models.h"
#include "mien/transfer/landmark_pairs.h"

namespace mien {

enum class TransferMethod {
  registration,  ///< non-rigid registration, gated attributes, chosen delta model
  thesis,        ///< the thesis's pipeline to the letter (4.7): the baseline that reports compare with
};

/// What says which place of the source a place of the target is.
enum class Correspondence {
  automatic,   ///< shared UVs where there are any, else the surfaces
  shared_uvs,  ///< the UV layout that both have (shared_uvs.h)
  surfaces,    ///< non-rigid registration (register_surfaces.h)
};
std::string_view name_of(Correspondence correspondence);

struct TransferOptions {
  TransferMethod method = TransferMethod::registration;
  Correspondence correspondence = Correspondence::automatic;  ///< of the method `registration`
  DeltaModel deltas = DeltaModel::automatic;
  double exaggeration = 1;                           ///< all shapes' displacements times this (thesis 5.4.2)
  std::map<std::string, double> shape_exaggeration;  ///< by name, times the one above
  /// Landmarks and curves that were found (find_landmarks.h), not given: the registration starts from them and then
  /// goes where the surfaces say.
  std::vector<std::string> found_landmarks;
  bool landmarks_hold = true;  ///< RegistrationOptions::landmarks_hold
  int max_influences = 0;      ///< skin weights a vertex; 0: as many as the source needs
  bool close_lids = true;      ///< let shapes that close a lid on the source close it on the target
  bool replace_uvs = false;    ///< take the source's UVs even where the target has its own
  Progress progress;
};

struct StepTime {
  std::string step;
  double seconds = 0;
};

struct TransferWarning {
  std::string what, remedy;
};

/// How a piece that is not skin was handled.
struct PieceReport {
  std::string piece, kind, way;
};

struct TransferReport {
  LandmarkPairs pairs;
  Similarity similarity;                                     ///< source to target by the landmarks
  double unit = 1;                                           ///< the face's size in target units
  Correspondence correspondence = Correspondence::surfaces;  ///< what it came to
  std::vector<Points>
      guide;  ///< per source part, #V: where its vertices come to lie on the target, model space
  std::vector<Eigen::VectorXf>
      distance;  ///< per target part, #V: guide to target, of the face's size; 0 off the skin
  std::vector<Eigen::VectorXf>
      filled;                     ///< per target part, #V: 1 where attributes were filled in from around
  std::vector<int> flips;         ///< per shape: triangles of the target's skin that turn over at full weight
  std::vector<int> source_flips;  ///< per shape: the same on the source's skin
  DeltaDecision deltas;
  std::vector<PieceReport> pieces;
  std::vector<StepTime> steps;
  std::vector<TransferWarning> warnings;
};

struct TransferResult {
  Character character;  ///< the target with the source's rig
  TransferReport report;
};

/// Puts the source's shapes, joints, skin weights, UVs (where the target has none) and clips on the target. The target's
/// vertices keep their place and their order; a rig that it had is replaced.
///   source  landmarks inside; shapes, joints or both
///   target  landmarks inside
///   throws  invalid_input: nothing to transfer; landmarks that cannot carry a warp (names them); an exaggerated shape
///           that the source does not have; no skin under the landmarks; shared UVs asked for and not there
///   method  thesis chapter 4 with correspondence by shared UVs or non-rigid registration, displacements by
///           delta_models.h and contact.h, joints by a moving similarity, skin weights along the correspondence
///   cost    1.7 s for 27,000 vertices and 57 shapes on one core, .6 s with shared UVs; memory
///           about 40 bytes x vertices x shapes
/// Same input, same bytes, at any thread count, also when several run side by side.
TransferResult transfer(const Character& source, const Character& target,
                        const TransferOptions& options = {});

}  // namespace mien
