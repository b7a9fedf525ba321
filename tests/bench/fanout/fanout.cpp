#include "tests/bench/fanout/fanout.h"

#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cli/serve/open_files.h"
#include "tests/bench/fanout/case.h"
#include "tests/bench/fanout/turns.h"
#include "tests/bench/options.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"

namespace vat::bench {

/// Water in a vat that moves back and forth, with few long steps: 30 ticks per second, each of
/// which moves every particle.
const char* const kFanoutScene = R"({
  "format": "vat.scene/1", "name": "fanout", "title": "Sloshing",
  "materials": [{"name": "water", "density": 1000,
    "liquid": {"stiffness": 400, "viscosity": 0.1, "support_radius": 0.17,
               "artificial_viscosity": 0.1}}],
  "vat": {"min": [0, 0, 0], "max": [4, 2, 2.5], "lid": true,
          "motion": {"type": "slide", "axis": [1, 0, 0], "stroke": 0.5, "period": 2}},
  "numerics": {"integrator": "velocity_verlet", "step": 0.004761904761904762,
               "tick": 0.03333333333333333},
  "bodies": [{"name": "water", "kind": "liquid", "material": "water", "spacing": 0.085,
    "shape": {"type": "box", "center": [1.1, 1, 0.8], "size": [2.2, 2, 1.5]}}]})";

namespace {

struct FanoutOptions {
  Options common;
  std::string program = VAT_PROGRAM;
  double max_error = 0;
};

constexpr std::size_t kOtherFiles = 64;  // open files of a load process besides its sockets

/// A rigid block at rest, whose description has about 1.4 MB.
constexpr const char* kSolidsScene = R"({
  "format": "vat.scene/1", "name": "fanout-solids", "title": "Block", "gravity": [0, 0, 0],
  "materials": [{"name": "stone", "density": 2000}],
  "numerics": {"step": 0.03333333333333333, "tick": 0.03333333333333333},
  "bodies": [{"name": "block", "kind": "rigid", "material": "stone", "spacing": 0.037,
    "shape": {"type": "box", "size": [1.1, 1.1, 1.1]}}]})";

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const FanoutCase& one : fanout_cases()) names.push_back(one.name);
  for (const TurnsCase& one : turns_cases()) names.push_back(one.name);
  return names;
}

Table to_fanout_table(const std::vector<FanoutResult>& results) {
  const Machine machine = this_machine();
  Table table{{"case",
               "kind",
               "viewers",
               "endpoints",
               "frames per second",
               "frame bytes",
               "age median [ms]",
               "age 99 % [ms]",
               "first frame 99 % [ms]",
               "joins",
               "closed",
               "% of a core per viewer",
               "cores",
               "resident [MB]",
               "kB per viewer",
               "ticks per second",
               "tick median [ms]",
               "tick 99 % [ms]",
               "tick lateness 99 % [ms]",
               "commit",
               "cpu",
               "cores of the machine"},
              {}};
  for (const FanoutResult& r : results) {
    table.rows.push_back({r.name,
                          std::string(name_of(r.kind)),
                          std::uint64_t{r.viewers},
                          std::uint64_t{r.endpoints},
                          r.frames_per_second,
                          r.frame_bytes,
                          1e3 * r.age_median,
                          1e3 * r.age_99,
                          1e3 * r.first_frame_99,
                          std::uint64_t{r.joins},
                          std::uint64_t{r.closed},
                          1e2 * r.delivery_per_viewer,
                          r.processor,
                          r.resident_megabytes,
                          r.kilobytes_per_viewer,
                          r.ticks,
                          1e3 * r.tick_median,
                          1e3 * r.tick_99,
                          1e3 * r.lateness_99,
                          machine.commit,
                          machine.cpu,
                          std::uint64_t{machine.cores}});
  }
  return table;
}

