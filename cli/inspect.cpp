#include "command.h"

namespace mien::cli {

void add_inspect(CLI::App& app, Common& common) {
  (void)common;
  app.add_subcommand("inspect", "");
}

}  // namespace mien::cli
