#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench output`: size of the files of `vat simulate --output`, and the time to write them.
void add_output_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
