#include "tests/bench/speed/speed.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/support/instruction_set.h"
#include "server/cli/common/command.h"
#include "server/cli/common/option_checks.h"
#include "tests/bench/options.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/cases.h"
#include "tests/bench/speed/plots.h"
#include "tests/bench/speed/skips.h"
#include "tests/bench/speed/tables.h"
#include "tests/bench/speed/targets.h"

namespace vat::bench {

namespace {

struct SpeedOptions {
  Options common;
  SpeedSetup setup{{}, best_instruction_set()};
  int repetitions = 0;  ///< 0: the number of the case
  std::vector<std::string> scenes;
  std::string scenes_folder = VAT_DEFAULT_SCENES_DIR;
};

/// Returns 1, 2 and 4 threads, up to the number of the machine.
std::vector<std::size_t> thread_counts() {
  std::vector<std::size_t> counts = {1};
  for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
    if (count <= std::thread::hardware_concurrency()) counts.push_back(count);
  }
  return counts;
}

/// A tenth of the time, without repetitions.
SpeedSettings quick(SpeedSettings settings) {
  settings.warm_up *= 0.1;
  settings.measured *= 0.1;
  settings.repetitions = 1;
  return settings;
}

std::vector<std::string> all_names(const std::vector<SpeedCase>& known) {
  std::vector<std::string> names;
  for (const SpeedCase& one : known) names.push_back(one.name);
  for (const std::string& name : skip_names()) names.push_back(name);
  return names;
}

/// The selected cases.
struct Choice {
  std::vector<SpeedCase> cases;
  std::vector<std::size_t> skips;  ///< see make_skip_pair()
};

/// Returns the named scenes, cases of the benchmark, or both.
Result<Choice> choose_cases(const SpeedOptions& options, const std::vector<SpeedCase>& known) {
  Choice choice;
  for (const std::string& scene : options.scenes) {
    choice.cases.push_back(case_of_scene(scene, options.scenes_folder));
  }
  const bool is_named = !options.common.cases.empty();
  if (!options.scenes.empty() && !is_named) return choice;
  const Result<std::vector<std::size_t>> indices = choose(options.common.cases, all_names(known));
  if (!indices) return indices.errors();
  for (const std::size_t index : indices.value()) {
    if (index >= known.size()) {
      choice.skips.push_back(index - known.size());
    } else if (!known[index].is_long || !options.common.quick || is_named) {
      choice.cases.push_back(known[index]);
    }
  }
  return choice;
}

SpeedSettings settings_for(SpeedSettings settings, const SpeedOptions& options) {
  if (options.common.quick) settings = quick(settings);
  if (options.repetitions > 0) settings.repetitions = options.repetitions;
  return settings;
}

Result<std::vector<SpeedRow>> time_case(const SpeedCase& one, const SpeedOptions& options) {
  const Result<Scene> scene = one.make();
  if (!scene) return scene.errors();
  return measure(one.name, scene.value(), options.setup, settings_for(one.settings, options));
}

/// All results.
struct SpeedResults {
  std::vector<SpeedRow> rows;
  std::vector<SkipResult> skips;

