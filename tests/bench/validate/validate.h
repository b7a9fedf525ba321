#pragma once

#include <optional>
#include <vector>

#include "core/scene/device_choice.h"
#include "tests/bench/options.h"
#include "tests/validation/case.h"

namespace vat::bench {

/// Adds `vat bench validate`. It runs during the parse and sets `exit_code`.
void add_validate_command(CLI::App& app, int& exit_code);

/// Runs the command with these cases on the CPU, or on a device and the CPU. Returns its exit code.
int validate(const Options& options, const std::vector<validation::Case>& cases,
             const std::optional<DeviceChoice>& device = {});

}  // namespace vat::bench
