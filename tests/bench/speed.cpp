#include "tests/bench/speed.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/cli/command.h"
#include "server/cli/option_checks.h"
#include "server/cli/scene_argument.h"
#include "server/output/output_file.h"
#include "tests/bench/speed_measure.h"
#include "tests/bench/speed_report.h"

namespace vat::bench {

namespace {

constexpr SpeedSettings kQuick{.warm_up = 0.2, .measured = 0.2, .repetitions = 1};

struct Options {
  std::vector<std::string> scenes;
  std::string scenes_folder = VAT_DEFAULT_SCENES_DIR;
  std::string output;
  bool quick = false;
};

/// 1, 2 and 4 threads, as far as the machine has them.
std::vector<std::size_t> thread_counts() {
  std::vector<std::size_t> counts = {1};
  for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
    if (count <= std::thread::hardware_concurrency()) counts.push_back(count);
  }
  return counts;
}

/// Adds a row for each number of threads; fails where their states differ.
Status time_scene(const Scene& scene, const SpeedSettings& settings, std::vector<SpeedRow>& rows) {
  std::optional<std::uint64_t> expected_hash;
  for (const std::size_t threads : thread_counts()) {
    const Result<SpeedRow> row = measure(scene, threads, settings);
    if (!row) return row.errors();
    print_speed_row(std::cout, row.value());
    rows.push_back(row.value());
    if (!expected_hash) expected_hash = row.value().state_hash;
    if (row.value().state_hash != *expected_hash) {
      return Error{
          "not_deterministic", "",
          "the state with " + std::to_string(threads) + " threads is not the state with 1 thread"};
    }
  }
  return {};
}

/// Times the scenes in order. The path of every error begins with the scene's name.
Result<std::vector<SpeedRow>> time_scenes(const std::vector<std::string>& names,
                                          const Options& options) {
  std::vector<SpeedRow> rows;
  print_speed_header(std::cout);
  for (const std::string& name : names) {
    const Result<Scene> scene = load_scene(name, options.scenes_folder);
    const Status done =
        scene ? time_scene(scene.value(), options.quick ? kQuick : SpeedSettings{}, rows)
              : Status(scene.errors());
    if (done) continue;
    Errors errors = done.errors();
    for (Error& error : errors) {
      if (error.path.empty() || error.path.front() == '/') error.path = name + error.path;
    }
    return errors;
  }
  return rows;
}

Status write_csv(OutputFile& file, const std::vector<SpeedRow>& rows) {
  std::string text = speed_csv_header();
  for (const SpeedRow& row : rows) text += speed_csv_row(row);
  if (Status written = file.append(text); !written) return written;
  return file.commit();
}

int speed(const Options& options) {
  std::vector<std::string> names = options.scenes;
  if (names.empty()) {
    Result<std::vector<std::string>> all = catalogue_names(options.scenes_folder);
    if (!all) return fail(options.scenes_folder, all.errors());
    names = std::move(all).value();
  }
  std::optional<OutputFile> csv;  // created first: a wrong name should not cost minutes
  if (!options.output.empty()) {
    Result<OutputFile> file = OutputFile::create(options.output);
    if (!file) return fail(options.output, file.errors());
    csv = std::move(file).value();
  }
  const Result<std::vector<SpeedRow>> rows = time_scenes(names, options);
  if (!rows) return fail("speed", rows.errors());
  if (!csv) return kExitOk;
  const Status written = write_csv(*csv, rows.value());
  return written ? kExitOk : fail(options.output, written.errors());
}

}  // namespace

void add_speed_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "speed", "Time scenes with 1, 2 and 4 threads, from a typical state, median of 5 runs");
  const auto options = std::make_shared<Options>();
  command->add_option("scenes", options->scenes, "Scenes; default: the whole catalogue");
  command->add_option("--scenes", options->scenes_folder, "Folder of the catalogue");
  command->add_flag("--quick", options->quick, "One short run of each");
  command->add_option("--output", options->output, "File for the results: .csv")
      ->check(csv_file_name());
  command->footer(
      "Exit codes: 0 fine, 1 invalid scene, failed run or states that differ between "
      "thread counts, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = speed(*options); });
}

}  // namespace vat::bench
