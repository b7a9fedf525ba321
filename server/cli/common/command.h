#pragma once

#include <ostream>
#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace CLI {
class App;
}

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

/// Adds `vat serve`. Each command runs during the parse and leaves its result in `exit_code`; this
/// one runs until SIGINT or SIGTERM.
void add_serve_command(CLI::App& app, int& exit_code);
/// Adds `vat simulate`.
void add_simulate_command(CLI::App& app, int& exit_code);
/// Adds `vat validate`.
void add_validate_command(CLI::App& app, int& exit_code);
/// Adds `vat script`: plays scripts of the protocol against a server.
void add_script_command(CLI::App& app, int& exit_code);
/// Adds `vat replay`.
void add_replay_command(CLI::App& app, int& exit_code);

}  // namespace vat
