#pragma once

namespace vat::bench {

/// Runs the benchmark that the program's arguments name. Returns an exit code of
/// server/cli/common/command.h.
int run_command(int argc, char** argv);

}  // namespace vat::bench
