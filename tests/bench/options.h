#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace vat::bench {

/// What the sub-commands that run cases have in common.
struct Options {
  std::string output;              ///< folder of the results
  bool quick = false;              ///< fewer and shorter runs
  std::vector<std::string> cases;  ///< none: all
  bool list = false;               ///< print the names of the cases, and stop
  std::size_t threads = 1;         ///< of each simulation
};

/// Adds --output, --quick, --case and --list; the results go to build/bench/NAME by default, NAME
/// being the command's.
void add_case_options(CLI::App& command, Options& options);
/// The same and --threads.
void add_options(CLI::App& command, Options& options);
/// For options that are a number of threads.
CLI::Validator thread_count_range();

/// Positions in `known` of the names that `wanted` lists, all if it is empty. An unknown name is an
/// error that lists the known ones.
Result<std::vector<std::size_t>> choose(const std::vector<std::string>& wanted,
                                        const std::vector<std::string>& known);

/// Prints one name a line.
void print_names(const std::vector<std::string>& names);

}  // namespace vat::bench
