#include "mien/io/manifest_file.h"

#include <fmt/format.h>

#include <set>

#include "mien/core/error.h"
#include "mien/io/detail/json_file.h"

namespace mien {
namespace {

std::filesystem::path beside(const std::filesystem::path& manifest, const std::string& name) {
  return name.empty() ? std::filesystem::path() : (manifest.parent_path() / name).lexically_normal();
}

TransferJob read_job(const detail::JsonObject& source, const std::filesystem::path& manifest) {
  source.expect_only({"source", "target", "output", "source_landmarks", "target_landmarks"});
  TransferJob job;
  job.source = beside(manifest, source.text("source"));
  job.target = beside(manifest, source.text("target"));
  job.output = beside(manifest, source.text("output"));
  job.source_landmarks = beside(manifest, source.text_or("source_landmarks", ""));
  job.target_landmarks = beside(manifest, source.text_or("target_landmarks", ""));
  for (const char* key : {"source", "target", "output"})
    if (source.text(key).empty()) throw io_error(source.place_of(key), "is empty", "name a file");
  return job;
}

}  // namespace

std::vector<TransferJob> read_manifest(const std::filesystem::path& path) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
    std::vector<TransferJob> jobs;
    std::set<std::filesystem::path> outputs;
    for (const detail::JsonObject& source : root.objects("jobs")) {
      jobs.push_back(read_job(source, path));
      if (!outputs.insert(jobs.back().output).second)
        throw io_error(source.place_of("output"), fmt::format("is {} again", jobs.back().output.string()),
                       "give each job its own output");
    }
    if (jobs.empty())
      throw io_error("file", "has no \"jobs\"",
                     R"(give {"jobs": [{"source": F, "target": F, "output": F}]})");
    return jobs;
  });
}

}  // namespace mien
