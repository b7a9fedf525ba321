#include "server/cli/common/commands.h"
#include "server/cli/common/program.h"

/// The program with the commands of a server only. It compiles in less time than the whole program.
int main(int argc, char** argv) {
  constexpr vat::AddCommand kCommands[] = {vat::add_serve_command, vat::add_backup_commands};
  return vat::run_program(argc, argv, kCommands);
}
