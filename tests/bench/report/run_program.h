#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace vat::bench {

/// Runs a program of the search path with its arguments (`words`) in a folder, with all that it
/// prints in the file `log` there. Fails where it cannot be started, with the advice, and where it
/// does not succeed, with what it printed.
Status run_program(std::vector<std::string> words, const std::filesystem::path& folder,
                   const std::string& log, const std::string& advice);

}  // namespace vat::bench
