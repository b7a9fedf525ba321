#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench soak`: many sessions and clients of all behaviours, for minutes.
void add_soak_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
