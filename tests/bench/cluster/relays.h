#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// Adds the command `relays`: viewers of one session through two relays.
void add_relays_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
