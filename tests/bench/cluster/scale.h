#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// Adds `vat bench scale`: the end of many nodes of a large cluster at once.
void add_scale_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
