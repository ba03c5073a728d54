#pragma once
/// Lists of work: {"jobs": [{"source": F, "target": F, "output": F, ...}, ...]} for transfers, {"source_before": F,
/// "source_after": F, "targets": [{"target": F, "output": F, ...}, ...]} for a source that changed.

#include <filesystem>
#include <string>
#include <vector>

namespace mien {

/// One transfer to do. Paths are absolute, or relative to the manifest's folder as the file gives them, made whole.
struct TransferJob {
  std::filesystem::path source, target, output;
  std::filesystem::path source_landmarks, target_landmarks;  ///< empty: inside the files, or found
};

///   throws  Error naming the file and the job: not JSON, another form, a member that is not known, two jobs of one
///           output, no jobs
std::vector<TransferJob> read_manifest(const std::filesystem::path& path);

/// A target that a changed source is to be brought to. Paths as above.
struct PropagationTarget {
  std::filesystem::path target, output;
  std::filesystem::path landmarks;  ///< empty: inside the file, or found
};
struct Propagation {
  std::filesystem::path before, after;                      ///< the source's two versions
  std::filesystem::path before_landmarks, after_landmarks;  ///< empty: inside the files, or found
  std::vector<PropagationTarget> targets;
};

///   throws  Error naming the file and the target: as read_manifest
Propagation read_propagation(const std::filesystem::path& path);

}  // namespace mien
