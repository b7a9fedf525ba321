#pragma once

#include <vector>

#include "tests/bench/options.h"
#include "tests/validation/case.h"

namespace vat::bench {

/// Adds `vat bench validate`. It runs during the parse and sets `exit_code`.
void add_validate_command(CLI::App& app, int& exit_code);

/// Runs the command with these cases. Returns its exit code.
int validate(const Options& options, const std::vector<validation::Case>& cases);

}  // namespace vat::bench
