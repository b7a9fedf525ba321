#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench fanout`: many viewers of one session over real sockets.
void add_fanout_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
