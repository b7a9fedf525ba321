#pragma once

#include <ostream>
#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

/// Exit codes of the program.
inline constexpr int kExitOk = 0;
inline constexpr int kExitFailed = 1;  ///< invalid input, or a failed run
inline constexpr int kExitUsage = 2;   ///< unknown option, or invalid value
/// Exit code of a run that a signal ended, minus the number of the signal.
inline constexpr int kExitSignal = 128;

/// Prints one line "PATH: message" per error. If the path is empty, prints the input's name
/// instead.
void print_errors(std::ostream& out, const std::string& input, const Errors& errors);

/// Prints the warnings of find_warnings() to stderr.
void print_warnings(const std::string& input, const Scene& scene);

/// Prints the errors to stderr and returns kExitFailed.
int fail(const std::string& input, const Errors& errors);

}  // namespace vat
