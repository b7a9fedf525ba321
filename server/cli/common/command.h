#pragma once

#include <ostream>
#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

/// Exit codes of the program.
inline constexpr int kExitOk = 0;
inline constexpr int kExitFailed = 1;    ///< invalid input, or a failed run
inline constexpr int kExitUsage = 2;     ///< unknown option, or invalid value
inline constexpr int kExitSignal = 128;  ///< plus the number of the signal that ended a run

/// Prints one line per error: "PATH: message". An error of the whole input has the input's name.
void print_errors(std::ostream& out, const std::string& input, const Errors& errors);

/// Prints the warnings of find_warnings() to stderr.
void print_warnings(const std::string& input, const Scene& scene);

/// Prints the errors to stderr; returns kExitFailed.
int fail(const std::string& input, const Errors& errors);

}  // namespace vat
