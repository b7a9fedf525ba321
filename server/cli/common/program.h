#pragma once

#include <span>

namespace CLI {
class App;
}

namespace vat {

/// Adds a command, which runs during the parsing of the arguments and writes its exit code.
using AddCommand = void (*)(CLI::App& app, int& exit_code);

/// Runs the command that the arguments specify. Returns an exit code of
/// server/cli/common/command.h.
int run_program(int argc, char** argv, std::span<const AddCommand> commands);

}  // namespace vat
