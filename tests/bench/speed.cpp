#include "tests/bench/speed.h"

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
#include "server/cli/command.h"
#include "server/cli/option_checks.h"
#include "tests/bench/options.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/cases.h"
#include "tests/bench/speed/tables.h"

namespace vat::bench {

namespace {

struct SpeedOptions {
  Options common;
  std::vector<std::size_t> threads;
  InstructionSet instructions = best_instruction_set();
  int repetitions = 0;  ///< 0: as many as the case has
  std::vector<std::string> scenes;
  std::string scenes_folder = VAT_DEFAULT_SCENES_DIR;
};

/// 1, 2 and 4 threads, as far as the machine has them.
std::vector<std::size_t> thread_counts() {
  std::vector<std::size_t> counts = {1};
  for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
    if (count <= std::thread::hardware_concurrency()) counts.push_back(count);
  }
  return counts;
}

/// A tenth of the time, and no repetition.
SpeedSettings quick(SpeedSettings settings) {
  settings.warm_up *= 0.1;
  settings.measured *= 0.1;
  settings.repetitions = 1;
  return settings;
}

/// The cases to run: the scenes that were named, or those of the bench.
Result<std::vector<SpeedCase>> choose_cases(const SpeedOptions& options,
                                            const std::vector<SpeedCase>& known) {
  std::vector<SpeedCase> chosen;
  for (const std::string& scene : options.scenes) {
    chosen.push_back(case_of_scene(scene, options.scenes_folder));
  }
  if (!options.scenes.empty() && options.common.cases.empty()) return chosen;
  std::vector<std::string> names;
  for (const SpeedCase& one : known) names.push_back(one.name);
  const Result<std::vector<std::size_t>> indices = choose(options.common.cases, names);
  if (!indices) return indices.errors();
  for (const std::size_t index : indices.value()) {
    const bool skipped =
        options.common.quick && options.common.cases.empty() && known[index].is_long;
    if (!skipped) chosen.push_back(known[index]);
  }
  return chosen;
}

Result<std::vector<SpeedRow>> time_case(const SpeedCase& one, const SpeedOptions& options) {
  const Result<Scene> scene = one.make();
  if (!scene) return scene.errors();
  SpeedSettings settings = options.common.quick ? quick(one.settings) : one.settings;
  if (options.repetitions > 0) settings.repetitions = options.repetitions;
  return measure(one.name, scene.value(), options.threads, options.instructions, settings);
}

/// Times the cases in order. The path of every error begins with the case's name.
Result<std::vector<SpeedRow>> time_cases(const std::vector<SpeedCase>& cases,
                                         const SpeedOptions& options) {
  std::vector<SpeedRow> all;
  print_speed_header(std::cout);
  for (const SpeedCase& one : cases) {
    const Result<std::vector<SpeedRow>> rows = time_case(one, options);
    if (!rows) {
      Errors errors = rows.errors();
      for (Error& error : errors) {
        if (error.path.empty() || error.path.front() == '/') error.path = one.name + error.path;
      }
      return errors;
    }
    for (const SpeedRow& row : rows.value()) {
      print_speed_row(std::cout, row);
      all.push_back(row);
    }
  }
  return all;
}

Status write_results(const std::vector<SpeedRow>& rows, const std::string& folder) {
  const Status written = write_table(speed_table(rows, this_machine()), folder, "speed", "# Speed");
  if (!written) return written;
  return write_table(stage_table(rows), folder, "stages", "# Time by stage");
}

int speed(SpeedOptions options) {
  const std::vector<SpeedCase> known = all_speed_cases(options.scenes_folder);
  if (options.common.list) {
    for (const SpeedCase& one : known) std::cout << one.name << '\n';
    return kExitOk;
  }
  if (options.threads.empty()) options.threads = thread_counts();
  const Result<std::vector<SpeedCase>> cases = choose_cases(options, known);
  if (!cases) return fail("speed", cases.errors());
  const Result<std::vector<SpeedRow>> rows = time_cases(cases.value(), options);
  if (!rows) return fail("speed", rows.errors());
  const Status written = write_results(rows.value(), options.common.output);
  if (!written) return fail(options.common.output, written.errors());
  std::cout << "written to " << options.common.output << '\n';
  return kExitOk;
}

}  // namespace

void add_speed_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "speed", "Time of a step, with several numbers of threads, from a typical state");
  const auto options = std::make_shared<SpeedOptions>();
  add_case_options(*command, options->common);
  command
      ->add_option("--threads", options->threads,
                   "Number of threads; may be given again. Default: 1, 2 and 4, as far as the "
                   "machine has them")
      ->check(thread_count_range())
      ->take_all()
      ->expected(1);
  add_isa_option(*command, options->instructions);
  command->add_option("--repetitions", options->repetitions, "Repetitions of each measurement")
      ->check(CLI::Range(1, 1000));
  command->add_option("scenes", options->scenes, "Scenes to time in place of the cases");
  command->add_option("--scenes", options->scenes_folder, "Folder of the catalogue");
  command->footer(
      "Exit codes: 0 fine, 1 invalid scene, failed run or states that differ between "
      "thread counts, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = speed(*options); });
}

}  // namespace vat::bench