Table to_fanout_table(const std::vector<TurnsResult>& results) {
  const Machine machine = this_machine();
  Table table{{"case", "quantity", "viewers", "viewers who come", "segments", "values",
               "median without", "median with", "ratio", "ratio low", "ratio high", "99 % without",
               "99 % with", "ratio of 99 %", "ratio of 99 % low", "ratio of 99 % high", "commit",
               "cpu", "cores of the machine"},
              {}};
  for (const TurnsResult& r : results) {
    std::uint64_t values = 0;
    for (const Segments* segments : {&r.without, &r.with}) {
      for (const auto& segment : *segments) values += segment.size();
    }
    const QuantileRatio median = quantile_ratio(r.without, r.with, 0.5);
    const QuantileRatio highest = quantile_ratio(r.without, r.with, 0.99);
    table.rows.push_back({r.name, r.quantity, std::uint64_t{r.staying}, std::uint64_t{r.coming},
                          std::uint64_t{r.without.size() + r.with.size()}, values,
                          pooled_quantile(r.without, 0.5), pooled_quantile(r.with, 0.5),
                          median.value, median.low, median.high, pooled_quantile(r.without, 0.99),
                          pooled_quantile(r.with, 0.99), highest.value, highest.low, highest.high,
                          machine.commit, machine.cpu, std::uint64_t{machine.cores}});
  }
  return table;
}

Status write_results(const Table& table, const std::filesystem::path& folder, const char* name,
                     const char* heading) {
  if (table.rows.empty()) return {};
  std::cout << '\n' << to_markdown(table);
  return write_table(table, folder, name, heading);
}

int run_cases(const std::vector<std::size_t>& chosen, const FanoutOptions& options) {
  FanoutSettings settings;
  settings.program = options.program;
  settings.max_error = options.max_error;
  if (options.common.quick) settings.seconds = 3;
  const std::filesystem::path folder = options.common.output;
  std::filesystem::create_directories(folder);
  settings.scene = (folder / "scene.json").string();
  if (const Status written = write_text(settings.scene, kFanoutScene); !written) {
    return fail(settings.scene, written.errors());
  }
  settings.solids_scene = (folder / "solids.json").string();
  if (const Status written = write_text(settings.solids_scene, kSolidsScene); !written) {
    return fail(settings.solids_scene, written.errors());
  }
  std::vector<FanoutResult> results;
  std::vector<TurnsResult> turns;
  for (const std::size_t index : chosen) {
    std::cout << case_names()[index] << " ..." << std::endl;
    if (index < fanout_cases().size()) {
      const auto more = run_fanout(fanout_cases()[index], settings);
      results.insert(results.end(), more.begin(), more.end());
    } else {
      const auto more = run_turns(turns_cases()[index - fanout_cases().size()], settings);
      turns.insert(turns.end(), more.begin(), more.end());
    }
  }
  for (const Status& written :
       {write_results(to_fanout_table(results), folder, "fanout", "# Fan-out"),
        write_results(to_fanout_table(turns), folder, "turns",
                      "# With and without some viewers")}) {
    if (!written) return fail(options.common.output, written.errors());
  }
  std::cout << "\nwritten to " << options.common.output << '\n';
  return kExitOk;
}

int fanout(const FanoutOptions& options) {
  const std::vector<std::string> names = case_names();
  if (options.common.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.common.cases, names);
  if (!chosen) return fail("fanout", chosen.errors());
  std::size_t most = 200;
  for (const std::size_t index : chosen.value()) {
    if (index >= fanout_cases().size()) continue;  // at most 200
    std::size_t viewers = 0;
    for (const std::size_t count : fanout_cases()[index].viewers) viewers += count;
    most = std::max(most, viewers);
  }
  const std::size_t allowed = raise_open_files(most + kOtherFiles);
  if (allowed < most + kOtherFiles) {
    std::cerr << "fanout: " << most << " viewers need as many open files, and the system allows "
              << allowed << " (ulimit -n)\n";
    return kExitFailed;
  }
  try {
    return run_cases(chosen.value(), options);
  } catch (const std::runtime_error& error) {
    std::cerr << "fanout: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_fanout_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("fanout", "Many viewers of one session: rate and age of their frames");
  const auto options = std::make_shared<FanoutOptions>();
  add_case_options(*command, options->common);
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command
      ->add_option("--max-error", options->max_error,
                   "Maximum position error [m] that viewers request; 0: the finest grid")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->footer("Exit codes: 0 measured, 1 the server or the viewers failed, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = fanout(*options); });
}

}  // namespace vat::bench
