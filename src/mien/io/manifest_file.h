#pragma once
/// The manifest of a batch: {"jobs": [{"source": F, "target": F, "output": F, ...}, ...]}.

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

}  // namespace mien
