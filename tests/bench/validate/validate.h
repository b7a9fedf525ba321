#pragma once

#include <vector>

#include "tests/bench/options.h"
#include "tests/validation/case.h"

namespace vat::bench {

/// Adds `vat bench validate`; it runs during the parse and leaves its result in `exit_code`.
void add_validate_command(CLI::App& app, int& exit_code);

/// What the command does, with these cases; returns its exit code.
int validate(const Options& options, const std::vector<validation::Case>& cases);

}  // namespace vat::bench
