#include "server/cli/common/commands.h"
#include "server/cli/common/program.h"

int main(int argc, char** argv) {
  constexpr vat::AddCommand kCommands[] = {
      vat::add_serve_command,    vat::add_simulate_command, vat::add_tune_command,
      vat::add_validate_command, vat::add_convert_command,  vat::add_devices_command,
      vat::add_script_command,   vat::add_replay_command,   vat::add_record_command,
      vat::add_export_command,   vat::add_backup_commands,  vat::add_complete_command};
  return vat::run_program(argc, argv, kCommands);
}
