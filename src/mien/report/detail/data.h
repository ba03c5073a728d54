#pragma once
/// The numbers of a report: measured once, then written as JSON and as a page.

#include <optional>
#include <string>
#include <vector>

#include "mien/report/relative_deformation.h"
#include "mien/report/report.h"

namespace mien::detail {

struct ShapeRow {
  std::string name;
  int flips = 0, source_flips = 0;
  double stretch = 1, source_stretch = 1;  ///< worst edge, times its length at rest
  double moved = 0;                        ///< rms displacement on the target, of the face's size
  // against the thesis's method, when it was made
  double difference = 0;                  ///< rms difference relative to the rms displacement
  double largest_difference = 0;          ///< of the face's size
  int thesis_flips = 0, thesis_torn = 0;  ///< triangles; edges
};

/// Worth a look: the target folds or stretches more than the source does.
inline bool folds_more(const ShapeRow& shape) {
  return shape.flips > 20 + 2 * shape.source_flips;
}
inline bool stretches_more(const ShapeRow& shape) {
  return shape.stretch > 8 && shape.stretch > 2 * shape.source_stretch;
}

struct JointRow {
  std::string name;
  int source_joint = 0, target_joint = 0;     ///< nodes
  double source_share = 0, target_share = 0;  ///< of the skin weight around the face
};

struct CurveRow {
  std::string name;  ///< "upper lip - jaw"
  std::vector<double> source, target,
      copied;  ///< epsilon, one a moment; copied: none when copying changes nothing
  CurveAgreement target_agreement, copied_agreement;
};

struct ClipRows {
  std::string name;
  std::vector<double> seconds;
  std::vector<CurveRow> joints, objects, surface;
};

/// Everything that a page says in figures.
struct Data {
  double landmark_mean = 0, landmark_worst = 0;  ///< guide to target at landmarks, of the face's size
  std::string worst_landmark;
  double distance_median = 0, distance_95 = 0, distance_worst = 0;  ///< guide to target, of the face's size
  double filled_share = 0;                                          ///< of all target vertices
  std::vector<ShapeRow> shapes;
  std::vector<Eigen::VectorXf> folds,
      thesis_folds;                      ///< per target part, #V: shapes in which a triangle there turns over
  double torn_share = 0;                 ///< edges torn by the thesis's method in any shape
  std::optional<TransferResult> thesis;  ///< none: the result is the thesis's, or it could not be made
  std::string thesis_problem;            ///< why it could not
  std::vector<JointRow> joints;
  std::vector<ClipRows> clips;
};

Data measure(const ReportInput& input);

std::string as_json(const ReportInput& input, const Data& data);

}  // namespace mien::detail
