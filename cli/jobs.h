#pragma once
/// Lists of jobs that each make one file: on all cores or many machines, resumed where they stopped, with one report.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "command.h"
#include "mien/character/character.h"

namespace mien::cli {

struct Job {
  std::filesystem::path output;
  std::vector<std::filesystem::path> inputs;  ///< files that the output is made from; empty: none there
  nlohmann::json names;                       ///< what the report says of the job besides its output
  std::function<nlohmann::json()>
      work;  ///< writes the output; what it returns is noted beside it and reported
};

struct JobsRequest {
  std::string manifest, shard, report;
  bool again = false, compress = false;
};

/// The options that all lists of jobs have.
void add_jobs_options(CLI::App& command, JobsRequest& request, const char* manifest_form);

/// Does the jobs of this shard that are not done yet, writes the report and prints it.
///   kind    what the list is called: "batch"
///   throws  invalid_input: a shard that is not I/N; some job failed, after all others were done
void run_jobs(const std::string& kind, const std::vector<Job>& jobs, const JobsRequest& request,
              const Common& common);

/// Makes the folder of a file that is to be written.
void make_folder_of(const std::filesystem::path& file);

/// Faces that several jobs share are read once.
class SharedFaces {
 public:
  std::shared_ptr<const Character> get(const std::filesystem::path& face,
                                       const std::filesystem::path& landmarks);

 private:
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const Character>> loaded_;
};

}  // namespace mien::cli
