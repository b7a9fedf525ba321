#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/scene/device_choice.h"
#include "core/support/instruction_set.h"
#include "protocol/scene/level.h"

namespace vat {

/// Returns a validator for finite numbers in [min, max]. CLI::Range accepts NaN.
CLI::Validator real_in(double min, double max);

/// Returns a validator for file names that end in ".csv".
CLI::Validator csv_file_name();

/// Returns a validator for one of the names.
CLI::Validator one_of(std::vector<std::string> names);

/// Adds the option `--isa`: an instruction set of this machine. The default is the best instruction
/// set.
void add_isa_option(CLI::App& command, InstructionSet& instructions);

/// Adds the option `--level`: a level of detail of the scene. The default is normal.
void add_level_option(CLI::App& command, Level& level);

/// Adds the option `--device`: the device that takes the steps. The default is the
/// device of the scene, otherwise the CPU.
void add_device_option(CLI::App& command, std::optional<DeviceChoice>& device);

}  // namespace vat
