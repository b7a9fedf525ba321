#pragma once

namespace vat {

/// Runs the command that the arguments of the program name. Returns the exit code of the program,
/// one of those in server/cli/command.h.
int run_command(int argc, char** argv);

}  // namespace vat
