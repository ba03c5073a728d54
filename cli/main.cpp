#include <fmt/format.h>

#include "command.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"

namespace {

void add_common_flags(CLI::App& app, mien::cli::Common& common) {
  app.add_flag("--json", common.json, "Print the result as one JSON object on stdout");
  app.add_flag("--quiet", common.quiet, "Print nothing but errors");
  app.add_option("--threads", common.threads, "Threads to use; 0: all cores")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("mien: create a facial rig once, use it on many");
  app.name("mien");
  app.require_subcommand(1);
  app.set_version_flag("--version", "mien " MIEN_VERSION);
  mien::cli::Common common;
  mien::cli::add_sample(app, common);
  mien::cli::add_inspect(app, common);
  mien::cli::add_assemble(app, common);
  mien::cli::add_landmarks(app, common);
  mien::cli::add_transfer(app, common);
  mien::cli::add_wires(app, common);
  mien::cli::add_objects(app, common);
  mien::cli::add_blend(app, common);
  mien::cli::add_render(app, common);
  mien::cli::add_evaluate(app, common);
  mien::cli::add_pose(app, common);
  mien::cli::add_attenuate(app, common);
  mien::cli::add_constrain(app, common);
  mien::cli::add_controls(app, common);
  mien::cli::add_vrm(app, common);
  mien::cli::add_retarget(app, common);
  mien::cli::add_rename(app, common);
  mien::cli::add_map(app, common);
  mien::cli::add_batch(app, common);
  mien::cli::add_propagate(app, common);
  mien::cli::add_split(app, common);
  mien::cli::add_mirror(app, common);
  for (CLI::App* command : app.get_subcommands({})) {
    add_common_flags(*command, common);
    command->parse_complete_callback([&common] { mien::set_thread_count(common.threads); });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const mien::Error& e) {
    fmt::print(stderr, "mien: {}\n", e.what());
    return 1;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "mien: out of memory\n");
    return 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "mien: {}\n", e.what());
    return 1;
  }
  return 0;
}
