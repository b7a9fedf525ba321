#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench race`: runs SPlisHSPlasH and vat alternately on the same dam break.
void add_race_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench
