#pragma once

#include <CLI/CLI.hpp>

#include "core/support/instruction_set.h"

namespace vat {

/// A finite number in [min, max]. CLI::Range lets NaN through.
CLI::Validator real_in(double min, double max);

/// A file name that ends in ".csv".
CLI::Validator csv_file_name();

/// Adds `--isa`: one of the instruction sets that this machine has; the best of them by default.
void add_isa_option(CLI::App& command, InstructionSet& instructions);

}  // namespace vat
