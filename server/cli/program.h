#pragma once

namespace vat {

/// Runs the command that the arguments specify. Returns an exit code of
/// server/cli/common/command.h.
int run_command(int argc, char** argv);

}  // namespace vat
