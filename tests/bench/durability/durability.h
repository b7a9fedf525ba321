#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench durability`: the cost of storing commands, by number of sessions and durability.
void add_durability_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
