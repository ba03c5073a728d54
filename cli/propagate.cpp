#include "mien/transfer/propagate.h"

#include <memory>

#include "jobs.h"
#include "load_face.h"
#include "mien/core/error.h"
#include "mien/io/file.h"
#include "mien/io/load.h"
#include "mien/io/manifest_file.h"

namespace mien::cli {
namespace {

using nlohmann::json;

json do_propagation(const Propagation& sources, const PropagationTarget& job, const JobsRequest& request,
                    SharedFaces& faces) {
  Character target = load_face(job.target.string(), job.landmarks.string());
  const Character own = target;
  MergeReport report;
  json warnings = json::array();
  const bool unchanged = read_file(sources.before) == read_file(sources.after);
  if (!unchanged) {
    Character before = *faces.get(sources.before, sources.before_landmarks);
    Character after = *faces.get(sources.after, sources.after_landmarks);
    TransferOptions options;
    const Side marked{job.target.string(), target};
    find_missing({sources.before.string(), before}, marked, options);
    find_missing({sources.after.string(), after}, marked, options);
    PropagateResult result = propagate(before, after, target, options);
    target = std::move(result.character);
    target.landmarks = own.landmarks;
    target.curves = own.curves;
    report = std::move(result.report);
    for (const TransferWarning& warning : result.warnings)
      warnings.push_back({{"what", warning.what}, {"remedy", warning.remedy}});
  }
  make_folder_of(job.output);
  save(target, job.output, {request.compress});
  return {{"source_changed", !unchanged}, {"kept", report.kept},           {"updated", report.updated},
          {"removed", report.removed},    {"conflicts", report.conflicts}, {"warnings", warnings}};
}

void run(const JobsRequest& request, const Common& common) {
  SharedFaces faces;
  const Propagation propagation = read_propagation(request.manifest);
  std::vector<Job> jobs;
  for (const PropagationTarget& target : propagation.targets)
    jobs.push_back({target.output,
                    {propagation.before, propagation.after, propagation.before_landmarks,
                     propagation.after_landmarks, target.target, target.landmarks},
                    {{"target", target.target.string()}},
                    [&, target] { return do_propagation(propagation, target, request, faces); }});
  run_jobs("propagate", jobs, request, common);
}

}  // namespace

void add_propagate(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand(
      "propagate", "Bring a changed source to targets that were worked on since: their changes stay");
  auto request = std::make_shared<JobsRequest>();
  add_jobs_options(
      *command, *request,
      "{\"source_before\": F, \"source_after\": F, \"targets\": [{\"target\": F, \"output\": F, "
      "\"landmarks\": F}, ...]}, also \"source_before_landmarks\" and \"source_after_landmarks\"");
  command->footer("Example: mien propagate cast.json");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace mien::cli
