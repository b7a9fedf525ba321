#include "tests/bench/compare.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cli/common/option_checks.h"
#include "tests/bench/speed/comparison.h"

namespace vat::bench {

namespace {

struct CompareOptions {
  std::string before;
  std::string after;
  double tolerance = 10;  ///< percent
};

Result<std::vector<TimedRow>> read_rows(const std::string& name) {
  const Result<CsvFile> file = read_csv_file(name);
  if (!file) return file.errors();
  return timed_rows(file.value());
}

void print_unmatched(const std::vector<TimedRow>& rows, const std::string& file) {
  for (const TimedRow& row : rows) std::cout << "only in " << file << ": " << row.title() << '\n';
}

/// Warns if the times are from different machines.
void warn_of_machines(const Comparison& comparison) {
  for (const Comparison::Pair& pair : comparison.pairs) {
    if (pair.before.machine == pair.after.machine) continue;
    std::cerr << "measured on different machines: " << pair.before.machine << "; "
              << pair.after.machine << '\n';
    return;
  }
}

int compare(const CompareOptions& options) {
  const Result<std::vector<TimedRow>> before = read_rows(options.before);
  if (!before) return fail(options.before, before.errors());
  const Result<std::vector<TimedRow>> after = read_rows(options.after);
  if (!after) return fail(options.after, after.errors());
  const Result<Comparison> compared =
      compare_rows(before.value(), after.value(), options.tolerance / 100);
  if (!compared) return fail("compare", compared.errors());
  const Comparison& comparison = compared.value();
  warn_of_machines(comparison);
  std::cout << "commits: " << before.value().front().commit << " to "
            << after.value().front().commit << "\n\n"
            << to_markdown(comparison_table(comparison)) << '\n';
  print_unmatched(comparison.only_before, options.before);
  print_unmatched(comparison.only_after, options.after);
  std::cout << comparison.slower_count() << " of " << comparison.pairs.size()
            << " rows are slower by more than " << options.tolerance
            << " %; the geometric mean of all ratios is " << short_text(comparison.mean_ratio())
            << '\n';
  return comparison.slower_count() == 0 ? kExitOk : kExitFailed;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("compare", "Compare two results of speed");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("before", options->before, "speed.csv of one run")->required();
  command->add_option("after", options->after, "speed.csv of the other")->required();
  command
      ->add_option("--tolerance", options->tolerance,
                   "Tolerated increase of the median and the minimum time of a row [%]")
      ->check(real_in(0, 1000))
      ->capture_default_str();
  command->footer(
      "Exit codes: 0 success, 1 a case is slower or a file cannot be compared, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = compare(*options); });
}

}  // namespace vat::bench
