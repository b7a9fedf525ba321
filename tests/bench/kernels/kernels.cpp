#include "tests/bench/kernels/kernels.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "tests/bench/kernels/counted_steps.h"
#include "tests/bench/options.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

namespace {

constexpr Real kManyParticles = 1e6;

std::vector<std::string> names_of_counted_kernels() {
  std::vector<std::string> names;
  for (const CountedKernels& scene : counted_kernel_scenes()) names.push_back(scene.name);
  return names;
}

Table empty_table_of_kernels() {
  return {{"scene", "kernel", "runs per step", "single", "double", "instructions", "accessed bytes",
           "bytes of groups", "distinct bytes"},
          {}};
}

Table empty_table_of_times() {
  Table table{{"scene"}, {}};
  for (const Gpu& gpu : known_gpus()) {
    table.columns.push_back(std::string(gpu.name) + " [ms per step]");
  }
  return table;
}

void add_kernels(const std::string& scene, const CountedSteps& counted, Table& table) {
  for (const KernelCounts& k : counted.kernels) {
    table.rows.push_back({scene, k.name, k.runs, k.single_operations, k.double_operations,
                          k.instructions, k.accessed_bytes, k.group_bytes, k.distinct_bytes});
  }
}

void add_times(const std::string& scene, const CountedSteps& counted, Table& table) {
  std::vector<Cell> cells = {scene};
  for (const Gpu& gpu : known_gpus()) {
    cells.emplace_back(1e3 * predict_step(counted.kernels, gpu, kManyParticles));
  }
  table.rows.push_back(std::move(cells));
}

int kernels(const Options& options) {
  const std::vector<std::string> names = names_of_counted_kernels();
  if (options.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.cases, names);
  if (!chosen) return fail("kernels", chosen.errors());
  Table counts = empty_table_of_kernels();
  Table times = empty_table_of_times();
  for (const std::size_t index : chosen.value()) {
    const CountedKernels& scene = counted_kernel_scenes()[index];
    const Result<CountedSteps> counted = count_kernels(scene, options.output);
    if (!counted) return fail(scene.name, counted.errors());
    add_kernels(scene.name, counted.value(), counts);
    add_times(scene.name, counted.value(), times);
  }
  std::cout << to_markdown(counts) << '\n' << to_markdown(times);
  Status written = write_table(counts, options.output, "kernels", "# Work of kernels");
  if (written) written = write_table(times, options.output, "times", "# Predicted times");
  return written ? kExitOk : fail("kernels", written.errors());
}

int run_kernels_of_scene(const std::string& name, const std::string& file) {
  for (const CountedKernels& scene : counted_kernel_scenes()) {
    if (scene.name != name) continue;
    const Status run = run_counted_kernels(scene, file);
    return run ? kExitOk : fail(name, run.errors());
  }
  std::cerr << name << ": there is no such scene\n";
  return kExitUsage;
}

}  // namespace

void add_kernels_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "kernels",
      "Operations and bytes of each kernel of devices, counted by Oclgrind, and predicted times");
  const auto options = std::make_shared<Options>();
  add_case_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = kernels(*options); });

  CLI::App* counted =
      app.add_subcommand(kCountedKernelsCommand, "Steps on a simulated device")->group("");
  const auto name = std::make_shared<std::string>();
  const auto file = std::make_shared<std::string>();
  counted->add_option("scene", *name)->required();
  counted->add_option("file", *file)->required();
  counted->callback([name, file, &exit_code] { exit_code = run_kernels_of_scene(*name, *file); });
}

}  // namespace vat::bench
