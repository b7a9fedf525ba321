#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace vat::bench {

/// Runs a program of the search path with its arguments (`words`) in a folder. Writes its output to
/// the file `log` there. Fails with the advice if it cannot be started, and with its output if it
/// fails.
Status run_program(std::vector<std::string> words, const std::filesystem::path& folder,
                   const std::string& log, const std::string& advice);

}  // namespace vat::bench
