#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// Scene with 30 ticks per second, each of which moves all particles, and frames of about 40 kB.
extern const char* const kFanoutScene;

/// `vat bench fanout`: many viewers of one session over real sockets.
void add_fanout_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
