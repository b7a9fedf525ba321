#include "tests/bench/validate/validate.h"

#include <iomanip>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "core/threads/thread_pool.h"
#include "server/cli/common/command.h"
#include "tests/bench/options.h"
#include "tests/bench/report/table.h"
#include "tests/bench/validate/validate_table.h"
#include "tests/validation/cases.h"

namespace vat::bench {

namespace {

using validation::Case;
using validation::Outcome;
using validation::Row;

void print_row(const Row& row) {
  std::cout << "  " << (row.passed() ? "ok    " : "FAILED") << ' ' << std::left << std::setw(52)
            << row.metric << ' ' << std::setw(13) << short_text(row.measured) << tolerance_text(row)
            << std::endl;
}

Outcome run_and_print(const Case& one, const validation::Settings& settings) {
  std::cout << one.name << ": " << one.title << std::endl;
  Outcome outcome = validation::run_case(one, settings);
  for (const Row& row : outcome.rows) print_row(row);
  if (outcome.error) std::cerr << one.name << ": " << *outcome.error << std::endl;
  return outcome;
}

/// Prints the number of passed rows and cases. Returns false if one failed.
bool print_summary(const std::vector<Outcome>& outcomes) {
  std::size_t rows = 0;
  std::size_t good_rows = 0;
  std::size_t good_cases = 0;
  for (const Outcome& outcome : outcomes) {
    rows += outcome.rows.size();
    for (const Row& row : outcome.rows) good_rows += row.passed() ? 1u : 0u;
    good_cases += outcome.passed() ? 1u : 0u;
  }
  std::cout << good_rows << " of " << rows << " rows and " << good_cases << " of "
            << outcomes.size() << " cases passed\n";
  return good_cases == outcomes.size();
}

}  // namespace

int validate(const Options& options, const std::vector<Case>& cases) {
  std::vector<std::string> names;
  for (const Case& one : cases) names.push_back(one.name);
  if (options.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.cases, names);
  if (!chosen) return fail("validate", chosen.errors());
  ThreadPoolRunner runner(options.threads);
  std::vector<Outcome> outcomes;
  for (const std::size_t index : chosen.value()) {
    outcomes.push_back(run_and_print(cases[index], {options.quick, &runner}));
  }
  const bool passed = print_summary(outcomes);
  const Status written =
      write_table(validation_table(outcomes), options.output, "validation", "# Validation");
  if (!written) return fail(options.output, written.errors());
  std::cout << "written to " << options.output << '\n';
  return passed ? kExitOk : kExitFailed;
}

void add_validate_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("validate", "Compare the physics with reference values, case by case");
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->footer("Exit codes: 0 every row within its tolerance, 1 otherwise, 2 wrong usage.");
  command->callback(
      [options, &exit_code] { exit_code = validate(*options, validation::all_cases()); });
}

}  // namespace vat::bench
