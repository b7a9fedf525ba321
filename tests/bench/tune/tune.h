#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench tune`: choices of `vat tune` for the catalogue, compared with an exhaustive search.
void add_tune_bench_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
