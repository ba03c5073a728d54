// A batch keeps no state but what it writes: beside each output a note says what it was made from, so that a batch that
// was stopped goes on where it was, shards on other machines need not talk, and a changed input is done again.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

#include "command.h"
#include "load_face.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/io/file.h"
#include "mien/io/load.h"
#include "mien/io/manifest_file.h"
#include "mien/transfer/transfer.h"

namespace mien::cli {
namespace {

using nlohmann::json;

struct Request {
  std::string manifest, shard, report;
  bool again = false, compress = false;
};

/// Which jobs are this run's: every `count`-th from `index`, counted from 1.
struct Shard {
  std::size_t index = 1, count = 1;
  bool has(std::size_t job) const { return job % count == index - 1; }
};

Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  const std::size_t slash = text.find('/');
  const auto number = [&](std::string_view part, std::size_t& value) {
    const auto [rest, failure] = std::from_chars(part.data(), part.data() + part.size(), value);
    return failure == std::errc() && rest == part.data() + part.size();
  };
  const std::string_view view = text;
  if (slash == std::string::npos || !number(view.substr(0, slash), shard.index) ||
      !number(view.substr(slash + 1), shard.count) || shard.index < 1 || shard.index > shard.count)
    throw invalid_input("--shard " + text, "is not I/N", "give I from 1 to N, such as 2/8");
  return shard;
}

/// FNV-1a over bytes: tells one content from another, nothing more.
std::uint64_t mixed(std::uint64_t hash, const void* bytes, std::size_t size) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ at[i]) * 0x100000001b3ULL;
  return hash;
}

/// Says whether a job's inputs are the same as before: their bytes, the options and the program.
std::string fingerprint(const TransferJob& job, bool compress) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const std::string program = std::string(MIEN_VERSION) + (compress ? " compressed" : "");
  hash = mixed(hash, program.data(), program.size());
  for (const auto& path : {job.source, job.target, job.source_landmarks, job.target_landmarks}) {
    const std::vector<std::uint8_t> bytes = path.empty() ? std::vector<std::uint8_t>() : read_file(path);
    const std::uint64_t size = bytes.size();
    hash = mixed(mixed(hash, &size, sizeof size), bytes.data(), bytes.size());
  }
  return fmt::format("{:016x}", hash);
}

std::filesystem::path note_path(const TransferJob& job) {
  return job.output.string() + ".job.json";
}

/// What the note beside an output says; an empty object when there is none that can be read.
json note_of(const TransferJob& job) {
  if (!std::filesystem::exists(job.output) || !std::filesystem::exists(note_path(job))) return json::object();
  const std::vector<std::uint8_t> bytes = read_file(note_path(job));
  json note = json::parse(bytes, nullptr, false);
  return note.is_object() ? note : json::object();
}

