#pragma once

#include <CLI/CLI.hpp>

#include "core/support/instruction_set.h"

namespace vat {

/// Accepts a finite number in [min, max]. CLI::Range accepts NaN.
CLI::Validator real_in(double min, double max);

/// Accepts a file name that ends in ".csv".
CLI::Validator csv_file_name();

/// Adds `--isa`: an instruction set of this machine, by default the best.
void add_isa_option(CLI::App& command, InstructionSet& instructions);

}  // namespace vat