  void add(const std::vector<SpeedRow>& some) {
    for (const SpeedRow& row : some) {
      print_speed_row(std::cout, row);
      rows.push_back(row);
    }
  }
};

/// Prefixes the path of every error with the case's name.
Errors name_errors(Errors errors, const std::string& name) {
  for (Error& error : errors) {
    if (error.path.empty() || error.path.front() == '/') error.path = name + error.path;
  }
  return errors;
}

/// Times all selected cases in order.
Result<SpeedResults> time_all(const Choice& choice, const SpeedOptions& options) {
  SpeedResults results;
  print_speed_header(std::cout);
  for (const SpeedCase& one : choice.cases) {
    const Result<std::vector<SpeedRow>> rows = time_case(one, options);
    if (!rows) return name_errors(rows.errors(), one.name);
    results.add(rows.value());
  }
  for (const std::size_t index : choice.skips) {
    SkipPair pair = make_skip_pair(index);
    pair.settings = settings_for(pair.settings, options);
    const std::string name = pair.name;
    Result<SkipResult> skip = measure_skip(std::move(pair), options.setup);
    if (!skip) return name_errors(skip.errors(), name);
    results.add(skip.value().with);
    results.add(skip.value().without);
    results.skips.push_back(std::move(skip).value());
  }
  return results;
}

/// Returns whether the results include several sizes.
bool has_pictures(const Choice& choice) {
  return std::ranges::count_if(choice.cases, [](const SpeedCase& one) {
           return one.name.starts_with("dam-break-");
         }) > 1;
}

/// Writes a table, and prints it if it has rows.
Status write_part(const Table& table, const std::string& folder, const std::string& name,
                  const std::string& heading) {
  if (!table.rows.empty()) std::cout << '\n' << to_markdown(table);
  return write_table(table, folder, name, heading);
}

Status write_speed_results(const SpeedResults& results, const std::string& folder) {
  const auto& [rows, skips] = results;
  Status written = write_table(speed_table(rows, this_machine()), folder, "speed", "# Speed");
  if (written) written = write_table(stage_table(rows), folder, "stages", "# Time by stage");
  if (written) written = write_part(skip_table(skips), folder, "skips", "# Work left out");
  if (!written) return written;
  return write_part(target_table(targets_of(rows, skips)), folder, "targets", "# Targets");
}

Status draw_results(const std::vector<SpeedRow>& rows, const SpeedOptions& options) {
  const std::string& folder = options.common.output;
  const Status drawn = write_plot(size_plot(rows), folder, "time-per-particle");
  if (!drawn || options.setup.threads.size() < 2) return drawn;
  return write_plot(thread_plot(rows), folder, "speed-up");
}

int speed(SpeedOptions options) {
  const std::vector<SpeedCase> known = all_speed_cases(options.scenes_folder);
  if (options.common.list) {
    print_names(all_names(known));
    return kExitOk;
  }
  if (options.setup.threads.empty()) options.setup.threads = thread_counts();
  const Result<Choice> choice = choose_cases(options, known);
  if (!choice) return fail("speed", choice.errors());
  const bool is_drawn = has_pictures(choice.value());
  if (is_drawn) {
    if (const Status found = find_gnuplot(); !found) return fail("speed", found.errors());
  }
  const Result<SpeedResults> results = time_all(choice.value(), options);
  if (!results) return fail("speed", results.errors());
  Status written = write_speed_results(results.value(), options.common.output);
  if (written && is_drawn) written = draw_results(results.value().rows, options);
  if (!written) return fail(options.common.output, written.errors());
  std::cout << "\nwritten to " << options.common.output << '\n';
  return kExitOk;
}

}  // namespace

void add_speed_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "speed", "Time of a step, with several numbers of threads, from a typical state");
  const auto options = std::make_shared<SpeedOptions>();
  add_case_options(*command, options->common);
  command
      ->add_option("--threads", options->setup.threads,
                   "Number of threads; may be given again. Default: 1, 2 and 4, as far as the "
                   "machine has them")
      ->check(thread_count_range())
      ->take_all()
      ->expected(1);
  add_isa_option(*command, options->setup.instructions);
  add_device_option(*command, options->setup.device);
  command->add_option("--repetitions", options->repetitions, "Repetitions of each measurement")
      ->check(CLI::Range(1, 1000));
  command->add_option("scenes", options->scenes, "Scenes to time in place of the cases");
  command->add_option("--scenes", options->scenes_folder, "Folder of the catalogue");
  command->footer(
      "Exit codes: 0 success, 1 invalid scene, failed run or states that differ between "
      "thread counts, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = speed(*options); });
}

}  // namespace vat::bench
