#pragma once

namespace vat::bench {

/// Runs the benchmark that the arguments of the program name. Returns the exit code of the program,
/// one of those in server/cli/common/command.h.
int run_command(int argc, char** argv);

}  // namespace vat::bench
