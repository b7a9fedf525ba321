#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench faults`: a soak with hostile clients, a disk that pauses, kill -9, clock steps and
/// memory pressure.
void add_faults_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
