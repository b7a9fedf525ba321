#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench recovery`: written bytes of a large session, and time of its recovery after kill -9.
void add_recovery_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
