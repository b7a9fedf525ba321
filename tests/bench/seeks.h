#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench seeks`: how long `replay.seek` takes in a running server.
void add_seeks_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
