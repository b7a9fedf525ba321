#pragma once

#include <CLI/CLI.hpp>

#include "core/support/instruction_set.h"

namespace vat {

/// Returns a validator for finite numbers in [min, max]. CLI::Range accepts NaN.
CLI::Validator real_in(double min, double max);

/// Returns a validator for file names that end in ".csv".
CLI::Validator csv_file_name();

/// Adds the option `--isa`: an instruction set of this machine. The default is the best instruction
/// set.
void add_isa_option(CLI::App& command, InstructionSet& instructions);

}  // namespace vat
