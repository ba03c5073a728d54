#include "command.h"

namespace mien::cli {

void add_assemble(CLI::App& app, Common& common) {
  (void)common;
  app.add_subcommand("assemble", "");
}

}  // namespace mien::cli
