#include "tests/bench/instructions/instructions.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "tests/bench/instructions/callgrind.h"
#include "tests/bench/instructions/counted_scenes.h"
#include "tests/bench/instructions/stored_counts.h"
#include "tests/bench/options.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

namespace {

constexpr int kExitSkipped = 77;  // the code for a skipped test in ctest

struct InstructionOptions {
  Options common;
  std::string stored;  ///< file for the comparison; empty: none
};

std::vector<std::string> names_of_scenes() {
  std::vector<std::string> names;
  for (const CountedScene& scene : counted_scenes()) names.push_back(scene.name);
  return names;
}

/// Counts the scenes and writes the table.
Result<std::vector<InstructionCount>> count_scenes(const std::vector<std::size_t>& chosen,
                                                   const std::string& folder) {
  std::vector<InstructionCount> counts;
  Table table{{"scene", "build", "particles", "steps", "instructions",
               "instructions per particle and step"},
              {}};
  for (const std::size_t index : chosen) {
    const CountedScene& scene = counted_scenes()[index];
    const Result<CountedRun> run = run_counted(scene);
    if (!run) return run.errors();
    const Result<std::uint64_t> count = count_instructions(scene.name, folder);
    if (!count) return count.errors();
    counts.push_back({scene.name, count.value()});
    const Real particle_steps = static_cast<Real>(run.value().particles * run.value().steps);
    table.rows.push_back({scene.name, this_build(), run.value().particles, run.value().steps,
                          count.value(), static_cast<Real>(count.value()) / particle_steps});
  }
  std::cout << to_markdown(table);
  const Status written = write_table(table, folder, "instructions", "# Instructions");
  if (!written) return written.errors();
  return counts;
}

Result<std::vector<StoredCount>> read_stored(const std::string& name) {
  const Result<CsvFile> file = read_csv_file(name);
  if (!file) return file.errors();
  return read_stored_counts(file.value());
}

/// Returns whether counts of this build are stored. Otherwise prints a message.
bool is_stored_build(const std::vector<StoredCount>& stored) {
  for (const StoredCount& one : stored) {
    if (one.build == this_build()) return true;
  }
  std::cout << "skipped: this program is built by " << this_build()
            << ", and counts are stored for";
  for (const StoredCount& one : stored) std::cout << ' ' << one.count.scene << " by " << one.build;
  std::cout << '\n';
  return false;
}

bool is_renewal() {
  const char* value = std::getenv("VAT_UPDATE_GOLDEN");
  return value != nullptr && std::string(value) == "1";
}

int instructions(const InstructionOptions& options) {
  const std::vector<std::string> names = names_of_scenes();
  if (options.common.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.common.cases, names);
  if (!chosen) return fail("instructions", chosen.errors());
  std::vector<StoredCount> stored;
  if (!options.stored.empty()) {
    Result<std::vector<StoredCount>> read = read_stored(options.stored);
    if (!read) return fail(options.stored, read.errors());
    stored = std::move(read).value();
    if (!is_renewal() && !is_stored_build(stored)) return kExitSkipped;
  }
  const Result<std::vector<InstructionCount>> counts =
      count_scenes(chosen.value(), options.common.output);
  if (!counts) return fail("instructions", counts.errors());
  if (options.stored.empty()) return kExitOk;
  if (is_renewal()) {
    const Status written =
        write_text(options.stored, to_csv(renewed(counts.value(), stored, this_build())));
    return written ? kExitOk : fail(options.stored, written.errors());
  }
  const Status same = check_counts(counts.value(), stored, this_build());
  return same ? kExitOk : fail("instructions", same.errors());
}

int run_counted_scene(const std::string& name) {
  for (const CountedScene& scene : counted_scenes()) {
    if (scene.name != name) continue;
    const Result<CountedRun> run = run_counted(scene);
    return run ? kExitOk : fail(name, run.errors());
  }
  std::cerr << name << ": there is no such scene\n";
  return kExitUsage;
}

}  // namespace

void add_instructions_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "instructions",
      "Instructions of a step, counted by callgrind; independent of the machine's load");
  const auto options = std::make_shared<InstructionOptions>();
  add_case_options(*command, options->common);
  command->add_option("--check", options->stored,
                      "File of counts to compare with, such as tests/golden/instructions.csv");
  command->footer(
      "Exit codes: 0 success, 1 a count differs by more than 3 % or cannot be measured, 2 wrong "
      "usage, "
      "77 no counts are stored for this compiler and its flags.");
  command->callback([options, &exit_code] { exit_code = instructions(*options); });

  CLI::App* counted = app.add_subcommand(kCountedCommand, "What callgrind watches")->group("");
  const auto name = std::make_shared<std::string>();
  counted->add_option("scene", *name)->required();
  counted->callback([name, &exit_code] { exit_code = run_counted_scene(*name); });
}

}  // namespace vat::bench
