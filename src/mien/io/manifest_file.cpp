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

void require_names(const detail::JsonObject& source, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (source.text(key).empty()) throw io_error(source.place_of(key), "is empty", "name a file");
}

TransferJob read_job(const detail::JsonObject& source, const std::filesystem::path& manifest) {
  source.expect_only({"source", "target", "output", "source_landmarks", "target_landmarks"});
  TransferJob job;
  job.source = beside(manifest, source.text("source"));
  job.target = beside(manifest, source.text("target"));
  job.output = beside(manifest, source.text("output"));
  job.source_landmarks = beside(manifest, source.text_or("source_landmarks", ""));
  job.target_landmarks = beside(manifest, source.text_or("target_landmarks", ""));
  require_names(source, {"source", "target", "output"});
  return job;
}

PropagationTarget read_target(const detail::JsonObject& source, const std::filesystem::path& manifest) {
  source.expect_only({"target", "output", "landmarks"});
  require_names(source, {"target", "output"});
  return {beside(manifest, source.text("target")), beside(manifest, source.text("output")),
          beside(manifest, source.text_or("landmarks", ""))};
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

Propagation read_propagation(const std::filesystem::path& path) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
    root.expect_only(
        {"source_before", "source_after", "source_before_landmarks", "source_after_landmarks", "targets"});
    require_names(root, {"source_before", "source_after"});
    Propagation propagation;
    propagation.before = beside(path, root.text("source_before"));
    propagation.after = beside(path, root.text("source_after"));
    propagation.before_landmarks = beside(path, root.text_or("source_before_landmarks", ""));
    propagation.after_landmarks = beside(path, root.text_or("source_after_landmarks", ""));
    std::set<std::filesystem::path> outputs;
    for (const detail::JsonObject& source : root.objects("targets")) {
      propagation.targets.push_back(read_target(source, path));
      if (!outputs.insert(propagation.targets.back().output).second)
        throw io_error(source.place_of("output"),
                       fmt::format("is {} again", propagation.targets.back().output.string()),
                       "give each target its own output");
    }
    if (propagation.targets.empty())
      throw io_error(
          "file", "has no \"targets\"",
          R"(give {"source_before": F, "source_after": F, "targets": [{"target": F, "output": F}]})");
    return propagation;
  });
}

}  // namespace mien
