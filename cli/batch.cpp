#include <memory>

#include "jobs.h"
#include "load_face.h"
#include "mien/io/load.h"
#include "mien/io/manifest_file.h"
#include "mien/transfer/transfer.h"

namespace mien::cli {
namespace {

using nlohmann::json;

json do_transfer(const TransferJob& job, const JobsRequest& request, SharedFaces& sources) {
  Character source = *sources.get(job.source, job.source_landmarks);
  Character target = load_face(job.target.string(), job.target_landmarks.string());
  TransferOptions options;
  find_missing({job.source.string(), source}, {job.target.string(), target}, options);
  const TransferResult result = transfer(source, target, options);
  make_folder_of(job.output);
  save(result.character, job.output, {request.compress});
  json warnings = json::array();
  for (const TransferWarning& warning : result.report.warnings)
    warnings.push_back({{"what", warning.what}, {"remedy", warning.remedy}});
  return {{"shapes", result.character.shapes.size()},
          {"deltas", name_of(result.report.deltas.model)},
          {"warnings", warnings}};
}

void run(const JobsRequest& request, const Common& common) {
  SharedFaces sources;
  std::vector<Job> jobs;
  for (const TransferJob& job : read_manifest(request.manifest))
    jobs.push_back({job.output,
                    {job.source, job.target, job.source_landmarks, job.target_landmarks},
                    {{"source", job.source.string()}, {"target", job.target.string()}},
                    [job, &request, &sources] { return do_transfer(job, request, sources); }});
  run_jobs("batch", jobs, request, common);
}

}  // namespace

void add_batch(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("batch", "Do a list of transfers; what is done already is skipped");
  auto request = std::make_shared<JobsRequest>();
  add_jobs_options(*command, *request,
                   "{\"jobs\": [{\"source\", \"target\", \"output\", \"source_landmarks\", "
                   "\"target_landmarks\"}, ...]}");
  command->footer("Example: mien batch crowd.json --shard 2/8");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace mien::cli
