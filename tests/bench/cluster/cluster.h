#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench cluster`: times without frames after kills of nodes, and at hand-overs.
void add_cluster_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
