#include "mien/core/progress.h"

#include "mien/core/error.h"

namespace mien {

void report_progress(const Progress& progress, std::string_view step, double fraction) {
  if (progress && !progress(step, fraction)) throw Error(Error::Kind::cancelled, step, "cancelled");
}

}  // namespace mien
