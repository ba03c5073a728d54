#include "command.h"

namespace mien::cli {

void add_render(CLI::App& app, Common& common) {
  (void)common;
  app.add_subcommand("render", "");
}

}  // namespace mien::cli
