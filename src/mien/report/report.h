#pragma once
/// What a transfer did, as one page to look at and the same numbers as JSON.

#include <string>

#include "mien/character/character.h"
#include "mien/core/progress.h"
#include "mien/transfer/transfer.h"

namespace mien {

struct ReportInput {
  const Character& source;       ///< as given to `transfer`
  const Character& target;       ///< as given to `transfer`
  const TransferResult& result;  ///< what it returned
  TransferOptions options;       ///< as given to `transfer`; its progress is not called
  std::string source_name = "source", target_name = "target",
              output_name = "output";  ///< shown, usually file names
  Progress progress = {};
};

struct Report {
  std::string html;  ///< one page, UTF-8, pictures inside; asks for nothing from outside
  std::string json;  ///< one object, UTF-8: the numbers of the page and those too many for it
};

/// The page holds: the decisions and warnings; source, guide and target with their landmarks; maps of distance, filled-in
/// vertices and folds; every shape on both faces; the thesis's method on the same inputs beside this result; skin weights
/// by joint; relative deformation curves of every clip (relative_deformation.h); seconds a step beside the thesis's own.
///   throws  invalid_input: a result that does not belong to the source and the target; cancelled
///   cost    a second transfer by the thesis's method, and about 0.1 s a shape for the pictures on two cores
/// The names are escaped: a file cannot bring markup into the page. The numbers depend on the input alone, except the
/// seconds.
Report make_report(const ReportInput& input);

}  // namespace mien
