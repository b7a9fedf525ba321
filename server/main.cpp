#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "server/cli/command.h"
#include "server/cli/replay.h"
#include "server/cli/script.h"
#include "server/cli/serve.h"
#include "server/cli/simulate.h"
#include "server/cli/validate.h"

namespace {

int run(int argc, char** argv) {
  CLI::App app{"Particle simulation of interacting liquids, deformable and rigid bodies", "vat"};
  app.set_version_flag("--version", "vat " VAT_VERSION);
  // Not require_subcommand(1): that would hide which word is not a sub-command.
  app.require_subcommand(0, 1);
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
  });
  int exit_code = vat::kExitOk;
  vat::add_serve_command(app, exit_code);
  vat::add_simulate_command(app, exit_code);
  vat::add_validate_command(app, exit_code);
  vat::add_script_command(app, exit_code);
  vat::add_replay_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? vat::kExitOk : vat::kExitUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int exit_code = run(argc, argv);
    if (std::cout.flush()) return exit_code;
    std::cerr << "vat: standard output cannot be written\n";  // a full disk, say
    return vat::kExitFailed;
  } catch (const std::exception& error) {
    std::cerr << "vat: " << error.what() << '\n';
    return vat::kExitFailed;
  }
}