/// Sources that several jobs share are read once.
class Sources {
 public:
  std::shared_ptr<const Character> get(const TransferJob& job) {
    const std::lock_guard lock(mutex_);
    auto& known = loaded_[{job.source.string(), job.source_landmarks.string()}];
    if (!known)
      known =
          std::make_shared<const Character>(load_face(job.source.string(), job.source_landmarks.string()));
    return known;
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const Character>> loaded_;
};

void make_folder_of(const std::filesystem::path& file) {
  if (file.parent_path().empty()) return;
  std::error_code failure;
  std::filesystem::create_directories(file.parent_path(), failure);
  if (failure) throw io_error("", "its folder cannot be made: " + failure.message()).in_file(file.string());
}

json do_job(const TransferJob& job, const Request& request, Sources& sources) {
  const auto start = std::chrono::steady_clock::now();
  const std::string print = fingerprint(job, request.compress);
  if (const json note = note_of(job); !request.again && note.value("fingerprint", "") == print) {
    json known = note;
    known["state"] = "skipped";
    return known;
  }
  Character source = *sources.get(job);
  Character target = load_face(job.target.string(), job.target_landmarks.string());
  TransferOptions options;
  find_missing({job.source.string(), source}, {job.target.string(), target}, options);
  const TransferResult result = transfer(source, target, options);
  make_folder_of(job.output);
  save(result.character, job.output, {request.compress});
  json warnings = json::array();
  for (const TransferWarning& warning : result.report.warnings)
    warnings.push_back({{"what", warning.what}, {"remedy", warning.remedy}});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  json note = {{"fingerprint", print},
               {"seconds", seconds.count()},
               {"shapes", result.character.shapes.size()},
               {"deltas", name_of(result.report.deltas.model)},
               {"warnings", warnings}};
  write_file_atomically(note_path(job), note.dump(1) + "\n");
  note["state"] = "done";
  return note;
}

/// One entry a job of the manifest: this run's with what became of them, the others' as their notes say.
json run_jobs(const std::vector<TransferJob>& jobs, const Shard& shard, const Request& request,
              const Progress& progress) {
  std::vector<json> entries(jobs.size());
  std::vector<std::size_t> mine;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    if (shard.has(j)) {
      mine.push_back(j);
    } else {
      entries[j] = note_of(jobs[j]);
      entries[j]["state"] = entries[j].contains("fingerprint") ? "done elsewhere" : "of another shard";
    }
  }
  Sources sources;
  std::mutex reporting;
  std::size_t finished = 0;
  std::atomic<bool> stopped{false};
  parallel_for(mine.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end && !stopped; ++k) {
      const TransferJob& job = jobs[mine[k]];
      json& entry = entries[mine[k]];
      try {
        entry = do_job(job, request, sources);
      } catch (const Error& error) {
        entry = {{"state", "failed"}, {"error", error.what()}};
      }
      const std::lock_guard lock(reporting);
      ++finished;
      try {
        report_progress(progress, job.output.filename().string(),
                        static_cast<double>(finished) / static_cast<double>(mine.size()));
      } catch (const Error&) {
        stopped = true;
        throw;
      }
    }
  });
  json list = json::array();
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    entries[j]["output"] = jobs[j].output.string();
    entries[j]["source"] = jobs[j].source.string();
    entries[j]["target"] = jobs[j].target.string();
    list.push_back(std::move(entries[j]));
  }
  return list;
}

std::string as_text(const json& jobs) {
  std::string text;
  for (const json& job : jobs) {
    text += fmt::format("{}: {}", job["output"].get<std::string>(), job["state"].get<std::string>());
    if (job["state"] == "done") text += fmt::format(", {:.2f} s", job["seconds"].get<double>());
    if (job.contains("error")) text += ": " + job["error"].get<std::string>();
    if (job.contains("warnings") && !job["warnings"].empty())
      text += fmt::format(", {} warnings", job["warnings"].size());
    text += "\n";
  }
  return text;
}

void run(const Request& request, const Common& common) {
  const Shard shard = shard_of(request.shard);
  const std::vector<TransferJob> jobs = read_manifest(request.manifest);
  std::filesystem::path report = request.report;
  if (report.empty()) report = std::filesystem::path(request.manifest).replace_extension(".report.json");
  const json list = run_jobs(jobs, shard, request, progress_bar(common));
  const auto count = [&](const char* state) {
    return std::count_if(list.begin(), list.end(), [&](const json& job) { return job["state"] == state; });
  };
  const json result = {
      {"manifest", request.manifest}, {"report", report.string()},   {"jobs", list},
      {"done", count("done")},        {"skipped", count("skipped")}, {"failed", count("failed")}};
  write_file_atomically(report, result.dump(1) + "\n");
  print_result(common, as_text(list) + "report: " + report.string() + "\n", result);
  if (const auto failed = count("failed"); failed > 0) {
    const auto first =
        std::find_if(list.begin(), list.end(), [](const json& job) { return job["state"] == "failed"; });
    throw invalid_input("batch",
                        fmt::format("{} of {} jobs failed, first: {}", failed, jobs.size(),
                                    (*first)["error"].get<std::string>()),
                        "the report says why each did");
  }
}

}  // namespace

void add_batch(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("batch", "Do a list of transfers; what is done already is skipped");
  auto request = std::make_shared<Request>();
  command
      ->add_option("manifest", request->manifest,
                   "{\"jobs\": [{\"source\", \"target\", \"output\", \"source_landmarks\", "
                   "\"target_landmarks\"}, ...]}, "
                   "paths relative to its folder")
      ->required();
  command->add_option("--shard", request->shard,
                      "I/N: do every N-th job from the I-th on, for an array of machines");
  command->add_option("--report", request->report,
                      "Where the report goes (default: the manifest's name with .report.json)");
  command->add_flag("--again", request->again, "Do jobs that are done too");
  command->add_flag("--compress", request->compress, "Write quantised, meshopt-compressed glTF");
  command->footer("Example: mien batch crowd.json --shard 2/8");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace mien::cli
