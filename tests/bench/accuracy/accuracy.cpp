#include "tests/bench/accuracy/accuracy.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <memory>

#include "core/threads/thread_pool.h"
#include "server/cli/common/command.h"
#include "tests/bench/accuracy/accuracy_report.h"
#include "tests/bench/accuracy/catalogue_report.h"
#include "tests/bench/accuracy/control_report.h"
#include "tests/bench/accuracy/growth_report.h"
#include "tests/bench/accuracy/law_report.h"
#include "tests/bench/accuracy/solver_report.h"
#include "tests/bench/accuracy/tolerance_report.h"
#include "tests/bench/options.h"

namespace vat::bench {

namespace {

constexpr SweepSettings kQuick{.repetitions = 1, .stride = 3, .longest_run = 0.2};

ProblemResult solve_with_all(const ProblemEntry& entry, const SweepSettings& settings,
                             TaskRunner* runner) {
  const Problem problem = entry.make(runner);
  ProblemResult result{entry.name, problem.title, problem.error_name, {}};
  std::cout << entry.name << ": " << problem.title << std::endl;
  for (const Method& method : all_methods()) {
    std::vector<Solution> solutions = sweep(problem, method, settings, runner);
    if (solutions.empty()) continue;
    std::cout << "  " << name_of(method) << ": " << solutions.size() << " solutions";
    const auto best = std::ranges::min(solutions, {}, [](const Solution& solution) {
      return solution.failure.empty() ? solution.error : HUGE_VAL;
    });
    std::cout << ", least error " << (best.failure.empty() ? short_text(best.error) : best.failure)
              << std::endl;
    std::ranges::move(solutions, std::back_inserter(result.solutions));
  }
  return result;
}

Status solvers(const Options& options, TaskRunner* runner) {
  std::cout << "solvers: pressure solvers, error against time" << std::endl;
  const auto results =
      options.quick ? compare_solvers(1, 20, runner) : compare_solvers(5, 40, runner);
  std::cout << to_markdown(solvers_table(results)) << std::endl;
  return write_solvers(results, options.output);
}

Status tolerances(const Options& options, TaskRunner* /*runner*/) {
  std::cout << "tolerances: time against the tolerances of incompressible liquids" << std::endl;
  const auto points = options.quick ? sweep_tolerances(0.1, 1) : sweep_tolerances(1, 5);
  std::cout << to_markdown(tolerances_table(points)) << std::endl;
  return write_tolerances(points, options.output);
}

Status accuracies(const Options& options, TaskRunner* /*runner*/) {
  std::cout << "accuracies: cost and error against the requested accuracy" << std::endl;
  const auto points = sweep_accuracies();
  std::cout << to_markdown(accuracies_table(points)) << std::endl;
  return write_accuracies(points, options.output);
}

Status growth(const Options& options, TaskRunner* /*runner*/) {
  std::cout << "growth: iterations of the solves of a step against the size" << std::endl;
  const auto results = options.quick ? sweep_growth(20, 1) : sweep_growth(100, 5);
  std::cout << to_markdown(growth_table(results)) << std::endl;
  return write_growth(results, options.output);
}

Status catalogue(const Options& options, TaskRunner* runner) {
  std::cout << "catalogue: error and time of every scene with its own numerics" << std::endl;
  const auto results = measure_catalogue(
      options.quick ? CatalogueSettings{.late = 0.4, .refined = 2, .timed = 0.1, .repetitions = 1}
                    : CatalogueSettings{},
      runner);
  std::cout << to_markdown(catalogue_table(results)) << std::endl;
  return write_catalogue(results, options.output);
}

/// A comparison that is not a sweep of integrators and steps.
struct Comparison {
  const char* name;
  Status (*run)(const Options& options, TaskRunner* runner);
};

constexpr Comparison kComparisons[] = {{"solvers", &solvers},
                                       {"tolerances", &tolerances},
                                       {"accuracies", &accuracies},
                                       {"growth", &growth},
                                       {"catalogue", &catalogue}};

int accuracy(const Options& options) {
  const std::vector<ProblemEntry>& problems = all_problems();
  std::vector<std::string> names;
  for (const ProblemEntry& entry : problems) names.push_back(entry.name);
  for (const Comparison& comparison : kComparisons) names.emplace_back(comparison.name);
  if (options.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.cases, names);
  if (!chosen) return fail("accuracy", chosen.errors());
  if (const Status found = find_gnuplot(); !found) return fail("accuracy", found.errors());
  ThreadPoolRunner runner(options.threads);
  std::vector<ProblemResult> results;
  for (const std::size_t index : chosen.value()) {
    if (index >= problems.size()) {
      const Comparison& comparison = kComparisons[index - problems.size()];
      if (const Status done = comparison.run(options, &runner); !done) {
        return fail(options.output, done.errors());
      }
      continue;
    }
    if (options.quick && options.cases.empty() && problems[index].is_long) continue;
    results.push_back(
        solve_with_all(problems[index], options.quick ? kQuick : SweepSettings{}, &runner));
  }
  if (results.empty()) return kExitOk;
  const std::vector<LawPair> pairs = pairs_of_laws(results);
  Status written = write_accuracy(results, options.output);
  if (written) written = write_laws(pairs, options.output);
  if (!written) return fail(options.output, written.errors());
  std::cout << '\n'
            << to_markdown(cheapest_table(results)) << '\n'
            << to_markdown(control_table(results)) << '\n';
  if (!pairs.empty()) std::cout << to_markdown(laws_table(pairs)) << '\n';
  std::cout << "written to " << options.output << '\n';
  return kExitOk;
}

}  // namespace

void add_accuracy_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "accuracy",
      "Run time against error, for every integrator and step control, with decreasing steps");
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->footer("Exit codes: 0 success, 1 a problem cannot be solved or written, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = accuracy(*options); });
}

}  // namespace vat::bench
