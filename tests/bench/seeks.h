#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench seeks`: duration of `replay.seek` in a running server.
void add_seeks_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
