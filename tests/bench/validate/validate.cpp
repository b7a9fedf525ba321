#include "tests/bench/validate/validate.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/threads/thread_pool.h"
#include "server/cli/common/command.h"
#include "server/cli/common/option_checks.h"
#include "tests/bench/options.h"
#include "tests/bench/report/table.h"
#include "tests/bench/validate/device_rows.h"
#include "tests/bench/validate/validate_table.h"
#include "tests/validation/cases.h"

namespace vat::bench {

namespace {

using validation::Case;
using validation::Outcome;
using validation::Row;

void print_metric(const char* result, const Row& row) {
  std::cout << "  " << result << ' ' << std::left << std::setw(52) << row.metric << ' ';
}

const char* result_of(const Row& row) {
  return row.passed() ? "ok    " : "FAILED";
}

void print_row(const Row& row) {
  print_metric(result_of(row), row);
  std::cout << std::setw(13) << short_text(row.measured) << tolerance_text(row) << std::endl;
}

void print_device_row(const DeviceRow& row) {
  if (!row.on_cpu) {
    print_metric("-     ", row.on_device);
    std::cout << row.on_device.refusal << std::endl;
    return;
  }
  print_metric(result_of(row.on_device), row.on_device);
  std::cout << "error " << std::setw(13) << short_text(error_of(row.on_device)) << "CPU "
            << std::setw(13) << short_text(error_of(*row.on_cpu)) << tolerance_text(row.on_device)
            << std::endl;
}

Outcome run_and_print(const Case& one, const validation::Settings& settings) {
  std::cout << one.name << ": " << one.title << std::endl;
  Outcome outcome = validation::run_case(one, settings);
  for (const Row& row : outcome.rows) print_row(row);
  if (outcome.error) std::cerr << one.name << ": " << *outcome.error << std::endl;
  return outcome;
}

DeviceOutcome run_on_device_and_print(const Case& one, const validation::Settings& settings) {
  std::cout << one.name << ": " << one.title << std::endl;
  DeviceOutcome outcome = run_on_device(one, settings);
  for (const DeviceRow& row : outcome.rows) print_device_row(row);
  if (outcome.error) std::cerr << one.name << ": " << *outcome.error << std::endl;
  return outcome;
}

/// Prints the numbers of rows. Returns false if a case failed.
bool print_device_summary(const std::vector<DeviceOutcome>& outcomes) {
  std::size_t rows = 0;
  std::size_t refused = 0;
  std::size_t good = 0;
  for (const DeviceOutcome& outcome : outcomes) {
    for (const DeviceRow& row : outcome.rows) {
      ++rows;
      refused += row.is_refused() ? 1u : 0u;
      good += !row.is_refused() && row.passed() ? 1u : 0u;
    }
  }
  std::cout << good << " of " << rows - refused << " rows on the device passed, and " << refused
            << " rows are not on the device\n";
  return std::ranges::all_of(outcomes, &DeviceOutcome::passed);
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

int validate(const Options& options, const std::vector<Case>& cases,
             const std::optional<DeviceChoice>& device) {
  std::vector<std::string> names;
  for (const Case& one : cases) names.push_back(one.name);
  if (options.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.cases, names);
  if (!chosen) return fail("validate", chosen.errors());
  ThreadPoolRunner runner(options.threads);
  const validation::Settings settings{options.quick, &runner, device};
  std::vector<Outcome> outcomes;
  std::vector<DeviceOutcome> on_device;
  for (const std::size_t index : chosen.value()) {
    if (device) {
      on_device.push_back(run_on_device_and_print(cases[index], settings));
    } else {
      outcomes.push_back(run_and_print(cases[index], settings));
    }
  }
  const bool passed = device ? print_device_summary(on_device) : print_summary(outcomes);
  const Status written = device ? write_table(device_validation_table(on_device, *device),
                                              options.output, "device", "# Validation on a device")
                                : write_table(validation_table(outcomes), options.output,
                                              "validation", "# Validation");
  if (!written) return fail(options.output, written.errors());
  std::cout << "written to " << options.output << '\n';
  return passed ? kExitOk : kExitFailed;
}

void add_validate_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("validate", "Compare the physics with reference values, case by case");
  const auto options = std::make_shared<Options>();
  const auto device = std::make_shared<std::optional<DeviceChoice>>();
  add_options(*command, *options);
  add_device_option(*command, *device);
  command->footer(
      "With --device, the device runs the rows that it supports, and the errors of the CPU are "
      "shown beside its errors.\n"
      "Exit codes: 0 every row within its tolerance, 1 otherwise, 2 wrong usage.");
  command->callback([options, device, &exit_code] {
    if (*device && (*device)->is_auto) *device = DeviceChoice{.is_cpu = false};
    if (*device && (*device)->is_cpu) device->reset();
    exit_code = validate(*options, validation::all_cases(), *device);
  });
}

}  // namespace vat::bench
