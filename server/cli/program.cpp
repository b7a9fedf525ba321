#include "server/cli/program.h"

#include <CLI/CLI.hpp>

#include "server/cli/common/command.h"

namespace vat {

int run_command(int argc, char** argv) {
  CLI::App app{"Particle simulation of interacting liquids, deformable and rigid bodies", "vat"};
  app.set_version_flag("--version", "vat " VAT_VERSION);
  // Not require_subcommand(1): that would hide which word is not a sub-command.
  app.require_subcommand(0, 1);
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
  });
  int exit_code = kExitOk;
  add_serve_command(app, exit_code);
  add_simulate_command(app, exit_code);
  add_validate_command(app, exit_code);
  add_devices_command(app, exit_code);
  add_script_command(app, exit_code);
  add_replay_command(app, exit_code);
  add_record_command(app, exit_code);
  add_export_command(app, exit_code);
  add_backup_commands(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  return exit_code;
}

}  // namespace vat
