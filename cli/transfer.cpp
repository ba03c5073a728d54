#include "command.h"

namespace mien::cli {

void add_transfer(CLI::App& app, Common& common) {
  (void)common;
  app.add_subcommand("transfer", "");
}

}  // namespace mien::cli
