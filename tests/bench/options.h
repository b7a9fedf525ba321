#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace vat::bench {

/// Options of the sub-commands that run cases.
struct Options {
  std::string output;              ///< folder for the results
  bool quick = false;              ///< fewer and shorter runs
  std::vector<std::string> cases;  ///< empty: all
  bool list = false;               ///< print the names of the cases and stop
  std::size_t threads = 1;         ///< per simulation
};

/// Adds --output, --quick, --case and --list. The default folder of results is build/bench/NAME
/// with the name of the command.
void add_case_options(CLI::App& command, Options& options);
/// Adds the same options and --threads.
void add_options(CLI::App& command, Options& options);
/// Returns the validator of options for a number of threads.
CLI::Validator thread_count_range();

/// Returns the indices in `known` of the names in `wanted`, or all indices if it is empty. An
/// unknown name gives an error with the known names.
Result<std::vector<std::size_t>> choose(const std::vector<std::string>& wanted,
                                        const std::vector<std::string>& known);

/// Prints one name per line.
void print_names(const std::vector<std::string>& names);

}  // namespace vat::bench
